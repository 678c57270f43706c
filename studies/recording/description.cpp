#include "studies/recording/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "kernel/config/existing_file.hpp"
#include "kernel/config/units.hpp"

namespace millscope::recording {
namespace {

namespace fs = std::filesystem;
using config::Node;

void add_files(const Node& node, std::vector<RecordingFile>& files) {
  for (const fs::path one : config::matching_files(node)) {
    const bool twice = std::any_of(files.begin(), files.end(), [&](const RecordingFile& file) { return file.path == one; });
    if (twice) node.fail(fmt::format("names '{}' a second time; each run counts once", one.filename().string()));
    files.push_back({one, node.where()});
  }
}

ColumnUnit unit_of(const Node& node, Quantity quantity) {
  try {
    return column_unit(quantity, node.text());
  } catch (const std::invalid_argument& error) {
    node.fail(fmt::format("is '{}': {}", node.text(), error.what()));
  }
}

/// Where a column stands: its number from 1, or its head.
void place(const Node& column, ColumnEntry& entry) {
  const std::string& text = column.text();
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size()) {
    if (number < 1 || number > 1000) column.fail(fmt::format("is {}; columns count from 1", text));
    entry.number = number - 1;
  } else {
    entry.header = text;
  }
}

/// `{column: 3, unit: mm}` or `{column: "X [mm]", unit: mm}`; columns count from 1.
ColumnEntry read_placed(const Node& node, Quantity quantity) {
  node.expect({"column", "unit"});
  ColumnEntry entry;
  entry.quantity = quantity;
  place(node.at("column", "the number of the column from 1, or its head"), entry);
  if (const auto unit = node.find("unit")) {
    entry.unit = unit_of(*unit, quantity);
  } else if (quantity == kEvents) {
    entry.unit = column_unit(quantity, "1");
  } else {
    node.at("unit", "e.g. ms or mm");
  }
  return entry;
}

/// `label: tracer` in the order of the file, or `label: {column: 6}`.
ColumnEntry read_label(const Node& node) {
  ColumnEntry entry;
  entry.label = true;
  if (node.is_map()) {
    node.expect({"column"});
    place(node.at("column", "the number of the column from 1, or its head"), entry);
  } else if (node.text() != "tracer") {
    node.fail(fmt::format("is '{}'; write 'tracer' where the column tells tracers apart, else 'skip'", node.text()));
  }
  return entry;
}

ColumnEntry read_column(const Node& section, const std::string& key) {
  const Node node = section.at(key);
  const auto quantity = quantity_of(key);
  if (!node.is_map() && node.text() == "skip") return {};
  if (key == "label") return read_label(node);
  if (!quantity) {
    node.fail(
        "is no quantity that a recording has; known: t, x, y, z, error (or e, u), events (or n), label; write 'skip' for any other column");
  }
  if (node.is_map()) return read_placed(node, *quantity);
  ColumnEntry entry;
  entry.quantity = *quantity;
  entry.unit = unit_of(node, *quantity);
  return entry;
}

/// In the order of the file's columns, unless each says its place.
std::vector<ColumnEntry> read_columns(const Node& section) {
  std::vector<ColumnEntry> entries;
  std::size_t placed = 0;
  std::array<bool, kQuantities> there{};
  for (const std::string& key : section.keys()) {
    entries.push_back(read_column(section, key));
    ColumnEntry& entry = entries.back();
    const bool has_place = entry.number || !entry.header.empty();
    placed += has_place;
    entry.placed = has_place;
    if (!has_place) entry.number = static_cast<int>(entries.size()) - 1;
    if (!entry.quantity) continue;
    if (there[*entry.quantity]) section.at(key).fail("is the second column for one quantity; write 'skip' for the other");
    there[*entry.quantity] = true;
  }
  if (placed != 0 && placed != entries.size()) {
    section.fail("gives the place of some columns and not of others; give 'column:' for all, or list all in the order of the file");
  }
  constexpr const char* kNames[] = {"t", "x", "y", "z"};
  for (std::size_t k = 0; k < 4; ++k) {
    if (!there[k]) section.fail(fmt::format("has no '{}'; a point needs t, x, y and z", kNames[k]));
  }
  return entries;
}

std::array<AxisSource, 3> read_axes(const Node& section, const std::optional<Node>& mirror) {
  section.expect({"x", "y", "z"});
  constexpr const char* kNames[] = {"x", "y", "z"};
  std::array<AxisSource, 3> axes{};
  std::array<bool, 3> used{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Node node = section.at(kNames[k], "the file's axis that it is, e.g. -z");
    std::string_view text = node.text();
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    if (text.size() != 1 || text[0] < 'x' || text[0] > 'z')
      node.fail(fmt::format("is '{}'; write one of x, y, z, -x, -y, -z", node.text()));
    axes[k] = {static_cast<std::size_t>(text[0] - 'x'), negative ? -1.0 : 1.0};
    if (used[axes[k].axis]) node.fail(fmt::format("takes the file's {} a second time; each axis is needed once", text));
    used[axes[k].axis] = true;
  }
  const bool odd = (axes[0].axis + 1) % 3 != axes[1].axis;
  const bool mirrors = (odd ? -1 : 1) * axes[0].sign * axes[1].sign * axes[2].sign < 0;
  const bool wanted = mirror && config::read_flag(*mirror);
  if (mirrors && !wanted) {
    section.fail(
        "turns a right-handed frame into a left-handed one, so the mill would turn the other way; change a sign, or say 'mirror: true' "
        "when the file's own frame is left-handed");
  }
  if (!mirrors && wanted) mirror->fail("is true, but 'axes' mirrors nothing; change a sign, or leave 'mirror' out");
  return axes;
}

MillFrame read_frame(const Node& section) {
  section.expect({"axis", "ends"});
  // [x, y] with a unit each, or bare numbers with one unit behind them: [x, y, mm].
  const auto pair = [](const Node& node, const char* example) {
    const auto items = node.items();
    const bool unit_behind = items.size() == 3 && !config::read_quantity(items[0]).has_unit && !config::read_quantity(items[1]).has_unit;
    if (items.size() != 2 && !unit_behind) node.fail(fmt::format("wants two lengths, e.g. {}", example));
    std::array<double, 2> values{config::read_number(items[0], "m"), config::read_number(items[1], "m")};
    if (!unit_behind) return values;
    try {
      const ColumnUnit unit = column_unit(kX, items[2].text());
      for (double& value : values) value = value * unit.multiplier / unit.divisor;
    } catch (const std::invalid_argument& error) {
      items[2].fail(fmt::format("is '{}': {}", items[2].text(), error.what()));
    }
    return values;
  };
  MillFrame frame;
  frame.axis = pair(section.at("axis", "x and y of the mill's axis, e.g. [-2 mm, 13 mm]"), "[-2 mm, 13 mm]");
  if (const auto ends = section.find("ends")) {
    const auto [low, high] = pair(*ends, "[0 mm, 200 mm]");
    if (!(high > low)) ends->fail("must rise; the first is the end face at the smaller z");
    frame.low = low;
    frame.high = high;
  }
  return frame;
}

char read_separator(const Node& node) {
  const std::string name = config::read_choice(node, "comma|semicolon|tab|blank");
  return name == "comma" ? ',' : name == "semicolon" ? ';' : name == "tab" ? '\t' : ' ';
}

Format read_format(const Node& node) {
  const std::string name = config::read_choice(node, "auto|ctrack|table|tracks");
  return name == "ctrack" ? Format::ctrack : name == "table" ? Format::table : name == "tracks" ? Format::tracks : Format::automatic;
}

}  // namespace

