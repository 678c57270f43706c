#include "studies/doe/recognise.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "kernel/base/error.hpp"
#include "studies/doe/coding.hpp"
#include "studies/doe/words.hpp"

namespace millscope::doe {
namespace {

using base::UserError;
using Index = Eigen::Index;

constexpr std::array<const char*, 8> kLabels{"case", "run", "id", "trial", "number", "no", "label", "name"};
constexpr std::size_t kMostLevels = 5;

std::string lower(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

bool is_label(const base::Table& table, std::size_t column) {
  const std::string name = lower(table.names()[column]);
  return column == 0 && std::any_of(kLabels.begin(), kLabels.end(), [&](const char* label) { return name == label; });
}

bool varies(const base::Column& column) {
  return std::any_of(column.value.begin(), column.value.end(), [&](double v) { return v != column.value[0]; });
}

/// Few levels that repeat, even about their middle: planned rather than measured.
bool looks_planned(const base::Column& column) {
  const std::set<double> levels(column.value.begin(), column.value.end());
  if (levels.size() < 2 || levels.size() > kMostLevels || levels.size() + 2 > column.value.size()) return false;
  const double twice_middle = *levels.begin() + *levels.rbegin();
  auto high = levels.rbegin();
  for (const double low : levels) {
    if (std::abs(low + *high++ - twice_middle) > 4 * column.half_digit) return false;
  }
  return true;
}

struct Columns {
  std::vector<std::string> factors, responses, aside;
};

/// What is neither text nor the label, in the order of the table.
std::vector<std::string> candidates(const base::Table& table, std::vector<std::string>& aside) {
  std::vector<std::string> names;
  for (std::size_t c = 0; c < table.names().size(); ++c) {
    if (is_label(table, c)) continue;
    if (table.has_number(c)) {
      names.push_back(table.names()[c]);
    } else {
      aside.push_back(table.names()[c] + " (text)");
    }
  }
  return names;
}

void guess_factors(const base::Table& table, const std::vector<std::string>& names, Columns& columns) {
  for (const std::string& name : names) {
    if (!looks_planned(table.numbers(table.index_of(name)))) break;
    columns.factors.push_back(name);
  }
  if (!columns.factors.empty() && columns.factors.size() < names.size()) return;
  throw UserError(fmt::format("{}: which columns are factors cannot be told from their levels; name them, e.g. --factors {},…",
                              table.file(), names.empty() ? "speed" : names.front()));
}

Columns choose_columns(const base::Table& table, const Choice& choice) {
  Columns columns{choice.factors, choice.responses, {}};
  for (const auto* list : {&choice.factors, &choice.responses}) {
    for (const std::string& name : *list) table.index_of(name);
  }
  for (const std::string& name : choice.factors) {
    if (std::count(choice.factors.begin(), choice.factors.end(), name) > 1)
      throw UserError(fmt::format("--factors: '{}' stands twice", name));
    if (contains(choice.responses, name)) throw UserError(fmt::format("'{}' is named as factor and as response; it can be one", name));
  }
  const std::vector<std::string> names = candidates(table, columns.aside);
  if (columns.factors.empty() && columns.responses.empty()) guess_factors(table, names, columns);
  for (const std::string& name : names) {
    if (contains(columns.factors, name) || contains(columns.responses, name)) continue;
    if (choice.responses.empty()) {
      if (varies(table.numbers(table.index_of(name)))) {
        columns.responses.push_back(name);
      } else {
        columns.aside.push_back(name + " (one value in all runs)");
      }
    } else if (choice.factors.empty()) {
      columns.factors.push_back(name);
    } else {
      columns.aside.push_back(name);
    }
  }
  if (columns.factors.empty() || columns.responses.empty()) {
    throw UserError(fmt::format("{}: no column is left for {}; name columns by --factors and --responses", table.file(),
                                columns.factors.empty() ? "factors" : "responses"));
  }
  return columns;
}

std::vector<FactorColumn> factor_columns(const base::Table& table, const std::vector<std::string>& names) {
  std::vector<FactorColumn> columns;
  for (const std::string& name : names) {
    columns.push_back({name, table.numbers(table.index_of(name))});
    if (!varies(columns.back().column))
      throw UserError(fmt::format("{}: factor {} has one value in all runs; leave it out or vary it", table.file(), name));
  }
  return columns;
}

Coded code(const std::vector<FactorColumn>& columns, const std::string& axial) {
  auto two_level = code_two_level(columns);
  if (two_level && axial == "auto") return std::move(*two_level);
  if (auto composite = two_level ? std::nullopt : code_composite(columns, axial)) return std::move(*composite);
  if (axial != "auto") throw UserError("--axial: this table is no central composite plan; leave the option out");
  return code_range(columns);
}

Eigen::MatrixXd corner_runs(const Design& design) {
  Eigen::MatrixXd corners(design.coded.rows(), design.coded.cols());
  Index count = 0;
  for (Index run = 0; run < design.coded.rows(); ++run) {
    if (design.kind[run] == "factorial") corners.row(count++) = design.coded.row(run);
  }
  return corners.topRows(count);
}

void check_generators(const base::Table& table, const RecognisedTable& found, const std::vector<std::string>& texts) {
  if (texts.empty()) return;
  const Design& design = found.design;
  const auto generators = parse_generators(texts, design.factors);
  for (Index run = 0; run < design.coded.rows(); ++run) {
    if (design.kind[run] != "factorial") continue;
    for (std::size_t g = 0; g < generators.size(); ++g) {
      double product = generators[g].of.negative ? -1 : 1;
      for (const int i : members(generators[g].of)) product *= design.coded(run, i);
      if (product == design.coded(run, generators[g].made)) continue;
      throw UserError(
          fmt::format("{}: this run does not obey the generator '{}'; correct the generator or the level", table.place(run), texts[g]));
    }
  }
}

/// Resolution, aliases and the words that hold, from the runs at the corners.
void find_structure(RecognisedTable& found) {
  const Eigen::MatrixXd corners = corner_runs(found.design);
  if (corners.rows() == 0) return;
  const std::vector<Word> words = constant_words(corners);
  if (words.size() > 16) return;
  const std::vector<Word> relation = closure(words);
  found.design.resolution = is_regular(corners, static_cast<int>(words.size())) ? resolution_of(relation) : "irregular";
  for (const auto& chain : chains(static_cast<int>(found.design.factors.size()), relation)) {
    if (chain.size() > 1) found.design.aliases.push_back(text_of(chain, found.design.factors));
  }
  for (const Word& word : words)
    found.generators.push_back(fmt::format("{} = {}", text_of({word.factors, false}, found.design.factors), word.negative ? "-1" : "+1"));
}

std::string describe(const RecognisedTable& found) {
  std::map<std::string, int> count;
  for (const std::string& kind : found.design.kind) ++count[kind];
  const auto runs = [&count](const char* kind) {
    return count[kind] > 0 ? fmt::format(", {} {} run{}", count[kind], kind, count[kind] > 1 ? "s" : "") : std::string();
  };
  const std::string corners = runs("factorial") + runs("axial") + runs("centre");
  switch (found.kind) {
    case PlanKind::two_level: {
      const std::string& r = found.design.resolution;
      return "two-level plan" + corners +
             (r == "full"        ? ", full factorial"
              : r == "irregular" ? ", no regular fraction"
                                 : ", resolution " + r);
    }
    case PlanKind::central_composite:
      return "central composite plan" + corners;
    case PlanKind::other:
      break;
  }
  return fmt::format("plan of {} runs without a named pattern; coded -1 to +1 over the range of the runs", found.design.kind.size());
}

void note_copies(const base::Table& table, RecognisedTable& found) {
  std::map<std::vector<double>, std::size_t> seen;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::vector<double> key;
    for (Index i = 0; i < found.design.coded.cols(); ++i) key.push_back(found.design.coded(static_cast<Index>(row), i));
    for (const Eigen::VectorXd& response : found.values) key.push_back(response[static_cast<Index>(row)]);
    const auto [first, fresh] = seen.insert({key, row});
    if (fresh) continue;
    found.notes.push_back(fmt::format("run {} equals run {} in every factor and response: copied, or repeated with the same seed?",
                                      found.labels[row], found.labels[first->second]));
  }
}

}  // namespace

RecognisedTable recognise(const base::Table& table, const Choice& choice) {
  const Columns columns = choose_columns(table, choice);
  Coded coded = code(factor_columns(table, columns.factors), choice.axial);
  RecognisedTable found;
  found.design = std::move(coded.design);
  found.kind = coded.kind;
  found.notes = std::move(coded.notes);
  for (std::size_t row = 0; row < table.rows(); ++row)
    found.labels.push_back(is_label(table, 0) ? table.cell(row, 0) : std::to_string(row + 1));
  check_generators(table, found, choice.generators);
  find_structure(found);
  found.description = describe(found);
  for (const std::string& name : columns.responses) {
    const base::Column column = table.numbers(table.index_of(name));
    found.responses.push_back(name);
    found.values.emplace_back(Eigen::Map<const Eigen::VectorXd>(column.value.data(), static_cast<Index>(column.value.size())));
  }
  if (!columns.aside.empty()) found.notes.push_back(fmt::format("columns left aside: {}", fmt::join(columns.aside, ", ")));
  note_copies(table, found);
  return found;
}

}  // namespace millscope::doe
