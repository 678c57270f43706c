// The case as YAML again: every default filled in, SI numbers.
#include "kernel/config/writer.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "kernel/config/values.hpp"
#include "kernel/config/yaml_lines.hpp"

namespace millscope::config {
namespace {

class Writer {
 public:
  Writer(const Case& c, std::span<const Descriptor* const> descriptors) : c_(c), descriptors_(descriptors) {}

  std::string write() {
    write_head(out_, c_);
    write_materials(out_, c_);
    write_beads(out_, c_.beads);
    write_fill(out_, c_.fill);
    contact();
    pairs();
    instances("body_forces", Kind::body_force, c_.body_forces);
    write_mill(out_, c_.mill);
    geometry();
    write_domain(out_, c_.domain);
    write_time(out_, c_.time);
    write_start(out_, c_.start);
    write_output(out_, c_.output);
    write_run(out_, c_.run);
    return out_.text();
  }

 private:
  void contact() {
    out_.open("contact");
    instance("law", Kind::contact_law, c_.contact.law);
    if (!c_.contact.interactions.empty()) instances("interactions", Kind::interaction, c_.contact.interactions);
    if (!c_.contact.pair_parameters.empty()) instances("pair_parameters", Kind::pair_parameter, c_.contact.pair_parameters);
    if (!c_.contact.wear.empty()) instances("wear", Kind::wear_law, c_.contact.wear);
    out_.close();
  }

  void instances(std::string_view key, Kind kind, const std::vector<PluginInstance>& list) {
    if (list.empty()) return out_.value(key, "{}");
    out_.open(key);
    for (const PluginInstance& i : list) instance(i.name, kind, i);
    out_.close();
  }

  void instance(std::string_view key, Kind kind, const PluginInstance& i) {
    out_.open(key);
    out_.value("kind", i.kind);
    parameters(kind, i);
    out_.close();
  }

  void parameters(Kind kind, const PluginInstance& i) {
    if (const Descriptor* d = find_descriptor(descriptors_, kind, i.kind)) return values(*d, i.node, Scope::instance);
    for (const std::string& key : i.node.keys()) {
      if (key != "kind" && key != "material" && key != "materials" && key != "motion") raw(key, i.node.at(key));
    }
  }

  void values(const Descriptor& d, const Node& node, Scope scope) {
    const ResolvedValues resolved = resolve_present(d, node, scope);
    const Values view = resolved.view();
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < d.parameter_count; ++i) {
      if (d.parameters[i].scope != scope) continue;
      const Value& value = view.items[next++];
      if (value.given != 0) one_value(d.parameters[i], value);
    }
  }

  void one_value(const Parameter& p, const Value& value) {
    switch (p.type) {
      case ValueType::boolean:
        return out_.value(p.name, value.number[0] != 0 ? "true" : "false");
      case ValueType::choice:
      case ValueType::text:
      case ValueType::file:
        return out_.value(p.name, quoted(value.text));
      case ValueType::vector:
        if (std::isfinite(value.number[0])) out_.value(p.name, vector_text(value.number));
        return;
      default:
        if (std::isfinite(value.number[0])) out_.value(p.name, value.number[0]);
    }
  }

  /// As written, for what no descriptor explains.
  void raw(const std::string& key, const Node& node) {
    if (!node.is_map()) return out_.value(key, raw_text(node));
    out_.open(key);
    for (const std::string& below : node.keys()) raw(below, node.at(below));
    out_.close();
  }
  static std::string raw_text(const Node& node) {
    if (node.is_scalar()) return quoted(node.text());
    std::string list;
    if (node.is_sequence()) {
      for (const Node& item : node.items()) list += (list.empty() ? "" : ", ") + raw_text(item);
      return "[" + list + "]";
    }
    for (const std::string& key : node.keys()) list += fmt::format("{}{}: {}", list.empty() ? "" : ", ", key, raw_text(node.at(key)));
    return "{" + list + "}";
  }

  void pairs() {
    std::vector<const Descriptor*> on_pairs{find_descriptor(descriptors_, Kind::contact_law, c_.contact.law.kind)};
    for (const PluginInstance& i : c_.contact.interactions) on_pairs.push_back(find_descriptor(descriptors_, Kind::interaction, i.kind));
    for (const PluginInstance& i : c_.contact.pair_parameters)
      on_pairs.push_back(find_descriptor(descriptors_, Kind::pair_parameter, i.kind));
    for (const PluginInstance& i : c_.contact.wear) on_pairs.push_back(find_descriptor(descriptors_, Kind::wear_law, i.kind));
    const bool all_known = std::find(on_pairs.begin(), on_pairs.end(), nullptr) == on_pairs.end();
    if (c_.pairs.keys().empty()) return out_.value("pairs", "{}");
    out_.open("pairs");
    for (const std::string& key : c_.pairs.keys())
      pair(key, c_.pairs.section().at(key), all_known ? on_pairs : std::vector<const Descriptor*>{});
    out_.close();
  }

  void pair(const std::string& key, const Node& node, const std::vector<const Descriptor*>& on_pairs) {
    if (on_pairs.empty()) return raw(key, node);
    Lines before = out_;
    out_.open(key);
    const std::size_t empty = out_.text().size();
    std::vector<std::string> written;
    for (const Descriptor* d : on_pairs) pair_values(*d, node, written);
    const bool nothing = out_.text().size() == empty;
    out_.close();
    if (nothing) {
      out_ = before;
      out_.value(key, "{}");
    }
  }

  /// Two plugins may share a pair's key: it is written once.
  void pair_values(const Descriptor& d, const Node& node, std::vector<std::string>& written) {
    const ResolvedValues resolved = resolve_present(d, node, Scope::pair);
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < d.parameter_count; ++i) {
      const Parameter& p = d.parameters[i];
      if (p.scope != Scope::pair) continue;
      const Value& value = resolved.view().items[next++];
      const bool again = std::find(written.begin(), written.end(), p.name) != written.end();
      if (value.given == 0 || again) continue;
      written.emplace_back(p.name);
      one_value(p, value);
    }
  }

  void geometry() {
    if (c_.geometry.empty()) return out_.value("geometry", "{}");
    out_.open("geometry");
    for (const GeometryCase& g : c_.geometry) {
      out_.open(g.plugin.name);
      out_.value("kind", g.plugin.kind);
      parameters(Kind::geometry, g.plugin);
      if (!g.material.empty()) out_.value("material", g.material);
      if (!g.materials.empty()) out_.open("materials");
      for (const auto& [slot, material] : g.materials) out_.value(slot, material);
      if (!g.materials.empty()) out_.close();
      write_motion(out_, g.motion);
      out_.close();
    }
    out_.close();
  }

  const Case& c_;
  std::span<const Descriptor* const> descriptors_;
  Lines out_;
};

}  // namespace

std::string quoted(const std::string& text) { return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace); }

std::string resolved_yaml(const Case& c, std::span<const Descriptor* const> descriptors) { return Writer(c, descriptors).write(); }

}  // namespace millscope::config
