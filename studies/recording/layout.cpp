#include "studies/recording/layout.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/recording/heads.hpp"

namespace millscope::recording {
namespace {

using base::UserError;

/// The tracker's nine lines, or eight columns of which the sixth and seventh are 0.
bool looks_like_ctrack(const Top& top) {
  const bool headed = std::any_of(top.head.begin(), top.head.end(), [](std::string_view line) {
    return line.starts_with("Separation=") || line.find("events/slice") != std::string_view::npos;
  });
  if (headed) return true;
  const Words words = split(top.row, ' ');
  const auto zero = [](std::string_view word) { return word.find_first_not_of("0.") == std::string_view::npos; };
  return top.separator == ' ' && words.size() == 8 && zero(words[5]) && zero(words[6]);
}

/// What a file without any word about it is taken for: four or five columns.
std::vector<ColumnEntry> usual_entries(const Top& top, const std::filesystem::path& file) {
  const std::size_t columns = split(top.row, top.separator).size();
  if (columns != 4 && columns != 5) {
    throw UserError(
        base::Location{file.string(), static_cast<int>(top.row_line)},
        fmt::format("has {} columns and no line that names them; say what they are in a recording.yaml, e.g. files: [{}] and columns: "
                    "{{t: ms, x: mm, y: mm, z: mm, error: mm}}",
                    columns, file.filename().string()));
  }
  std::vector<ColumnEntry> entries;
  for (const Quantity quantity : {kTime, kX, kY, kZ, kError}) {
    if (entries.size() < columns) entries.push_back(entry_of(static_cast<int>(entries.size()), quantity, ""));
  }
  return entries;
}

/// Finds the columns that are named by their heads.
void place(std::vector<ColumnEntry>& entries, const Top& top, const base::Location& where, const std::filesystem::path& file) {
  const Words heads = heads_of(top).words;
  for (ColumnEntry& entry : entries) {
    if (entry.header.empty()) continue;
    const auto found = std::find(heads.begin(), heads.end(), entry.header);
    if (found == heads.end()) {
      const std::string list = listed(heads);
      throw UserError(where,
                      fmt::format("'columns' names '{}', which is not above a column of {}; {}", entry.header, file.filename().string(),
                                  list.empty() ? "the file names none: give numbers from 1" : "there are " + list));
    }
    entry.number = static_cast<int>(found - heads.begin());
  }
}

void set(KnownLayout& known, const ColumnEntry& entry) {
  if (!entry.quantity) return;
  const Quantity k = *entry.quantity;
  known.layout.column[k] = entry.number;
  known.layout.multiplier[k] = entry.unit.multiplier;
  known.layout.divisor[k] = entry.unit.divisor;
}

/// In the order of the columns: "t ms, x mm, skip, y mm".
void describe(KnownLayout& known, const std::string& kind, const std::vector<ColumnEntry>& entries) {
  constexpr const char* kNames[] = {"t", "x", "y", "z", "error", "n"};
  std::vector<ColumnEntry> sorted;
  for (const ColumnEntry& entry : entries) {
    if (entry.quantity) sorted.push_back(entry);
  }
  std::sort(sorted.begin(), sorted.end(), [](const ColumnEntry& a, const ColumnEntry& b) { return a.number < b.number; });
  const char separator = known.layout.separator;
  known.words = fmt::format("{}, {}:", kind,
                            separator == ','    ? "comma"
                            : separator == ';'  ? "semicolon"
                            : separator == '\t' ? "tab"
                                                : "blanks");
  for (const ColumnEntry& entry : sorted) {
    known.words += fmt::format(" {} {} (column {}),", kNames[*entry.quantity], entry.unit.text, *entry.number + 1);
    if (*entry.quantity == kTime) known.time_unit = entry.unit.text;
    if (*entry.quantity == kX) known.length_unit = entry.unit.text;
  }
  known.words.pop_back();
  if (known.layout.decimal == ',') known.words += ", decimal commas";
}

KnownLayout ctrack(const Description& description) {
  constexpr const char* kRemedy = "is of no use for a ctrack file, whose layout is fixed; leave it out, or say 'format: table'";
  if (description.separator) throw UserError(description.separator_place, fmt::format("'separator' {}", kRemedy));
  if (description.skip_lines > 0) throw UserError(description.skip_lines_place, fmt::format("'skip_lines' {}", kRemedy));
  for (const ColumnEntry& said : description.columns.value_or(std::vector<ColumnEntry>{})) {
    if (!said.placed && said.quantity) continue;
    throw UserError(description.columns_place,
                    "'columns' says places, but those of a ctrack file are fixed; give the units alone, e.g. {t: ms, x: mm, y: mm, z: mm}, "
                    "or say 'format: table'");
  }
  KnownLayout known{ctrack_layout(), "", "ms", "mm"};
  constexpr std::pair<Quantity, int> kColumns[] = {{kTime, 0}, {kX, 1}, {kY, 2}, {kZ, 3}, {kError, 4}, {kEvents, 7}};
  std::vector<ColumnEntry> entries;
  for (const auto& [quantity, column] : kColumns) entries.push_back(entry_of(column, quantity, ""));
  for (ColumnEntry& entry : entries) {  // the columns are where they are; the units may be said
    for (const ColumnEntry& said : description.columns.value_or(std::vector<ColumnEntry>{})) {
      if (said.quantity == entry.quantity) entry.unit = said.unit;
    }
    set(known, entry);
  }
  describe(known, "ctrack", entries);
  return known;
}

}  // namespace

KnownLayout layout_of(std::string_view text, const std::filesystem::path& file, const Description& description) {
  const Top top = top_of(text, description);
  const bool automatic = description.format == Format::automatic && !description.columns;
  if (description.format == Format::ctrack || (automatic && looks_like_ctrack(top))) return ctrack(description);
  if (top.row_line == 0) {
    throw UserError(fmt::format("{}: holds no usable point: none of its first lines has four numbers", file.string()));
  }
  KnownLayout known;
  known.layout.separator = top.separator;
  known.layout.decimal = top.decimal;
  known.layout.skip_lines = description.skip_lines;
  std::vector<ColumnEntry> entries;
  std::string kind = "table";
  if (description.columns) {
    entries = *description.columns;
    place(entries, top, description.columns_place, file);
    for (const ColumnEntry& entry : entries) {
      if (entry.label) known.layout.label = entry.number;
    }
  } else {
    entries = entries_of_heads(top, file);
    known.layout.label = label_of_heads(top);
    if (entries.empty()) {
      entries = usual_entries(top, file);
      kind = "table without heads, in the usual order";
    }
  }
  for (const ColumnEntry& entry : entries) set(known, entry);
  describe(known, kind, entries);
  return known;
}

}  // namespace millscope::recording
