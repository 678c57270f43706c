#include "kernel/config/values.hpp"

#include <fmt/format.h>
#include <cmath>
#include <deque>

#include "kernel/config/units.hpp"

namespace millscope::config {

struct ResolvedValues::Storage {
  std::deque<std::string> strings;
  std::vector<Value> items;
  std::vector<Location> places;
  Location section;

  const char* keep(std::string text) {
    strings.push_back(std::move(text));
    return strings.back().c_str();
  }
};

namespace {

using Storage = ResolvedValues::Storage;

std::string first_choice(const Parameter& p) {
  const std::string choices = p.choices;
  return choices.substr(0, choices.find('|'));
}

/// Presence of a default: NaN and nullptr mean none.
bool has_default(const Parameter& p) {
  switch (p.type) {
    case ValueType::choice:
      return true;
    case ValueType::text:
    case ValueType::file:
      return p.fallback_text != nullptr;
    default:
      return !std::isnan(p.fallback);
  }
}

Range range_of(const Parameter& p) { return {p.minimum, p.maximum, false, false, p.doc}; }

/// "restitution (1): ratio of …": what to write.
std::string meaning(const Parameter& p) {
  const std::string unit = p.unit[0] == '\0' || std::string_view(p.unit) == "1" ? "" : fmt::format(" in {}", p.unit);
  const std::string choices = p.type == ValueType::choice ? fmt::format(" ({})", p.choices) : "";
  return fmt::format("{}{}{}", p.doc, unit.empty() ? "" : "," + unit, choices);
}

void read_written(const Parameter& p, const Node& node, Value& value, Storage& storage) {
  value.given = 1;
  switch (p.type) {
    case ValueType::number:
      value.number[0] = read_number(node, p.unit, range_of(p));
      break;
    case ValueType::integer:
      value.number[0] = static_cast<double>(read_integer(node, range_of(p)));
      break;
    case ValueType::boolean:
      value.number[0] = read_flag(node) ? 1 : 0;
      break;
    case ValueType::choice:
      value.text = storage.keep(read_choice(node, p.choices));
      break;
    case ValueType::text:
      value.text = storage.keep(node.text());
      break;
    case ValueType::file:
      value.text = storage.keep(resolve_file(node));
      break;
    case ValueType::vector: {
      const auto components = read_vector(node, p.unit, range_of(p));
      for (std::size_t i = 0; i < 3; ++i) value.number[i] = components[i];
      break;
    }
  }
}

void take_default(const Parameter& p, Value& value, Storage& storage) {
  value.given = has_default(p) && p.optional == 0 ? 1 : 0;
  if (p.type == ValueType::file && has_default(p) && p.fallback_text[0] == '\0') value.given = 0;
  if (p.fallback_text != nullptr) {
    const bool first = p.type == ValueType::choice && p.fallback_text[0] == '\0';
    value.text = storage.keep(first ? first_choice(p) : p.fallback_text);
  }
  if (std::isnan(p.fallback)) return;
  for (double& component : value.number) component = p.fallback;
  if (p.type != ValueType::vector) value.number[1] = value.number[2] = 0;
}

void resolve_one(const Parameter& p, const Node& node, Storage& storage, bool must_be_present) {
  Value value{};
  value.name = storage.keep(p.name);
  value.text = "";
  const bool required = must_be_present && p.optional == 0 && !has_default(p);
  const std::optional<Node> written = required ? node.at(p.name, meaning(p)) : node.find(p.name);
  if (written) {
    read_written(p, *written, value, storage);
  } else {
    take_default(p, value, storage);
  }
  storage.items.push_back(value);
  storage.places.push_back(written ? written->where() : node.where());
}

/// Unknown keys first: a misspelt key is a better message than the one that it leaves missing.
void refuse_unknown(const Descriptor& descriptor, const Node& node) {
  for (std::uint64_t i = 0; i < descriptor.parameter_count; ++i) {
    if (descriptor.parameters[i].scope == Scope::instance) node.has(descriptor.parameters[i].name);
  }
  node.expect({});
}

void resolve_scope(const Descriptor& descriptor, const Node& node, Scope scope, bool must_be_present, Storage& storage) {
  if (scope == Scope::instance) refuse_unknown(descriptor, node);
  for (std::uint64_t i = 0; i < descriptor.parameter_count; ++i) {
    if (descriptor.parameters[i].scope == scope) resolve_one(descriptor.parameters[i], node, storage, must_be_present);
  }
}

}  // namespace

ResolvedValues::ResolvedValues() : storage_(std::make_shared<Storage>()) {}

Values ResolvedValues::view() const { return {storage_->items.data(), storage_->items.size()}; }

const Location& ResolvedValues::where(std::string_view name) const {
  for (std::size_t i = 0; i < storage_->items.size(); ++i) {
    if (name == storage_->items[i].name) return storage_->places[i];
  }
  return storage_->section;
}

ResolvedValues resolve(const Descriptor& descriptor, const Node& node, Scope scope) {
  auto storage = std::make_shared<Storage>();
  storage->section = node.where();
  resolve_scope(descriptor, node, scope, true, *storage);
  return ResolvedValues(storage);
}

ResolvedValues resolve_for_pair(const Descriptor& descriptor, const Node& instance, const Node& pair) {
  auto storage = std::make_shared<Storage>();
  storage->section = pair.where();
  resolve_scope(descriptor, instance, Scope::instance, true, *storage);
  resolve_scope(descriptor, pair, Scope::pair, true, *storage);
  return ResolvedValues(storage);
}

ResolvedValues resolve_present(const Descriptor& descriptor, const Node& node, Scope scope) {
  auto storage = std::make_shared<Storage>();
  storage->section = node.where();
  resolve_scope(descriptor, node, scope, false, *storage);
  return ResolvedValues(storage);
}

const Descriptor* find_descriptor(std::span<const Descriptor* const> descriptors, Kind kind, std::string_view name) {
  for (const Descriptor* d : descriptors) {
    if (d->kind == static_cast<std::uint32_t>(kind) && name == d->name) return d;
  }
  return nullptr;
}

}  // namespace millscope::config
