#include <algorithm>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <memory>

#include <glm/geometric.hpp>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/texture/solid.h>

namespace gonio {
namespace {

using V = Vec3<double>;

int vertex_count(int rows, int columns) { return 2 + (rows - 1) * columns; }

/// Vertex of row r (0: nadir, rows: zenith) and column c.
int vertex(int r, int c, int rows, int columns) {
  return r == 0 ? 0 : r == rows ? vertex_count(rows, columns) - 1 : 1 + (r - 1) * columns + c % columns;
}

LightAngles angles_of(int r, int c, int rows, int columns) {
  return {2 * pi<double> * c / columns, pi<double> * r / rows};
}

/// Distance of a point to a triangle (Ericson 2005, section 5.1.5, by regions of the barycentric
/// plane).
double distance(const V& p, const V& a, const V& b, const V& c) {
  const V ab = b - a, ac = c - a, ap = p - a;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return glm::length(ap);
  const V bp = p - b;
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return glm::length(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return glm::length(ap - d1 / (d1 - d3) * ab);
  const V cp = p - c;
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return glm::length(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return glm::length(ap - d2 / (d2 - d6) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return glm::length(bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
  const double sum = va + vb + vc;
  if (!(sum > 0)) return std::min({glm::length(ap), glm::length(bp), glm::length(cp)});
  return glm::length(ap - vb / sum * ab - vc / sum * ac);
}

/// The largest distance of a vertex of `from` to the surface `to`, both on the same directions.
double one_sided(const std::vector<double>& from, const std::vector<double>& to, int rows, int columns) {
  const auto point = [&](const std::vector<double>& radius, int r, int c) {
    const LightAngles a = angles_of(r, c, rows, columns);
    return radius[static_cast<std::size_t>(vertex(r, c, rows, columns))] * LightFrame{}.direction(a.c, a.gamma);
  };
  std::vector<V> surface;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c < columns; ++c) surface.push_back(point(to, r, c));
  const auto at = [&](int r, int c) {
    return surface[static_cast<std::size_t>(r * columns + ((c % columns) + columns) % columns)];
  };
  double largest = 0;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const V p = point(from, r, c);
      // The point of the other surface in the same direction is this near: nothing farther matters.
      double nearest = glm::length(p - at(r, c));
      if (nearest <= largest) continue;
      const double reach = glm::length(p) > nearest ? std::asin(nearest / glm::length(p)) : pi<double>;
      const int row_reach = static_cast<int>(std::ceil(reach / pi<double> * rows)) + 1;
      for (int i = std::max(r - row_reach, 0); i < std::min(r + row_reach, rows) && nearest > largest; ++i)
        for (int k = 0; k < columns; ++k) {
          const V a = at(i, k), b = at(i + 1, k), d = at(i + 1, k + 1), e = at(i, k + 1);
          nearest = std::min({nearest, distance(p, a, b, d), distance(p, a, d, e)});
        }
      largest = std::max(largest, nearest);
    }
  return largest;
}

template <class T>
void put(std::ostream& stream, T value) {
  unsigned char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  stream.write(reinterpret_cast<const char*>(bytes), sizeof(T));
}

}  // namespace

Reconstruction bilinear_reconstruction(LightDiagram diagram) {
  return [d = std::make_shared<LightDiagram>(std::move(diagram))](const V& w) { return d->intensity(w); };
}

Reconstruction texture_reconstruction(LightTexture texture) {
  return [t = std::make_shared<LightTexture>(std::move(texture))](const V& w) { return t->intensity(w); };
}

Reconstruction two_plane_reconstruction(LightDiagram diagram) {
  return [d = std::make_shared<LightDiagram>(std::move(diagram))](const V& w) { return two_plane_intensity(*d, w); };
}

Mesh photometric_solid(const Reconstruction& intensity, int rows, int columns, double scale) {
  if (rows < 2 || columns < 3)
    throw Error("photometric solid: found " + std::to_string(rows) + " rows and " + std::to_string(columns) +
                " columns, expected at least 2 and 3");
  Mesh mesh;
  const auto add = [&](int r, int c) {
    const LightAngles a = angles_of(r, c, rows, columns);
    const V w = LightFrame{}.direction(a.c, a.gamma);
    mesh.vertices.push_back(Vec3<float>(intensity(w) * scale * w));
  };
  add(0, 0);
  for (int r = 1; r < rows; ++r)
    for (int c = 0; c < columns; ++c) add(r, c);
  add(rows, 0);
  const auto at = [&](int r, int c) { return vertex(r, c, rows, columns); };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      // C turns counter-clockwise seen from above, gamma rises: (r, c), (r, c + 1), (r + 1, c + 1)
      // faces out.
      if (r > 0) mesh.triangles.push_back({at(r, c), at(r, c + 1), at(r + 1, c + 1)});
      if (r + 1 < rows) mesh.triangles.push_back({at(r, c), at(r + 1, c + 1), at(r + 1, c)});
    }
  return mesh;
}

void write_obj(std::ostream& stream, const Mesh& mesh, const std::string& name) {
  std::string line = name;
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  stream << "# photometric solid: distance from the origin is the luminous intensity\no " << line << "\n"
         << std::setprecision(9);
  for (const Vec3<float>& v : mesh.vertices) stream << "v " << v.x << ' ' << v.y << ' ' << v.z << "\n";
  for (const auto& t : mesh.triangles) stream << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << "\n";
}

void write_ply(std::ostream& stream, const Mesh& mesh) {
  stream << "ply\nformat binary_little_endian 1.0\ncomment photometric solid: distance from the "
            "origin is the "
            "luminous intensity\nelement vertex "
         << mesh.vertices.size() << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
         << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3<float>& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) put(stream, v[k]);
  for (const auto& t : mesh.triangles) {
    put(stream, static_cast<unsigned char>(3));
    for (int v : t) put(stream, v);
  }
}

LightDifference compare(const Reconstruction& reference, const Reconstruction& other, int rows) {
  if (rows < 2) throw Error("compare: found " + std::to_string(rows) + " rows, expected at least 2");
  const int columns = 2 * rows;
  std::vector<double> a, b;
  double largest = 0;
  const auto add = [&](int r, int c) {
    const LightAngles angles = angles_of(r, c, rows, columns);
    const V w = LightFrame{}.direction(angles.c, angles.gamma);
    a.push_back(reference(w)), b.push_back(other(w));
    largest = std::max(largest, a.back());
  };
  add(0, 0);
  for (int r = 1; r < rows; ++r)
    for (int c = 0; c < columns; ++c) add(r, c);
  add(rows, 0);
  if (!(largest > 0)) throw Error("compare: the reference is dark everywhere, expected some light");
  LightDifference result{0, 0, 0, 0};
  double square = 0, weight = 0, flux_a = 0, flux_b = 0;
  for (int r = 0; r <= rows; ++r) {
    const double w = std::sin(pi<double> * r / rows);  // poles have no solid angle
    for (int c = 0; c < columns; ++c) {
      const std::size_t k = static_cast<std::size_t>(vertex(r, c, rows, columns));
      const double difference = (b[k] - a[k]) / largest;
      result.largest = std::max(result.largest, std::abs(difference));
      square += w * difference * difference, weight += w;
      flux_a += w * a[k], flux_b += w * b[k];
    }
  }
  result.rms = std::sqrt(square / weight);
  result.flux = flux_b / flux_a - 1;
  for (double& v : a) v /= largest;
  for (double& v : b) v /= largest;
  result.hausdorff = std::max(one_sided(a, b, rows, columns), one_sided(b, a, rows, columns));
  return result;
}

LightDiagram every_second(const LightDiagram& d) {
  if (d.gamma.size() < 3 || d.gamma.size() % 2 == 0)
    throw Error("every second angle: found " + std::to_string(d.gamma.size()) +
                " parallels, expected an odd number of at least 3");
  const bool halve_c = d.c.size() >= 9 && d.c.size() % 2 == 1;
  LightDiagram result;
  result.frame = d.frame;
  for (std::size_t j = 0; j < d.gamma.size(); j += 2) result.gamma.push_back(d.gamma[j]);
  for (std::size_t i = 0; i < d.c.size(); i += halve_c ? 2 : 1) {
    result.c.push_back(d.c[i]);
    for (std::size_t j = 0; j < d.gamma.size(); j += 2) result.cd.push_back(d.at(i, j));
  }
  return result;
}

Prediction predict_left_out(const LightDiagram& d, const Reconstruction& from_the_rest) {
  const bool halved_c = d.c.size() >= 9 && d.c.size() % 2 == 1;
  const double largest = max_intensity(d);
  Prediction p{0, 0, 0};
  for (std::size_t i = 0; i + 1 < d.c.size(); ++i)
    for (std::size_t j = 0; j < d.gamma.size(); ++j) {
      if (j % 2 == 0 && (i % 2 == 0 || !halved_c)) continue;
      if (d.gamma[j] == 0 || d.gamma[j] > 3.1415) continue;  // the poles are known
      const double error = (from_the_rest(d.frame.direction(d.c[i], d.gamma[j])) - d.at(i, j)) / largest;
      p.rms += error * error, p.largest = std::max(p.largest, std::abs(error)), ++p.angles;
    }
  if (p.angles > 0) p.rms = std::sqrt(p.rms / static_cast<double>(p.angles));
  return p;
}

}  // namespace gonio
