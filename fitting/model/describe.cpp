#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <gonio/fitting/model/model.h>
#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

constexpr const char* default_material =
    "lambert:albedo=0.42/0.085/0.025+ggx:alpha=0.28,F0=0.03/0.022/0.016,F90=0.35+"
    "ggx:alpha=0.07,F0=0.035,F90=0.6";

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string in_quotes(std::string_view text) { return "'" + std::string(text) + "'"; }

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  size_t begin = 0;
  for (size_t end; (end = text.find(separator, begin)) != text.npos; begin = end + 1) {
    parts.push_back(text.substr(begin, end - begin));
  }
  parts.push_back(text.substr(begin));
  return parts;
}

// '+' also occurs in 1e+3: a lobe's name begins with a letter.
std::vector<std::string_view> split_lobes(std::string_view text) {
  std::vector<std::string_view> parts;
  size_t begin = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool exponent = i > 0 && (text[i - 1] == 'e' || text[i - 1] == 'E') && i + 1 < text.size() &&
                          std::isdigit(static_cast<unsigned char>(text[i + 1]));
    if (text[i] != '+' || exponent) continue;
    parts.push_back(text.substr(begin, i - begin));
    begin = i + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

LobeKind kind_of(std::string_view name) {
  std::vector<std::string> known;
  for (LobeKind kind : lobe_kinds()) {
    if (lower(name) == lobe_info(kind).id) return kind;
    known.push_back(lobe_info(kind).id);
  }
  throw Error("model description: unknown lobe " + in_quotes(name) + "; expected " + one_of(known, std::string(name)));
}

double number(std::string_view text, std::string_view parameter) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw Error("model description: value " + in_quotes(text) + " of " + in_quotes(parameter) + " is not a number");
  }
  return value;
}

glm::dvec3 color_value(std::string_view text, std::string_view parameter) {
  const std::vector<std::string_view> parts = split(text, '/');
  if (parts.size() == 1) return glm::dvec3(number(parts[0], parameter));
  if (parts.size() != 3) {
    throw Error("model description: " + in_quotes(parameter) + " has " + std::to_string(parts.size()) +
                " values; expected one, or red/green/blue");
  }
  return {number(parts[0], parameter), number(parts[1], parameter), number(parts[2], parameter)};
}

struct Slot {
  glm::dvec3* value;
  const Parameter* parameter;
};

// The place of a parameter in a lobe. A conductor's parameters turn a specular lobe into a
// conductor.
std::optional<Slot> find_parameter(Lobe& lobe, const std::string& name) {
  const LobeInfo& info = lobe_info(lobe.kind);
  for (size_t i = 0; i < info.shape.size(); ++i) {
    if (name == lower(info.shape[i].name)) return Slot{&lobe.shape[i], &info.shape[i]};
  }
  for (Fresnel fresnel : {lobe.fresnel, Fresnel::conductor}) {
    const std::vector<Parameter>& colors = color_parameters(lobe.kind, fresnel);
    for (size_t i = 0; i < colors.size(); ++i) {
      if (name == lower(colors[i].name)) return Slot{&lobe.color[i], &colors[i]};
    }
  }
  return std::nullopt;
}

/// The names of all parameters that the lobes of a model may have, each once.
std::vector<std::string> parameter_names(const LobeModel& model) {
  std::vector<std::string> names;
  const auto add = [&](const std::vector<Parameter>& parameters) {
    for (const Parameter& p : parameters)
      if (std::find(names.begin(), names.end(), p.name) == names.end()) names.push_back(p.name);
  };
  for (const Lobe& lobe : model.lobes) {
    add(lobe_info(lobe.kind).shape);
    add(color_parameters(lobe.kind, Fresnel::schlick));
    add(color_parameters(lobe.kind, Fresnel::conductor));
  }
  return names;
}

