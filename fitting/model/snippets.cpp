#include <algorithm>
#include <locale>
#include <sstream>

#include <gonio/fitting/model/model.h>

namespace gonio {
namespace {

// Both renderers blend materials by weights instead of adding them: f = sum of w_i (f_i / w_i). The
// weights are the share of each lobe's largest reflectance, so that no blended reflectance is above
// 1 unless the sum itself is.
struct Part {
  const Lobe* lobe;
  double weight;
  glm::dvec3 reflectance;  // divided by the weight, at most 1
};

std::string rgb(const glm::dvec3& value, const char* separator) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << value.r << separator << value.g << separator << value.b;
  return out.str();
}

double largest(const glm::dvec3& value) { return std::max({value.r, value.g, value.b}); }

// Empty if a lobe is not one of `kinds`, or has different shapes per channel.
std::vector<Part> parts(const LobeModel& model, const std::vector<LobeKind>& kinds, bool& clamped) {
  std::vector<Part> result;
  double total = 0;
  for (const Lobe& lobe : model.lobes) {
    if (std::find(kinds.begin(), kinds.end(), lobe.kind) == kinds.end() || lobe.separate()) return {};
    glm::dvec3 reflectance = lobe.color[0];
    if (lobe.fresnel == Fresnel::conductor) {
      for (int c = 0; c < 3; ++c) reflectance[c] = conductor(lobe.color[0][c], lobe.color[1][c], 1.0);
    }
    if (largest(reflectance) <= 0) continue;
    result.push_back({&lobe, largest(reflectance), reflectance});
    total += largest(reflectance);
  }
  clamped = total > 1 && result.size() > 1;
  for (Part& part : result) {
    part.weight /= total;
    if (result.size() > 1) part.reflectance /= part.weight;
    if (largest(part.reflectance) > 1) clamped = true;
    for (int c = 0; c < 3; ++c) part.reflectance[c] = std::min(part.reflectance[c], 1.0);
  }
  return result;
}

// The weight of all parts from i on that part i does not take.
double rest_weight(const std::vector<Part>& all, size_t i) {
  double sum = 0;
  for (size_t k = i; k < all.size(); ++k) sum += all[k].weight;
  return 1 - all[i].weight / sum;
}

const char* clamped_note = " A reflectance above 1 was clamped to 1.";

}  // namespace

std::string pbrt_snippet(const LobeModel& model) {
  bool clamped = false;
  const std::vector<Part> all = parts(model, {LobeKind::lambert, LobeKind::ggx}, clamped);
  if (all.empty()) return {};
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "# pbrt-v4, from gonio: roughness is alpha (remaproughness false). A lobe's Fresnel term "
         "is that\n"
         "# of a conductor with the same reflectance at normal incidence; F90 has no counterpart."
      << (clamped ? clamped_note : "") << "\n";
  for (size_t i = 0; i < all.size(); ++i) {
    const Lobe& lobe = *all[i].lobe;
    out << "MakeNamedMaterial \"gonio" << i << "\" \"string type\" ";
    if (!lobe.specular()) {
      out << "\"diffuse\" \"rgb reflectance\" [" << rgb(all[i].reflectance, " ") << "]\n";
    } else if (lobe.fresnel == Fresnel::conductor && all.size() == 1) {
      out << "\"conductor\" \"rgb eta\" [" << rgb(lobe.color[0], " ") << "] \"rgb k\" [" << rgb(lobe.color[1], " ")
          << "] \"float roughness\" " << lobe.shape[0].r << " \"bool remaproughness\" false\n";
    } else {
      out << "\"conductor\" \"rgb reflectance\" [" << rgb(all[i].reflectance, " ") << "] \"float roughness\" "
          << lobe.shape[0].r << " \"bool remaproughness\" false\n";
    }
  }
  // "amount" is the share of the second material.
  std::string last = "gonio" + std::to_string(all.size() - 1);
  for (size_t i = all.size() - 1; i-- > 0;) {
    const std::string name = "gonio_mix" + std::to_string(i);
    out << "MakeNamedMaterial \"" << name << "\" \"string type\" \"mix\" \"string materials\" [\"gonio" << i << "\" \""
        << last << "\"] \"float amount\" " << rest_weight(all, i) << "\n";
    last = name;
  }
  out << "NamedMaterial \"" << last << "\"\n";
  return out.str();
}

std::string mitsuba_snippet(const LobeModel& model) {
  bool clamped = false;
  const std::vector<Part> all = parts(model, {LobeKind::lambert, LobeKind::ggx, LobeKind::beckmann}, clamped);
  if (all.empty()) return {};
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "<!-- Mitsuba 3, from gonio: alpha is alpha. A Schlick lobe keeps its reflectance at "
         "normal\n"
         "     incidence at all angles (F90 has no counterpart); masking is separable there."
      << (clamped ? clamped_note : "") << " -->\n";
  const auto write = [&](const Part& part, const std::string& indent) {
    const Lobe& lobe = *part.lobe;
    if (!lobe.specular()) {
      out << indent << "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"" << rgb(part.reflectance, ", ")
          << "\"/></bsdf>\n";
      return;
    }
    out << indent << "<bsdf type=\"roughconductor\">\n"
        << indent << "  <string name=\"distribution\" value=\"" << lobe_info(lobe.kind).id << "\"/>\n"
        << indent << "  <float name=\"alpha\" value=\"" << lobe.shape[0].r << "\"/>\n";
    if (lobe.fresnel == Fresnel::conductor && all.size() == 1) {
      // A plain <rgb> is refused above 1.
      const auto unbounded = [&](const char* name, const glm::dvec3& value) {
        out << indent << "  <spectrum name=\"" << name << "\" type=\"srgb\"><rgb name=\"color\" value=\""
            << rgb(value, ", ") << "\"/><boolean name=\"unbounded\" value=\"true\"/></spectrum>\n";
      };
      unbounded("eta", lobe.color[0]);
      unbounded("k", lobe.color[1]);
    } else {
      out << indent << "  <string name=\"material\" value=\"none\"/>\n"
          << indent << "  <rgb name=\"specular_reflectance\" value=\"" << rgb(part.reflectance, ", ") << "\"/>\n";
    }
    out << indent << "</bsdf>\n";
  };
  // weight is the share of the second BSDF.
  std::string indent;
  for (size_t i = 0; i + 1 < all.size(); ++i) {
    out << indent << "<bsdf type=\"blendbsdf\">\n"
        << indent << "  <float name=\"weight\" value=\"" << rest_weight(all, i) << "\"/>\n";
    indent += "  ";
    write(all[i], indent);
  }
  write(all.back(), indent);
  while (!indent.empty()) {
    indent.resize(indent.size() - 2);
    out << indent << "</bsdf>\n";
  }
  return out.str();
}

}  // namespace gonio
