#include "studies/analysis/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/config/units.hpp"
#include "kernel/output/csv.hpp"
#include "kernel/output/file.hpp"
#include "studies/analysis/results_file.hpp"

namespace millscope::analysis {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using output::csv_cell;

/// What an analyzer says of a result, in words.
std::vector<std::string> trait_names(std::uint32_t traits) {
  constexpr std::pair<std::uint32_t, const char*> kNames[] = {
      {kBookkeeping, "bookkeeping"}, {kOdd, "odd"},     {kFirstOdd, "first odd"},       {kAlongX, "along x"},
      {kCumulative, "cumulative"},   {kShare, "share"}, {kNotNegative, "not negative"}, {kSpread, "spread"}};
  std::vector<std::string> names;
  for (const auto& [bit, name] : kNames) {
    if ((traits & bit) != 0) names.emplace_back(name);
  }
  return names;
}

std::string number(double value) { return std::isfinite(value) ? config::number_text(value) : ""; }

bool is_number(const ResultArray& a) { return a.shape.empty() && !a.is_axis; }

void write_numbers(const fs::path& file, const ResultSet& results) {
  output::AtomicFile out(file);
  out.write("analyzer,name,unit,value,sem,low_90,high_90,effective_blocks,doubts,meaning\n");
  for (const ResultArray& a : results.arrays) {
    if (!is_number(a)) continue;
    out.write(fmt::format("{},{},{},{},{},{},{},{},{},{}\n", a.analyzer, a.name, csv_cell(a.unit), number(a.value[0]), number(a.sem[0]),
                          number(a.low[0]), number(a.high[0]), number(a.effective_blocks[0]), csv_cell(flag_text(a.flags[0])),
                          csv_cell(a.doc)));
  }
  out.commit();
}

/// Results of one analyzer over the same cells.
struct Table {
  std::string name;
  std::vector<const ResultArray*> columns;
};

std::string table_name(const ResultArray& a) {
  std::string name = a.analyzer;
  for (std::size_t d = 0; d < a.shape.size(); ++d) name += "." + (a.axes[d].empty() ? fmt::format("{}", a.shape[d]) : a.axes[d]);
  return name;
}

/// What lies between the edges of an axis and what lies on them has the same axis, but other cells: the second table is called after its
/// first result, too.
std::vector<Table> tables_of(const ResultSet& results) {
  std::vector<Table> tables;
  for (const ResultArray& a : results.arrays) {
    if (a.is_axis || a.shape.empty() || a.size() == 0) continue;
    const std::string name = table_name(a);
    const auto alike = [&](const Table& t) { return table_name(*t.columns.front()) == name && t.columns.front()->shape == a.shape; };
    auto table = std::find_if(tables.begin(), tables.end(), alike);
    if (table == tables.end()) {
      const bool taken = std::any_of(tables.begin(), tables.end(), [&](const Table& t) { return t.name == name; });
      table = tables.insert(tables.end(), {taken ? name + "." + a.name : name, {}});
    }
    table->columns.push_back(&a);
  }
  return tables;
}

std::string head(const ResultSet& results, const Table& table) {
  std::string line;
  const ResultArray& first = *table.columns.front();
  for (std::size_t d = 0; d < first.shape.size(); ++d) {
    const ResultArray* axis = results.axis(first, d);
    if (axis == nullptr) {
      line += fmt::format("index_{},", d);
    } else if (axis->size() == first.shape[d] + 1) {
      line += csv_cell(fmt::format("{}_from [{}]", axis->name, axis->unit)) + "," +
              csv_cell(fmt::format("{}_to [{}]", axis->name, axis->unit)) + ",";
    } else {
      line += csv_cell(fmt::format("{} [{}]", axis->name, axis->unit)) + ",";
    }
  }
  for (const ResultArray* a : table.columns)
    line += csv_cell(fmt::format("{} [{}]", a->name, a->unit)) + fmt::format(",{0}_sem,{0}_low,{0}_high,", a->name);
  line.back() = '\n';
  return line;
}

std::string row(const ResultSet& results, const Table& table, std::size_t cell) {
  std::string line;
  const ResultArray& first = *table.columns.front();
  std::size_t rest = first.size(), left = cell;
  for (std::size_t d = 0; d < first.shape.size(); ++d) {
    rest /= first.shape[d];
    const std::size_t at = left / rest;
    left %= rest;
    const ResultArray* axis = results.axis(first, d);
    if (axis == nullptr) {
      line += fmt::format("{},", at);
    } else if (axis->size() == first.shape[d] + 1) {
      line += number(axis->value[at]) + "," + number(axis->value[at + 1]) + ",";
    } else {
      line += number(axis->value[at]) + ",";
    }
  }
  for (const ResultArray* a : table.columns) {
    line += number(a->value[cell]) + "," + number(a->sem[cell]) + "," + number(a->low[cell]) + "," + number(a->high[cell]) + ",";
  }
  line.back() = '\n';
  return line;
}

void write_table(const fs::path& file, const ResultSet& results, const Table& table) {
  output::AtomicFile out(file);
  out.write(head(results, table));
  for (std::size_t cell = 0; cell < table.columns.front()->size(); ++cell) out.write(row(results, table, cell));
  out.commit();
}

std::string number_line(const ResultArray& a, std::size_t width, std::uint8_t doubtful) {
  const bool known = std::isfinite(a.sem[0]) && a.sem[0] > 0;
  const std::string sem = known ? fmt::format("+- {:.2g}", a.sem[0]) : "";
  const std::string interval = known ? fmt::format("[{:.5g}, {:.5g}]", a.low[0], a.high[0]) : "";
  const std::string doubts = flag_text(doubtful), unit = a.unit == "1" ? "" : a.unit;
  return fmt::format("  {:<{}}  {:>11.5g} {:<11}  {:<24} {}{}\n", a.name, width, a.value[0], sem, interval, unit,
                     doubts.empty() ? "" : "  (" + doubts + ")");
}

}  // namespace