void assign(Lobe& lobe, const std::string& name, std::string_view text) {
  if (lobe.specular() && lobe.fresnel == Fresnel::schlick && (name == "eta" || name == "k")) {
    const Lobe untouched = Lobe::initial(lobe.kind);
    if (lobe.color != untouched.color) {
      throw Error("model description: a lobe has both " + in_quotes(name) + " and F0 or F90");
    }
    const auto shape = lobe.shape;
    lobe = Lobe::initial(lobe.kind, Fresnel::conductor);
    lobe.shape = shape;
  }
  const Slot slot = *find_parameter(lobe, name);
  const glm::dvec3 value = color_value(text, name);
  for (int channel = 0; channel < 3; ++channel) {
    if (!(value[channel] >= slot.parameter->min && value[channel] <= slot.parameter->max)) {
      std::ostringstream message;
      message << "model description: " << lobe_info(lobe.kind).id << " parameter '" << slot.parameter->name << "' is "
              << value[channel] << "; expected " << slot.parameter->min << " to " << slot.parameter->max;
      throw Error(message.str());
    }
  }
  *slot.value = value;
}

}  // namespace

LobeModel parse_model(std::string_view text) {
  LobeModel model;
  model.name = std::string(text);
  const std::string_view source = lower(text) == "default" ? default_material : text;

  struct Setting {
    size_t lobe;
    std::string_view text;
  };
  std::vector<Setting> settings;
  for (std::string_view part : split_lobes(source)) {
    const size_t colon = part.find(':');
    model.lobes.push_back(Lobe::initial(kind_of(part.substr(0, colon))));
    if (colon == part.npos) continue;
    for (std::string_view setting : split(part.substr(colon + 1), ',')) {
      settings.push_back({model.lobes.size() - 1, setting});
    }
  }
  std::set<std::pair<const Lobe*, std::string>> given;
  for (const Setting& setting : settings) {
    const size_t equals = setting.text.find('=');
    if (equals == setting.text.npos) {
      throw Error("model description: found " + in_quotes(setting.text) + "; expected name=value");
    }
    const std::string name = lower(setting.text.substr(0, equals));
    Lobe* target = find_parameter(model.lobes[setting.lobe], name) ? &model.lobes[setting.lobe] : nullptr;
    int owners = 0;
    if (!target) {
      for (Lobe& lobe : model.lobes) {
        if (!find_parameter(lobe, name)) continue;
        target = &lobe;
        ++owners;
      }
    }
    if (!target) {
      throw Error("model description: no lobe of " + in_quotes(text) + " has a parameter " + in_quotes(name) +
                  "; expected " + one_of(parameter_names(model), name));
    }
    if (owners > 1) {
      throw Error("model description: " + std::to_string(owners) + " lobes of " + in_quotes(text) +
                  " have a parameter " + in_quotes(name) + "; write it right after the lobe it belongs to");
    }
    if (!given.insert({target, name}).second) {
      throw Error("model description: found " + in_quotes(name) + " of " + lobe_info(target->kind).id +
                  " twice; expected it once");
    }
    assign(*target, name, setting.text.substr(equals + 1));
  }
  return model;
}

std::string describe(const LobeModel& model) {
  std::string out;
  const auto write_number = [&out](double value) {
    char buffer[32];
    out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  };
  const auto write = [&](const char* name, const glm::dvec3& value, char& separator) {
    out += separator;
    out += name;
    out += '=';
    write_number(value.r);
    if (value.g != value.r || value.b != value.r) {
      out += '/';
      write_number(value.g);
      out += '/';
      write_number(value.b);
    }
    separator = ',';
  };
  for (const Lobe& lobe : model.lobes) {
    if (&lobe != model.lobes.data()) out += '+';
    const LobeInfo& info = lobe_info(lobe.kind);
    out += info.id;
    char separator = ':';
    for (size_t i = 0; i < info.shape.size(); ++i) write(info.shape[i].name, lobe.shape[i], separator);
    const std::vector<Parameter>& colors = color_parameters(lobe.kind, lobe.fresnel);
    for (size_t i = 0; i < colors.size(); ++i) write(colors[i].name, lobe.color[i], separator);
  }
  return out;
}

}  // namespace gonio