config::Range gap_limit_range() {
  config::Range range = config::positive("a spline across a longer pause is a guess: give e.g. 50 ms");
  range.high = 1;
  return range;
}

Description read_description(const fs::path& file) {
  const Node root = config::load_document(file.string());
  root.expect(
      {"files", "format", "columns", "separator", "skip_lines", "axes", "mirror", "condition", "frame", "gap_limit", "encoder", "labels"});
  Description description;
  const Node files = root.at("files", "the files of points, e.g. [run1.a, run2.a]");
  if (files.is_sequence()) {
    for (const Node& one : files.items()) add_files(one, description.files);
  } else {
    add_files(files, description.files);
  }
  if (description.files.empty()) files.fail("is an empty list; name at least one file of points");
  if (const auto node = root.find("format")) description.format = read_format(*node);
  if (const auto node = root.find("columns")) {
    description.columns = read_columns(*node);
    description.columns_place = node->where();
  }
  if (const auto node = root.find("separator")) {
    description.separator = read_separator(*node);
    description.separator_place = node->where();
  }
  if (const auto node = root.find("skip_lines")) {
    description.skip_lines = config::read_integer(*node, config::between(0, 1e6));
    description.skip_lines_place = node->where();
  }
  if (const auto node = root.find("labels")) {
    for (const Node& one : node->items()) description.labels.push_back(one.text());
    if (description.labels.empty()) node->fail("is an empty list; name the tracers that are wanted, or leave it out for all");
    description.labels_place = node->where();
  }
  const auto mirror = root.find("mirror");
  if (const auto node = root.find("axes")) {
    description.axes = read_axes(*node, mirror);
  } else if (mirror && config::read_flag(*mirror)) {
    mirror->fail("is true without 'axes'; say which axis is turned, e.g. axes: {x: -x, y: y, z: z}");
  }
  if (const auto node = root.find("condition")) description.condition = read_condition(*node);
  if (const auto node = root.find("frame")) description.frame = read_frame(*node);
  if (description.condition.slice && description.frame && description.frame->high > description.frame->low)
    root.at("condition").at("slice").fail("repeats along z, and so has no ends, but 'frame' gives some; leave one of them out");
  if (const auto node = root.find("gap_limit")) description.gap_limit = config::read_number(*node, "s", gap_limit_range());
  if (const auto node = root.find("encoder")) config::read_choice(*node, "none");
  root.finish();
  return description;
}

}  // namespace millscope::recording