std::string flag_text(std::uint8_t flags) {
  std::string text;
  const auto add = [&](std::uint8_t bit, const char* what) {
    if ((flags & bit) != 0) text += (text.empty() ? "" : ", ") + std::string(what);
  };
  add(kNoUncertainty, "no uncertainty");
  add(kFewBlocks, "few blocks");
  add(kCorrelated, "correlated blocks");
  add(kOftenUndefined, "often undefined");
  return text;
}

std::vector<fs::path> write_tables(const fs::path& directory, const ResultSet& results) {
  std::vector<fs::path> files{directory / "numbers.csv"};
  write_numbers(files.front(), results);
  for (const Table& table : tables_of(results)) {
    files.push_back(directory / (table.name + ".csv"));
    write_table(files.back(), results, table);
  }
  return files;
}

Json summary_json(const ResultSet& results) {
  Json j;
  j["schema_version"] = kResultsSchema;
  const Json meta = meta_json(results.meta);
  for (const auto& [key, value] : meta.items()) j[key] = value;
  j["covariance"] = {{"values", results.covariance_entries.size()}, {"rank", results.covariance_rank}};
  for (const ResultArray& a : results.arrays) {
    if (!is_number(a)) continue;
    j["numbers"][a.analyzer][a.name] = {{"value", a.value[0]},
                                        {"sem", a.sem[0]},
                                        {"low_90", a.low[0]},
                                        {"high_90", a.high[0]},
                                        {"unit", a.unit},
                                        {"effective_blocks", a.effective_blocks[0]},
                                        {"doubts", flag_text(a.flags[0])},
                                        {"traits", trait_names(a.traits)},
                                        {"meaning", a.doc}};
  }
  return j;
}

std::string number_table(const ResultSet& results, std::size_t most) {
  struct Shown {
    std::vector<const ResultArray*> rows;
    std::size_t more = 0, undefined = 0;
  };
  std::map<std::string, Shown> analyzers;
  std::size_t width = 6;
  for (const ResultArray& a : results.arrays) {
    if (!is_number(a)) continue;
    Shown& shown = analyzers[a.analyzer];
    if (!std::isfinite(a.value[0])) {
      ++shown.undefined;
    } else if (shown.rows.size() >= most) {
      ++shown.more;
    } else {
      shown.rows.push_back(&a);
      width = std::max(width, a.name.size());
    }
  }
  // What all share is said once, above the table.
  const std::uint8_t common = results.meta.blocks.size() < 10 ? kFewBlocks | kNoUncertainty : 0;
  std::string page;
  for (const auto& [name, shown] : analyzers) {
    page += fmt::format("{}\n", name);
    for (const ResultArray* a : shown.rows) page += number_line(*a, width, static_cast<std::uint8_t>(a->flags[0] & ~common));
    if (shown.more > 0) page += fmt::format("  and {} more\n", shown.more);
    if (shown.undefined > 0) page += fmt::format("  {} undefined in these data\n", shown.undefined);
  }
  return page;
}

}  // namespace millscope::analysis
