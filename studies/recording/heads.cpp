#include "studies/recording/heads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <stdexcept>

namespace millscope::recording {
namespace {

using base::UserError;

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

std::string_view without_brackets(std::string_view unit) {
  unit = trimmed(unit);
  if (!unit.empty() && (unit.front() == '(' || unit.front() == '[' || unit.front() == '/')) unit.remove_prefix(1);
  if (!unit.empty() && (unit.back() == ')' || unit.back() == ']')) unit.remove_suffix(1);
  return trimmed(unit);
}

/// "x_mm", "x (mm)", "x [mm]", "x/mm", "x mm", "TimeStamp". Nothing where it names no quantity, or no unit that this one can have.
std::optional<ColumnEntry> entry_of_head(int number, std::string_view head) {
  if (const auto whole = quantity_of(head)) return entry_of(number, *whole, "");
  const std::size_t bracket = head.find_first_of("([/"), mark = bracket != std::string_view::npos ? bracket : head.find_last_of(" _");
  if (mark == std::string_view::npos) return std::nullopt;
  const auto quantity = quantity_of(trimmed(head.substr(0, mark)));
  if (!quantity) return std::nullopt;
  try {
    return entry_of(number, *quantity, std::string(without_brackets(head.substr(mark + (bracket == std::string_view::npos)))));
  } catch (const std::invalid_argument&) {
    return std::nullopt;  // no unit: part of another name, e.g. e_total
  }
}

/// What a line of heads names; of two spreads or counts the first.
struct Named {
  std::vector<ColumnEntry> entries;
  bool complete = false;  ///< t, x, y and z once each
};

Named named_by(const Words& heads) {
  Named named;
  std::array<int, kQuantities> found{};
  for (std::size_t k = 0; k < heads.size(); ++k) {
    const auto entry = entry_of_head(static_cast<int>(k), heads[k]);
    if (!entry || (++found[*entry->quantity] > 1 && *entry->quantity >= kError)) continue;
    named.entries.push_back(*entry);
  }
  named.complete = std::all_of(found.begin(), found.begin() + 4, [](int count) { return count == 1; });
  return named;
}

/// A unit behind a blank belongs to the word before it: "time (ms) x (mm)".
Words join_units(const Words& words) {
  Words joined;
  for (const std::string_view word : words) {
    const bool unit = !joined.empty() && (word.front() == '(' || word.front() == '[');
    if (unit) joined.back() = {joined.back().data(), static_cast<std::size_t>(word.data() + word.size() - joined.back().data())};
    if (!unit) joined.push_back(word);
  }
  return joined;
}

/// Lines above the first row that have words and no numbers, as often as there are ways to split them; the nearest first. Heads may be
/// empty: a column without a name.
std::vector<HeadLine> head_lines(const Top& top) {
  std::vector<HeadLine> lines;
  for (std::size_t k = top.head.size(); k-- > 0;) {
    std::string_view text = top.head[k];
    while (!text.empty() && std::string_view("#%!/").find(text.front()) != std::string_view::npos) text.remove_prefix(1);
    Words ways[] = {split(text, top.separator), split(text, ' '), {}};
    ways[2] = join_units(ways[1]);
    for (const Words& words : ways) {
      const bool named = std::any_of(words.begin(), words.end(), [](std::string_view word) { return !word.empty(); });
      if (named && std::none_of(words.begin(), words.end(), begins_with_number)) lines.push_back({k + 1, words});
    }
  }
  return lines;
}

[[noreturn]] void fail_heads(const HeadLine& line, const std::string& why, const std::filesystem::path& file) {
  throw UserError(base::Location{file.string(), static_cast<int>(line.line)},
                  fmt::format("has the heads {}, {}; say what the columns are in a recording.yaml, e.g. files: [{}] and columns: "
                              "{{t: {{column: 1, unit: ms}}, x: {{column: 2, unit: mm}}, …}}",
                              listed(line.words), why, file.filename().string()));
}

/// A line of units below the heads: "ms mm mm mm".
void read_units(const Top& top, const HeadLine& heads, std::vector<ColumnEntry>& entries) {
  for (const HeadLine& line : head_lines(top)) {
    if (line.line <= heads.line || line.words.size() != heads.words.size()) continue;
    std::vector<ColumnEntry> with_units = entries;
    try {
      for (ColumnEntry& entry : with_units) {
        entry.unit = column_unit(*entry.quantity, without_brackets(line.words[*entry.number]));
      }
      entries = with_units;
      return;
    } catch (const std::invalid_argument&) {
      continue;  // other words
    }
  }
}

/// "12,3": one comma between digits. A table of integers apart by commas has more of them in a word, or blanks behind them.
bool has_decimal_comma(std::string_view word) {
  if (word.find_first_not_of("+-0123456789,eEdD") != std::string_view::npos) return false;
  const std::size_t comma = word.find(',');
  const auto digit = [&](std::size_t at) { return at < word.size() && word[at] >= '0' && word[at] <= '9'; };
  return comma != std::string_view::npos && comma > 0 && digit(comma - 1) && digit(comma + 1) && word.find(',', comma + 1) == word.npos;
}

/// "12.3", but no date.
bool has_decimal_point(std::string_view word) {
  const std::size_t point = word.find('.');
  return begins_with_number(word) && point != word.npos && word.find('.', point + 1) == word.npos &&
         word.find_first_not_of("+-.0123456789eEdD") == word.npos;
}

/// Numbers apart by blanks, some with a decimal comma: "3,628 139,146 -1,857 29".
bool is_row_with_decimal_commas(std::string_view line) {
  const Words words = split(line, ' ');
  const auto number = [](std::string_view word) {
    return begins_with_number(word) && word.find_first_not_of("+-0123456789eEdD") == word.npos;
  };
  return words.size() >= 4 && std::any_of(words.begin(), words.end(), has_decimal_comma) &&
         std::all_of(words.begin(), words.end(), [&](std::string_view word) { return has_decimal_comma(word) || number(word); });
}

/// A comma, where the first rows have some within numbers and no points. One comma among points is no decimal one: 1,250 may be 1250.
char decimal_of(std::string_view rows, char separator) {
  constexpr std::size_t kRows = 200;
  if (separator == ',') return '.';
  bool commas = false;
  for (std::size_t begin = 0, row = 0; begin < rows.size() && row < kRows; ++row) {
    const std::size_t end = std::min(rows.find('\n', begin), rows.size());
    for (const std::string_view word : split(rows.substr(begin, end - begin), separator)) {
      if (has_decimal_point(word)) return '.';
      commas = commas || has_decimal_comma(word);
    }
    begin = end + 1;
  }
  return commas ? ',' : '.';
}

bool is_label(std::string_view head) {
  constexpr std::string_view kNames[] = {"label",  "labels",   "tracer",     "tracerid", "bead",
                                         "beadid", "particle", "particleid", "track",    "trackid"};
  std::string word;
  for (const char c : head) {
    if (c != ' ' && c != '_' && c != '-') word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return std::find(std::begin(kNames), std::end(kNames), word) != std::end(kNames);
}

}  // namespace

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

Top top_of(std::string_view text, const Description& description) {
  constexpr std::size_t kLongestHead = 1000;
  Top top;
  std::size_t number = 0;
  std::string_view rows;
  for (std::size_t begin = 0; begin < text.size() && number < kLongestHead;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(text.substr(begin, end - begin));
    rows = text.substr(begin);
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
  const bool comma = has(',') && !is_row_with_decimal_commas(top.row);
  top.separator = description.separator.value_or(has(';') ? ';' : comma ? ',' : ' ');
  top.decimal = decimal_of(rows, top.separator);
  return top;
}

ColumnEntry entry_of(int number, Quantity quantity, const std::string& unit) {
  ColumnEntry entry;
  entry.quantity = quantity;
  entry.number = number;
  entry.unit = column_unit(quantity, unit.empty() ? usual_unit(quantity) : unit);
  return entry;
}

HeadLine heads_of(const Top& top) {
  const std::size_t columns = split(top.row, top.separator).size();
  HeadLine nearest;
  for (const HeadLine& line : head_lines(top)) {
    if (line.words.size() != columns) continue;
    if (named_by(line.words).complete) return line;
    if (nearest.words.empty()) nearest = line;
  }
  return nearest;
}

std::string listed(const Words& words) {
  std::string list;
  for (const auto word : words) list += fmt::format("{}'{}'", list.empty() ? "" : ", ", word);
  return list;
}

std::vector<ColumnEntry> entries_of_heads(const Top& top, const std::filesystem::path& file) {
  const HeadLine heads = heads_of(top);
  if (!heads.words.empty()) {
    Named named = named_by(heads.words);
    if (!named.complete) fail_heads(heads, "which do not name t, x, y and z once each", file);
    read_units(top, heads, named.entries);
    return named.entries;
  }
  const std::size_t columns = split(top.row, top.separator).size();
  for (const HeadLine& line : head_lines(top)) {
    const Named named = named_by(line.words);
    if (!named.complete) continue;
    bool usual = named.entries.size() == columns;
    for (std::size_t k = 0; k < named.entries.size(); ++k) usual = usual && named.entries[k].quantity == static_cast<Quantity>(k);
    if (!usual) fail_heads(line, fmt::format("but the first row has {} columns", columns), file);
  }
  return {};
}

std::optional<int> label_of_heads(const Top& top) {
  const Words heads = heads_of(top).words;
  const auto found = std::find_if(heads.begin(), heads.end(), is_label);
  return found == heads.end() ? std::nullopt : std::optional<int>(static_cast<int>(found - heads.begin()));
}

}  // namespace millscope::recording
