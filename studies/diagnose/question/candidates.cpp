#include "studies/diagnose/question/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace millscope::diagnose {
namespace {

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> out;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('|', begin), text.size());
    if (end > begin) out.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

bool uses(const config::Case& base, const Descriptor& descriptor) {
  const auto among = [&](const std::vector<config::PluginInstance>& list) {
    return std::any_of(list.begin(), list.end(), [&](const auto& i) { return i.kind == descriptor.name; });
  };
  return base.contact.law.kind == descriptor.name || among(base.contact.interactions) || among(base.contact.pair_parameters) ||
         among(base.body_forces);
}

/// Where an instance of the plugin stands in a case, and what switches it on; nothing for kinds that no case names.
std::optional<std::string> place_of(const Descriptor& descriptor) {
  switch (static_cast<Kind>(descriptor.kind)) {
    case Kind::interaction:
      return fmt::format("contact.interactions.{}", descriptor.name);
    case Kind::pair_parameter:
      return fmt::format("contact.pair_parameters.{}", descriptor.name);
    case Kind::body_force:
      return fmt::format("body_forces.{}", descriptor.name);
    case Kind::contact_law:
      return "contact.law";
    default:
      return std::nullopt;
  }
}

const Parameter* find(const Descriptor& descriptor, const std::string& name) {
  for (std::uint64_t i = 0; i < descriptor.parameter_count; ++i) {
    if (descriptor.parameters[i].name == name) return &descriptor.parameters[i];
  }
  return nullptr;
}

/// Pairs of the case that lack a value which the plugin requires beside the hypothesis' own; "" when none does.
std::string missing(const config::Case& base, const Descriptor& descriptor, const std::string& own) {
  for (std::uint64_t i = 0; i < descriptor.parameter_count; ++i) {
    const Parameter& p = descriptor.parameters[i];
    const bool number =
        p.type == ValueType::number || p.type == ValueType::integer || p.type == ValueType::boolean || p.type == ValueType::vector;
    const bool required = p.optional == 0 && (number ? !(p.fallback == p.fallback) : p.fallback_text == nullptr);
    if (!required || p.name == own) continue;
    if (p.scope == Scope::instance) return p.name;
    for (const std::string& key : base.pairs.keys()) {
      if (!base.pairs.section().at(key).has(p.name)) return fmt::format("pairs.{}.{}", key, p.name);
    }
  }
  return "";
}

void add_plugin(const config::Case& base, const Descriptor& descriptor, Library& library) {
  const auto place = place_of(descriptor);
  for (std::uint64_t h = 0; h < descriptor.hypothesis_count; ++h) {
    const Hypothesis& of = descriptor.hypotheses[h];
    const Parameter* parameter = find(descriptor, of.parameter);
    if (!place) {
      library.left_out.push_back(
          fmt::format("{}: an effect of the camera; of these only nuisances camera.frame_error.* are tested", of.name));
    } else if (uses(base, descriptor)) {
      library.left_out.push_back(fmt::format("{}: {} is in the base case already", of.name, descriptor.name));
    } else if (parameter == nullptr) {
      library.left_out.push_back(
          fmt::format("{}: {} has no parameter '{}'; its author has to correct that", of.name, descriptor.name, of.parameter));
    } else {
      Candidate c{of.name, of.sentence, of.equation,   of.citation,   of.parameter, parameter->unit,
                  {},      {},          of.null_value, of.prior_high, {},           words(of.excludes)};
      const bool downwards = std::abs(of.prior_low - of.null_value) > std::abs(of.prior_high - of.null_value);
      if (downwards) c.far = of.prior_low;
      if (of.two_sided != 0) c.range.low = ((downwards ? of.prior_high : of.prior_low) - of.null_value) / (c.far - of.null_value);
      c.set.push_back(fmt::format("{}.kind={}", *place, descriptor.name));
      if (parameter->scope == Scope::instance) c.paths.push_back(fmt::format("{}.{}", *place, of.parameter));
      if (parameter->scope == Scope::pair) {
        for (const std::string& key : base.pairs.keys()) c.paths.push_back(fmt::format("pairs.{}.{}", key, of.parameter));
      }
      const std::string lacks = missing(base, descriptor, of.parameter);
      if (!lacks.empty())
        library.left_out.push_back(
            fmt::format("{}: needs {}; give it in the base case or under hypotheses.{}.set", of.name, lacks, of.name));
      (lacks.empty() ? library.candidates : library.incomplete).push_back(std::move(c));
    }
  }
}

}  // namespace

double rounded(double value) {
  const std::string text = fmt::format("{:.4g}", value);
  double out = value;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

double rounded_strength(const Candidate& c, double strength) {
  return c.on_or_off() ? strength : (rounded(c.value(strength)) - c.null_value) / (c.far - c.null_value);
}

std::vector<std::string> settings_of(const Candidate& candidate, double strength) {
  std::vector<std::string> settings = candidate.set;
  for (const std::string& path : candidate.paths) settings.push_back(fmt::format("{}={:.4g}", path, candidate.value(strength)));
  return settings;
}

Library library_of(const config::Case& base, const host::Registry& registry) {
  Library library;
  for (const Descriptor* descriptor : registry.descriptors()) add_plugin(base, *descriptor, library);
  add_targets(base, library);
  std::sort(library.candidates.begin(), library.candidates.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return library;
}

}  // namespace millscope::diagnose
