#include "tools/ndf/profile.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/charts/concentric.h>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;
constexpr double top = 75, width = 400, height = 300, left[] = {70, 560};

double y_of(double t) { return top + height * (1 - std::clamp(t, -1.0, 2.0)); }

void text(std::ostream& out, double x, double y, const std::string& what, const char* anchor) {
  out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\">" << what << "</text>\n";
}

template <class X, class Y>
void curve(std::ostream& out, const NdfProfile& profile, int steps, const X& x, const Y& y) {
  out << "<polyline clip-path=\"url(#plots)\" fill=\"none\" stroke-width=\"1.8\" stroke=\"" << profile.colour
      << "\" stroke-dasharray=\"" << profile.dashes << "\" points=\"";
  for (int k = 0; k <= steps; ++k)
    out << x(static_cast<double>(k) / steps) << ',' << y(static_cast<double>(k) / steps) << ' ';
  out << "\"/>\n";
}

}  // namespace

void write_ndf_profiles(const std::filesystem::path& path, const std::string& title,
                        const std::vector<NdfProfile>& profiles) {
  const std::vector<double>& first = profiles.front().ndf.values();
  const double peak = *std::max_element(first.begin(), first.end());
  const int high = static_cast<int>(std::ceil(std::log10(peak) + 0.02)), decades = 6, low = high - decades;
  write_stream_atomically(path, [&](std::ostream& out) {
    out << std::fixed << std::setprecision(1) << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1000 " << 470
        << "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"1000\" height=\"470\" "
           "fill=\"white\"/>\n<text x=\"20\" y=\"26\" "
           "font-size=\"17\">";
    for (const char c : title) c == '&' ? out << "&amp;" : c == '<' ? out << "&lt;" : out << c;
    out << "</text>\n<clipPath id=\"plots\"><rect x=\"" << left[0] << "\" y=\"" << top - 1 << "\" width=\""
        << left[1] + width - left[0] << "\" height=\"" << height + 1 << "\"/></clipPath>\n";
    text(out, left[0], top - 12, "D [1/sr], normalised; logarithmic over a square-root scale of theta", "start");
    text(out, left[1], top - 12, "G1 = cos / sigma", "start");
    out << "<g stroke=\"#ccc\">\n";
    for (int k = 0; k <= decades; ++k)
      out << "<path d=\"M" << left[0] << ' ' << y_of(1.0 * k / decades) << 'h' << width << "\"/>\n";
    for (int k = 0; k <= 5; ++k) out << "<path d=\"M" << left[1] << ' ' << y_of(k / 5.0) << 'h' << width << "\"/>\n";
    constexpr int angles[] = {0, 1, 5, 10, 20, 30, 45, 60, 75, 90};
    for (const int t : angles)
      out << "<path d=\"M" << left[0] + width * std::sqrt(t / 90.0) << ' ' << top << 'v' << height << "\"/>\n";
    for (int t = 0; t <= 90; t += 15)
      out << "<path d=\"M" << left[1] + width * t / 90 << ' ' << top << 'v' << height << "\"/>\n";
    out << "</g>\n";
    for (int k = 0; k <= decades; ++k)
      text(out, left[0] - 8, y_of(1.0 * k / decades) + 4,
           "10<tspan dy=\"-5\" font-size=\"9\">" + std::to_string(low + k) + "</tspan>", "end");
    for (int k = 0; k <= 5; ++k)
      text(out, left[1] - 8, y_of(k / 5.0) + 4, k == 5 ? "1" : "0." + std::to_string(2 * k), "end");
    for (const int t : angles)
      text(out, left[0] + width * std::sqrt(t / 90.0), top + height + 18, std::to_string(t), "middle");
    for (int t = 0; t <= 90; t += 15)
      text(out, left[1] + width * t / 90, top + height + 18, std::to_string(t), "middle");
    for (const double x : left) text(out, x + width / 2, top + height + 38, "theta [degrees]", "middle");
    double x = left[0];
    for (const NdfProfile& p : profiles) {
      curve(
          out, p, 512, [](double u) { return left[0] + width * u; },
          [&](double u) {
            return y_of((std::log10(std::max(p.ndf.eval(90 * degree * u * u), 1e-30)) - low) / decades);
          });
      curve(
          out, p, 90, [](double t) { return left[1] + width * t; },
          [&](double t) { return y_of(p.ndf.g1(90 * degree * t)); });
      out << "<path d=\"M" << x << " 448h40\" stroke-width=\"1.8\" stroke=\"" << p.colour << "\" stroke-dasharray=\""
          << p.dashes << "\"/>\n";
      text(out, x + 48, 452, p.name, "start");
      x += 290;
    }
    out << "</svg>\n";
  });
}

}  // namespace gonio
