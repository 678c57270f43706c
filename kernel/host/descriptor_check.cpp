#include "kernel/host/descriptor_check.hpp"

#include <dlfcn.h>
#include <fmt/core.h>

#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include "kernel/config/document.hpp"
#include "kernel/host/registry.hpp"
#include "millscope/analyzer.hpp"
#include "millscope/body_force.hpp"
#include "millscope/contact_law.hpp"
#include "millscope/geometry.hpp"
#include "millscope/interaction.hpp"
#include "millscope/observation.hpp"
#include "millscope/pair_parameter.hpp"
#include "millscope/wear_law.hpp"

namespace millscope::host {

namespace {

struct KindLayout {
  Kind kind;
  std::uint64_t layout;
  std::uint64_t table_size;
};

constexpr KindLayout kLayouts[] = {
    {Kind::contact_law, kContactLawLayout, sizeof(ContactLawTable)},
    {Kind::interaction, kInteractionLayout, sizeof(InteractionTable)},
    {Kind::pair_parameter, kPairParameterLayout, sizeof(PairParameterTable)},
    {Kind::body_force, kBodyForceLayout, sizeof(BodyForceTable)},
    {Kind::geometry, kGeometryLayout, sizeof(GeometryTable)},
    {Kind::observation, kObservationLayout, sizeof(ObservationTable)},
    {Kind::analyzer, kAnalyzerLayout, sizeof(AnalyzerTable)},
    {Kind::wear_law, kWearLawLayout, sizeof(WearLawTable)},
};

const KindLayout* layout_of(std::uint32_t kind) {
  for (const KindLayout& known : kLayouts) {
    if (static_cast<std::uint32_t>(known.kind) == kind) return &known;
  }
  return nullptr;
}

std::string abi_complaint(std::uint32_t version) {
  if (version == kAbiVersion) return "";
  return fmt::format("built against SDK ABI {}, this millscope has {}: {}rebuild the plugin with this millscope's SDK", version,
                     kAbiVersion, version > kAbiVersion ? "update millscope, or " : "");
}

bool readable(const char* string) { return string != nullptr && is_mapped(string, 1); }

bool is_word(std::string_view word) {
  if (word.empty() || word.size() > 64 || word.front() < 'a' || word.front() > 'z') return false;
  for (const char c : word) {
    if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_')) return false;
  }
  return true;
}

bool lists_choice(std::string_view choices, std::string_view word) {
  for (std::size_t start = 0; start <= choices.size();) {
    const std::size_t end = std::min(choices.find('|', start), choices.size());
    if (choices.substr(start, end - start) == word) return true;
    start = end + 1;
  }
  return false;
}

std::string default_complaint(const Parameter& p) {
  const bool numeric =
      p.type == ValueType::number || p.type == ValueType::integer || p.type == ValueType::boolean || p.type == ValueType::vector;
  if (numeric) {
    if (std::isnan(p.minimum) || std::isnan(p.maximum) || p.minimum > p.maximum) return "has an empty range";
    if (!std::isnan(p.fallback) && !(p.fallback >= p.minimum && p.fallback <= p.maximum)) {
      return fmt::format("has the default {:g} outside its range {:g} to {:g}", p.fallback, p.minimum, p.maximum);
    }
    if (p.type == ValueType::integer && !std::isnan(p.fallback) && p.fallback != std::floor(p.fallback))
      return "has a default that is not whole";
  }
  if (p.type == ValueType::choice) {
    if (*p.choices == '\0' || lists_choice(p.choices, "")) return "lists an empty choice";
    if (p.fallback_text != nullptr && !lists_choice(p.choices, p.fallback_text)) {
      return fmt::format("has the default '{}' that is not among its choices {}", p.fallback_text, p.choices);
    }
  }
  return "";
}

std::string parameter_complaint(const Parameter& p) {
  if (!readable(p.name)) return "a parameter has no name";
  const auto say = [&p](const std::string& what) { return fmt::format("parameter '{}' {}", p.name, what); };
  if (!is_word(p.name)) return say("has a name that is not lower_case_words");
  if (!readable(p.unit) || !readable(p.doc) || !readable(p.citation) || !readable(p.choices)) {
    return say("has a null unit, doc, citation or choices; use \"\"");
  }
  if (*p.doc == '\0') return say("has no doc");
  if (static_cast<std::uint32_t>(p.type) > static_cast<std::uint32_t>(ValueType::vector)) return say("has an unknown type");
  if (static_cast<std::uint32_t>(p.scope) > static_cast<std::uint32_t>(Scope::pair)) return say("has an unknown scope");
  if (p.fallback_text != nullptr && !readable(p.fallback_text)) return say("has a default text that cannot be read");
  const std::string trouble = default_complaint(p);
  return trouble.empty() ? "" : say(trouble);
}

std::string parameters_complaint(const Descriptor& d) {
  if (d.parameter_count == 0) return "";
  if (d.parameter_count > 256 || !is_mapped(d.parameters, d.parameter_count * sizeof(Parameter)))
    return "its parameter list cannot be read";
  std::set<std::string> names;
  for (std::uint64_t i = 0; i < d.parameter_count; ++i) {
    const std::string trouble = parameter_complaint(d.parameters[i]);
    if (!trouble.empty()) return trouble;
    if (!names.insert(d.parameters[i].name).second) return fmt::format("parameter '{}' is listed twice", d.parameters[i].name);
  }
  return "";
}

std::string hypotheses_complaint(const Descriptor& d) {
  if (d.hypothesis_count == 0) return "";
  if (d.hypothesis_count > 64 || !is_mapped(d.hypotheses, d.hypothesis_count * sizeof(Hypothesis))) return "its hypotheses cannot be read";
  for (std::uint64_t i = 0; i < d.hypothesis_count; ++i) {
    const Hypothesis& h = d.hypotheses[i];
    for (const char* string : {h.name, h.sentence, h.equation, h.citation, h.parameter, h.excludes}) {
      if (!readable(string)) return "a hypothesis has a null text; use \"\"";
    }
    bool known = false;
    for (std::uint64_t k = 0; k < d.parameter_count; ++k) known = known || std::strcmp(d.parameters[k].name, h.parameter) == 0;
    if (!known) return fmt::format("hypothesis '{}' names the parameter '{}' that the plugin does not have", h.name, h.parameter);
    if (!(h.prior_low <= h.prior_high)) return fmt::format("hypothesis '{}' has an empty prior range", h.name);
  }
  return "";
}

std::string layout_complaint(const Descriptor& d) {
  const KindLayout* known = layout_of(d.kind);
  if (known == nullptr) return fmt::format("is of kind {} that this millscope does not know: update millscope", d.kind);
  if (d.table_size != known->table_size) {
    return fmt::format("its {} table has {} bytes, this millscope's has {}: rebuild the plugin with this millscope's SDK",
                       text(known->kind), d.table_size, known->table_size);
  }
  if (d.layout != known->layout) {
    return fmt::format("the layout of its {} structs is {:016x}, this millscope's is {:016x}: rebuild the plugin with this millscope's SDK",
                       text(known->kind), d.layout, known->layout);
  }
  if (!is_mapped(d.table, d.table_size)) return "its table cannot be read";
  return "";
}

}  // namespace

bool is_mapped(const void* address, std::uint64_t size) {
  Dl_info first{}, last{};
  if (address == nullptr) return false;
  const char* end = static_cast<const char*>(address) + (size > 0 ? size - 1 : 0);
  return ::dladdr(address, &first) != 0 && ::dladdr(end, &last) != 0 && first.dli_fbase == last.dli_fbase;
}

std::string complaint(const DescriptorList& list) {
  if (list.magic != kMagic) return "the symbol millscope_plugins is no plugin list (wrong magic number)";
  const std::string abi = abi_complaint(list.abi_version);
  if (!abi.empty()) return abi;
  if (list.size != sizeof(DescriptorList)) {
    return fmt::format("its plugin list has {} bytes, this millscope's has {}: rebuild the plugin with this millscope's SDK", list.size,
                       sizeof(DescriptorList));
  }
  if (list.count == 0) return "its plugin list is empty";
  if (list.count > 256 || !is_mapped(list.items, list.count * sizeof(Descriptor*))) return "its plugin list cannot be read";
  return "";
}

std::string complaint(const Descriptor& d) {
  if (d.magic != kMagic) return "a descriptor has the wrong magic number";
  const std::string abi = abi_complaint(d.abi_version);
  if (!abi.empty()) return abi;
  if (d.size != sizeof(Descriptor)) {
    return fmt::format("a descriptor has {} bytes, this millscope's has {}: rebuild the plugin with this millscope's SDK", d.size,
                       sizeof(Descriptor));
  }
  for (const char* string : {d.name, d.version, d.compiler, d.doc, d.equation, d.citation}) {
    if (!readable(string)) return "a descriptor has a null text (name, version, compiler, doc, equation or citation); use \"\"";
  }
  if (!is_word(d.name)) return fmt::format("the plugin name '{}' is not made of lower_case_words", d.name);
  for (const auto& check : {layout_complaint, table_complaint, parameters_complaint, hypotheses_complaint}) {
    const std::string trouble = check(d);
    if (!trouble.empty()) return fmt::format("plugin '{}': {}", d.name, trouble);
  }
  return "";
}

}  // namespace millscope::host
