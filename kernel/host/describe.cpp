#include "kernel/host/describe.hpp"

#include <fmt/core.h>

#include <cmath>
#include <span>
#include <string_view>

#include "millscope/contact_law.hpp"
#include "millscope/interaction.hpp"
#include "millscope/pair_parameter.hpp"

namespace millscope::host {

namespace {

const char* type_word(ValueType type) {
  constexpr const char* words[] = {"number", "integer", "boolean", "choice", "text", "file", "vector"};
  return words[static_cast<std::uint32_t>(type)];
}

bool is_numeric(const Parameter& p) { return p.type == ValueType::number || p.type == ValueType::integer || p.type == ValueType::vector; }

struct Bookkeeping {
  std::span<const History> histories;
  std::span<const Channel> channels;
};

Bookkeeping of(const PairTermInfo& info) { return {{info.histories, info.history_count}, {info.channels, info.channel_count}}; }

/// The histories and channels of the kinds that have them.
Bookkeeping bookkeeping_of(const Descriptor& d) {
  switch (static_cast<Kind>(d.kind)) {
    case Kind::contact_law:
      return of(static_cast<const ContactLawTable*>(d.table)->info);
    case Kind::interaction:
      return of(static_cast<const InteractionTable*>(d.table)->info);
    case Kind::pair_parameter: {
      const PairParameterInfo& info = static_cast<const PairParameterTable*>(d.table)->info;
      return {{info.histories, info.history_count}, {}};
    }
    default:
      return {};
  }
}

const char* word(ChannelPart part) {
  constexpr const char* words[] = {"normal", "tangential", "rolling"};
  return words[static_cast<std::uint32_t>(part)];
}

const char* word(ChannelNature nature) { return nature == ChannelNature::elastic ? "elastic" : "dissipative"; }

std::string default_text(const Parameter& p) {
  if (p.type == ValueType::choice || p.type == ValueType::text || p.type == ValueType::file) {
    if (p.fallback_text != nullptr) return *p.fallback_text == '\0' ? "\"\"" : p.fallback_text;
    return p.optional != 0 ? "none" : "required";
  }
  if (std::isnan(p.fallback)) return p.optional != 0 ? "none" : "required";
  if (p.type == ValueType::boolean) return p.fallback != 0.0 ? "true" : "false";
  return fmt::format("{:g}", p.fallback);
}

std::string range_text(const Parameter& p) {
  if (p.type == ValueType::choice) return p.choices;
  if (!is_numeric(p)) return "";
  const bool low = std::isfinite(p.minimum), high = std::isfinite(p.maximum);
  if (low && high) return fmt::format("{:g} to {:g}", p.minimum, p.maximum);
  if (low) return fmt::format("from {:g}", p.minimum);
  return high ? fmt::format("up to {:g}", p.maximum) : "any";
}

std::string phase_text(const Descriptor& d) {
  if (static_cast<Kind>(d.kind) == Kind::interaction) {
    return (d.features & kPreInteraction) != 0 ? "acts before the contact law" : "acts after the contact law";
  }
  if (static_cast<Kind>(d.kind) != Kind::pair_parameter) return "";
  const bool restitution = (d.features & kGivesRestitution) != 0, friction = (d.features & kGivesFriction) != 0;
  return restitution && friction ? "gives restitution and friction" : restitution ? "gives restitution" : "gives friction";
}

void add_block(std::string& page, std::string_view title, std::string_view body) {
  if (!body.empty()) page += fmt::format("\n{}\n  {}\n", title, body);
}

void add_parameters(std::string& page, const Descriptor& d, Scope scope, std::string_view title) {
  std::string rows;
  for (std::uint64_t i = 0; i < d.parameter_count; ++i) {
    const Parameter& p = d.parameters[i];
    if (p.scope != scope) continue;
    const std::string unit = *p.unit == '\0' || std::string_view(p.unit) == "1" ? "" : fmt::format(" [{}]", p.unit);
    const std::string range = range_text(p);
    rows += fmt::format("  {}{}  {}, default {}{}\n      {}{}\n", p.name, unit, type_word(p.type), default_text(p),
                        range.empty() ? "" : ", " + range, p.doc, *p.citation == '\0' ? "" : fmt::format(" ({})", p.citation));
  }
  if (!rows.empty()) page += fmt::format("\n{}\n{}", title, rows);
}

void add_bookkeeping(std::string& page, const Bookkeeping& kept) {
  std::string histories, channels;
  for (const History& h : kept.histories) {
    histories += fmt::format("{}{}{}", histories.empty() ? "" : ", ", h.name, h.sign < 0 ? " (changes sign with i<->j)" : "");
  }
  for (const Channel& c : kept.channels) {
    channels += fmt::format("{}{} ({}, {})", channels.empty() ? "" : ", ", c.name, word(c.part), word(c.nature));
  }
  add_block(page, "History per contact", histories);
  add_block(page, "Energy goes to", channels);
}

nlohmann::json number_or_null(double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr); }

nlohmann::json parameter_json(const Parameter& p) {
  nlohmann::json j = {{"name", p.name},
                      {"unit", p.unit},
                      {"doc", p.doc},
                      {"citation", p.citation},
                      {"type", type_word(p.type)},
                      {"scope", p.scope == Scope::pair ? "pair" : "instance"},
                      {"required", default_text(p) == "required"}};
  if (p.type == ValueType::choice) j["choices"] = p.choices;
  if (p.fallback_text != nullptr) {
    j["default"] = p.fallback_text;
  } else if (p.type == ValueType::boolean && !std::isnan(p.fallback)) {
    j["default"] = p.fallback != 0.0;
  } else if (is_numeric(p)) {
    j["default"] = number_or_null(p.fallback);
  }
  if (is_numeric(p)) {
    j["minimum"] = number_or_null(p.minimum);
    j["maximum"] = number_or_null(p.maximum);
  }
  return j;
}

nlohmann::json hypothesis_json(const Hypothesis& h, Kind kind) {
  return {{"name", h.name},
          {"sentence", h.sentence},
          {"equation", h.equation},
          {"citation", h.citation},
          {"parameter", h.parameter},
          {"null_value", number_or_null(h.null_value)},
          {"prior", {number_or_null(h.prior_low), number_or_null(h.prior_high)}},
          {"two_sided", h.two_sided != 0},
          {"cost", kind == Kind::observation ? "reobserve" : "resimulate"},
          {"excludes", h.excludes}};
}

}  // namespace

