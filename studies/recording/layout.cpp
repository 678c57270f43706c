#include "studies/recording/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace millscope::studies {
namespace {

using config::UserError;
using Words = std::vector<std::string_view>;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\"");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

Words split(std::string_view line, char separator) {
  Words words;
  line = trimmed(line);
  if (line.empty()) return words;
  if (separator != ' ') {
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(separator, begin), line.size());
      words.push_back(trimmed(line.substr(begin, end - begin)));
      begin = end + 1;
    }
    return words;
  }
  for (std::size_t begin = 0; begin != std::string_view::npos && begin < line.size();) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(" \t\r", end);
  }
  return words;
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with('!') || line.starts_with("//");
}

bool begins_with_number(std::string_view line) {
  const std::size_t first = line.find_first_not_of("+-.");
  return first != std::string_view::npos && first < 3 && line[first] >= '0' && line[first] <= '9';
}

/// A row has four numbers or more; a title or a remark may have some.
bool is_row(std::string_view line) {
  int numbers = 0;
  for (std::size_t begin = 0; begin != std::string_view::npos && begin < line.size();) {
    const std::size_t end = std::min(line.find_first_of(" \t,;", begin), line.size());
    const std::string_view word = trimmed(line.substr(begin, end - begin));
    numbers += begins_with_number(word) || word == "nan" || word == "NaN" || word == "NAN" || word == "inf" || word == "-inf";
    begin = line.find_first_not_of(" \t,;", end);
  }
  return numbers >= 4;
}

/// The first lines of a file: up to the first row, and that row.
struct Top {
  std::vector<std::string_view> head;  ///< trimmed, comment marks too
  std::string_view row;
  std::size_t row_line = 0;  ///< from 1; 0: no row
  char separator = ' ';
};

Top top_of(std::string_view text, const Description& description) {
  constexpr std::size_t kLongestHead = 1000;
  Top top;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size() && number < kLongestHead;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (++number <= description.skip_lines || line.empty() || is_comment(line) || !is_row(line)) {
      top.head.push_back(line);
      continue;
    }
    top.row = line;
    top.row_line = number;
    break;
  }
  const auto has = [&](char c) { return top.row.find(c) != std::string_view::npos; };
  top.separator = description.separator.value_or(has(';') ? ';' : has(',') ? ',' : ' ');
  return top;
}

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

/// "x_mm", "x (mm)", "x [mm]", "x/mm" → "x" and "mm".
std::pair<std::string, std::string> name_and_unit(std::string_view head) {
  const std::size_t mark = head.find_first_of("([/_");
  std::string name(trimmed(head.substr(0, mark)));
  if (mark == std::string_view::npos) return {name, ""};
  std::string_view unit = trimmed(head.substr(mark + 1));
  if (!unit.empty() && (unit.back() == ')' || unit.back() == ']')) unit.remove_suffix(1);
  return {name, std::string(trimmed(unit))};
}

/// The line of column heads above the first row: as many words as the row has columns, none of them a number.
Words heads_of(const Top& top) {
  const std::size_t columns = split(top.row, top.separator).size();
  for (auto line = top.head.rbegin(); line != top.head.rend(); ++line) {
    std::string_view text = *line;
    while (!text.empty() && std::string_view("#%!/").find(text.front()) != std::string_view::npos) text.remove_prefix(1);
    for (const char separator : {top.separator, ' '}) {
      const Words words = split(text, separator);
      const bool all_words =
          std::none_of(words.begin(), words.end(), [](std::string_view word) { return word.empty() || begins_with_number(word); });
      if (words.size() == columns && all_words) return words;
    }
  }
  return {};
}

ColumnEntry entry_of(int number, Quantity quantity, const std::string& unit) {
  ColumnEntry entry;
  entry.quantity = quantity;
  entry.number = number;
  entry.unit = column_unit(quantity, unit.empty() ? usual_unit(quantity) : unit);
  return entry;
}

/// From the heads; nothing where they do not name t, x, y and z once each.
std::vector<ColumnEntry> entries_of_heads(const Words& heads) {
  std::vector<ColumnEntry> entries;
  std::array<int, kQuantities> found{};
  for (std::size_t k = 0; k < heads.size(); ++k) {
    const auto [name, unit] = name_and_unit(heads[k]);
    const auto quantity = quantity_of(name);
    if (!quantity || found[*quantity] > 0) continue;
    try {
      entries.push_back(entry_of(static_cast<int>(k), *quantity, unit));
    } catch (const std::invalid_argument&) {
      continue;  // no unit: part of another name, e.g. e_total
    }
    ++found[*quantity];
  }
  const bool complete = std::all_of(found.begin(), found.begin() + 4, [](int count) { return count == 1; });
  return complete ? entries : std::vector<ColumnEntry>{};
}

/// What a file without any word about it is taken for: four or five columns.
std::vector<ColumnEntry> usual_entries(const Top& top, const std::filesystem::path& file) {
  const std::size_t columns = split(top.row, top.separator).size();
  if (columns != 4 && columns != 5) {
    throw UserError(
        config::Location{file.string(), static_cast<int>(top.row_line)},
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
void place(std::vector<ColumnEntry>& entries, const Top& top, const config::Location& where, const std::filesystem::path& file) {
  const Words heads = heads_of(top);
  for (ColumnEntry& entry : entries) {
    if (entry.header.empty()) continue;
    const auto found = std::find(heads.begin(), heads.end(), entry.header);
    if (found == heads.end()) {
      std::string list;
      for (const auto head : heads) list += fmt::format("{}'{}'", list.empty() ? "" : ", ", head);
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
void describe(KnownLayout& known, const char* kind, const std::vector<ColumnEntry>& entries) {
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
    known.words += fmt::format(" {} {} (column {}),", kNames[*entry.quantity], entry.unit.text, entry.number + 1);
    if (*entry.quantity == kTime) known.time_unit = entry.unit.text;
    if (*entry.quantity == kX) known.length_unit = entry.unit.text;
  }
  known.words.pop_back();
}

KnownLayout ctrack(const Description& description) {
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
  known.layout.skip_lines = description.skip_lines;
  std::vector<ColumnEntry> entries;
  if (description.columns) {
    entries = *description.columns;
    place(entries, top, description.columns_place, file);
  } else {
    entries = entries_of_heads(heads_of(top));
    if (entries.empty()) entries = usual_entries(top, file);
  }
  for (const ColumnEntry& entry : entries) set(known, entry);
  describe(known, "table", entries);
  return known;
}

}  // namespace millscope::studies