std::string describe(const Descriptor& d) {
  const std::string phase = phase_text(d);
  std::string page = fmt::format("{}  ({}{}, version {})\n{}\n", d.name, text(static_cast<Kind>(d.kind)), phase.empty() ? "" : "; " + phase,
                                 *d.version == '\0' ? "not stated" : d.version, d.doc);
  add_block(page, "Equation", d.equation);
  add_block(page, "Citation", d.citation);
  add_parameters(page, d, Scope::instance, "Parameters");
  add_parameters(page, d, Scope::pair, "Parameters per pair of materials (under pairs:)");
  add_bookkeeping(page, bookkeeping_of(d));
  for (std::uint64_t i = 0; i < d.hypothesis_count; ++i) {
    const Hypothesis& h = d.hypotheses[i];
    add_block(page, fmt::format("Hypothesis {}", h.name),
              fmt::format("{} Parameter {}: vanishes at {:g}, prior {:g} to {:g}{}.", h.sentence, h.parameter, h.null_value, h.prior_low,
                          h.prior_high, *h.citation == '\0' ? "" : fmt::format(" ({})", h.citation)));
  }
  return page;
}

nlohmann::json describe_json(const Descriptor& d) {
  nlohmann::json j = {{"name", d.name},
                      {"kind", text(static_cast<Kind>(d.kind))},
                      {"version", d.version},
                      {"compiler", d.compiler},
                      {"doc", d.doc},
                      {"equation", d.equation},
                      {"citation", d.citation},
                      {"parameters", nlohmann::json::array()},
                      {"hypotheses", nlohmann::json::array()},
                      {"history", nlohmann::json::array()},
                      {"channels", nlohmann::json::array()},
                      {"channel_roles", nlohmann::json::array()}};
  for (std::uint64_t i = 0; i < d.parameter_count; ++i) j["parameters"].push_back(parameter_json(d.parameters[i]));
  for (std::uint64_t i = 0; i < d.hypothesis_count; ++i)
    j["hypotheses"].push_back(hypothesis_json(d.hypotheses[i], static_cast<Kind>(d.kind)));
  const Bookkeeping kept = bookkeeping_of(d);
  for (const History& h : kept.histories) j["history"].push_back({{"name", h.name}, {"sign", h.sign}});
  for (const Channel& c : kept.channels) {
    j["channels"].push_back(c.name);
    j["channel_roles"].push_back({{"part", word(c.part)}, {"nature", word(c.nature)}});
  }
  return j;
}

std::string list_plugins(const Registry& registry) {
  std::string page;
  for (const PluginRecord& r : registry.records()) {
    page += fmt::format("{:<15} {:<24} {:<8} {:<10} {}  {}\n", r.kind, r.name, r.version.empty() ? "-" : r.version, r.instruction_set,
                        r.file_hash, r.path);
  }
  if (page.empty()) page = "no plugins\n";
  for (const std::string& directory : registry.searched()) page += fmt::format("searched: {}\n", directory);
  return page;
}

nlohmann::json provenance_json(const Registry& registry) {
  nlohmann::json list = nlohmann::json::array();
  for (const PluginRecord& r : registry.records()) {
    list.push_back({{"kind", r.kind},
                    {"name", r.name},
                    {"version", r.version},
                    {"compiler", r.compiler},
                    {"path", r.path},
                    {"instruction_set", r.instruction_set},
                    {"file_hash", r.file_hash},
                    {"code_hash", r.code_hash}});
  }
  return list;
}

}  // namespace millscope::host
