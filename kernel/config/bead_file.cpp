#include "kernel/config/bead_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "kernel/base/error.hpp"
#include "kernel/base/text.hpp"
#include "kernel/config/units.hpp"

namespace millscope::config {
namespace {

using base::UserError;
using Words = std::vector<std::string>;

constexpr std::string_view kBlanks = " \t\r";

struct BeadColumn {
  const char *name, *unit;
};
constexpr std::array<BeadColumn, 11> kBeadColumns{{{"x", "m"},
                                                   {"y", "m"},
                                                   {"z", "m"},
                                                   {"diameter", "m"},
                                                   {"radius", "m"},
                                                   {"vx", "m/s"},
                                                   {"vy", "m/s"},
                                                   {"vz", "m/s"},
                                                   {"wx", "rad/s"},
                                                   {"wy", "rad/s"},
                                                   {"wz", "rad/s"}}};
constexpr std::string_view kMaterial = "material";
constexpr std::array<std::string_view, 4> kMotions{"v", "w", "omega", "spin"};  // of names that may mean one
constexpr std::size_t kDiameter = 3, kRadius = 4, kVelocity = 5, kSpin = 8;

char separator_of(std::string_view heads) {
  for (const char c : {';', ',', '\t'}) {
    if (heads.find(c) != std::string_view::npos) return c;
  }
  return ' ';
}

/// Units in brackets are no words of their own: "x [mm] y [mm]".
Words split(std::string_view line, char separator) {
  Words words;
  for (std::size_t begin = 0; begin <= line.size();) {
    if (separator == ' ') begin = std::min(line.find_first_not_of(kBlanks, begin), line.size() + 1);
    if (begin > line.size()) break;
    const std::size_t end = std::min(separator == ' ' ? line.find_first_of(kBlanks, begin) : line.find(separator, begin), line.size());
    std::string word = base::trimmed(line.substr(begin, end - begin), kBlanks);
    if (separator == ' ' && !words.empty() && (word.starts_with('[') || word.starts_with('(')))
      words.back() += " " + word;
    else
      words.push_back(std::move(word));
    begin = end + 1;
  }
  return words;
}

std::optional<std::size_t> column_of_name(std::string_view name) {
  const auto known = std::find_if(kBeadColumns.begin(), kBeadColumns.end(), [&](const BeadColumn& c) { return name == c.name; });
  return known == kBeadColumns.end() ? std::nullopt : std::optional<std::size_t>(known - kBeadColumns.begin());
}

/// "X [mm]" is x in mm, "v_x" vx, "x_mm" x in mm: what stands behind the last '_' is a unit where the whole is no name.
struct Head {
  std::string name;
  std::optional<std::string> unit;
};

Head head_of(std::string_view text) {
  const std::size_t bracket = text.find_first_of("[(");
  Head head;
  for (const char c : text.substr(0, bracket)) {
    if (c != '_' && kBlanks.find(c) == kBlanks.npos) head.name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (bracket != text.npos) {
    head.unit = base::trimmed(text.substr(bracket + 1), " \t\r])");
    return head;
  }
  const std::size_t mark = text.find_last_of('_');
  if (head.name == kMaterial || column_of_name(head.name) || mark == text.npos) return head;
  return {head_of(text.substr(0, mark)).name, std::string(text.substr(mark + 1))};
}

struct ReadColumn {
  std::optional<std::size_t> quantity;  ///< of kBeadColumns
  bool material = false;
  Unit unit;
};

class BeadFile {
 public:
  explicit BeadFile(std::string path) : path_(std::move(path)) {}

  std::vector<PlacedBead> read() {
    const std::string text = base::text_of(path_);
    std::vector<PlacedBead> beads;
    std::string_view rest = text;
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
    while (!rest.empty()) {
      ++line_;
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      const std::string line = base::trimmed(rest.substr(0, end), kBlanks);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      const bool remark = line.starts_with('#');
      const std::string told = remark ? base::trimmed(line.substr(1), kBlanks) : line;
      if (line.empty() || (remark && (!columns_.empty() || !are_heads(told)))) continue;
      if (columns_.empty())
        read_heads(told);
      else
        beads.push_back(read_bead(line));
    }
    if (beads.empty()) fail("holds no bead; give a line of heads (x [mm], y [mm], z [mm], diameter [mm]) and a bead a line");
    return beads;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { throw UserError(base::Location{path_, static_cast<int>(line_)}, why); }

  bool has(std::size_t quantity) const {
    return std::any_of(columns_.begin(), columns_.end(), [&](const ReadColumn& c) { return c.quantity == quantity; });
  }

  /// A remark may name the columns: then x, y and z among others.
  static bool are_heads(std::string_view line) {
    const Words words = split(line, separator_of(line));
    return std::all_of(kBeadColumns.begin(), kBeadColumns.begin() + kDiameter, [&](const BeadColumn& wanted) {
      return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return head_of(word).name == wanted.name; });
    });
  }

  void read_heads(std::string_view line) {
    separator_ = separator_of(line);
    for (const std::string& word : split(line, separator_)) columns_.push_back(column_of(word));
    for (std::size_t q = 0; q < kDiameter; ++q) {
      if (!has(q))
        fail(
            fmt::format("names no column '{}'; the heads of a file of beads are x, y, z, diameter or radius, material, vx … wz, with "
                        "units, e.g. x [mm]",
                        kBeadColumns[q].name));
    }
    if (has(kDiameter) == has(kRadius)) fail("wants one column 'diameter' or 'radius'");
    for (const std::size_t first : {kVelocity, kSpin}) {
      if (has(first) != has(first + 1) || has(first) != has(first + 2))
        fail(fmt::format("names some of '{}', '{}', '{}'; give all three or none", kBeadColumns[first].name, kBeadColumns[first + 1].name,
                         kBeadColumns[first + 2].name));
    }
  }

  ReadColumn column_of(std::string_view text) const {
    const Head head = head_of(text);
    if (head.name == kMaterial) return {std::nullopt, true, {}};
    const std::optional<std::size_t> quantity = column_of_name(head.name);
    if (!quantity) {
      // A speed that is passed over would leave the beads at rest.
      if (std::any_of(kMotions.begin(), kMotions.end(), [&](std::string_view begin) { return head.name.starts_with(begin); }))
        fail(fmt::format("has a column '{}'; call velocities vx, vy, vz and spins wx, wy, wz, or leave it out", text));
      return {};
    }
    if (has(*quantity)) fail(fmt::format("names '{}' twice", head.name));
    const BeadColumn& known = kBeadColumns[*quantity];
    return {quantity, false, unit_of(head.unit.value_or(known.unit), known)};
  }

  Unit unit_of(std::string_view text, const BeadColumn& quantity) const {
    try {
      const Unit unit = parse_unit(text);
      if (unit.dimension == parse_unit(quantity.unit).dimension) return unit;
    } catch (const std::invalid_argument&) {  // said below
    }
    fail(fmt::format("has the unit '{}' for '{}'; give one like {}", text, quantity.name, quantity.unit));
  }

  PlacedBead read_bead(std::string_view line) const {
    const Words words = split(line, separator_);
    const bool comma_behind = words.size() == columns_.size() + 1 && words.back().empty();
    if (words.size() != columns_.size() && !comma_behind) fail(fmt::format("has {} columns, but {} heads", words.size(), columns_.size()));
    PlacedBead bead;
    bead.line = line_;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const ReadColumn& column = columns_[k];
      if (column.material) bead.material = words[k];
      if (column.quantity) set(bead, *column.quantity, column.unit.to_si(number(words[k])));
    }
    if (!(bead.diameter > 0)) fail(fmt::format("has a bead of {:.4g} m; a diameter is more than 0", bead.diameter));
    return bead;
  }

  static void set(PlacedBead& bead, std::size_t quantity, double value) {
    if (quantity < kDiameter) bead.centre[quantity] = value;
    if (quantity == kDiameter) bead.diameter = value;
    if (quantity == kRadius) bead.diameter = 2 * value;
    if (quantity >= kVelocity && quantity < kSpin) bead.velocity[quantity - kVelocity] = value;
    if (quantity >= kSpin) bead.spin[quantity - kSpin] = value;
  }

  double number(std::string_view word) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc() && end == word.data() + word.size() && std::isfinite(value)) return value;
    fail(fmt::format("has '{}' where a number belongs{}", word, word.find(',') == word.npos ? "" : "; write decimal points"));
  }

  std::string path_;
  std::size_t line_ = 0;
  char separator_ = ' ';
  std::vector<ReadColumn> columns_;
};

std::size_t class_of(const std::vector<BeadCase>& classes, const PlacedBead& bead, const std::string& path) {
  constexpr double kRounding = 1e-4;  // of a diameter that was written with few digits
  std::vector<std::size_t> fit;
  for (std::size_t b = 0; b < classes.size(); ++b) {
    const auto [least, most] = std::minmax_element(classes[b].sizes.begin(), classes[b].sizes.end(),
                                                   [](const auto& x, const auto& y) { return x.diameter < y.diameter; });
    const bool size = bead.diameter >= (1 - kRounding) * least->diameter && bead.diameter <= (1 + kRounding) * most->diameter;
    if (size && (bead.material.empty() || bead.material == classes[b].material)) fit.push_back(b);
  }
  if (fit.size() == 1) return fit[0];
  const base::Location where{path, static_cast<int>(bead.line)};
  const std::string what = fmt::format("a bead of {:.6g} m{}", bead.diameter, bead.material.empty() ? "" : " of " + bead.material);
  if (fit.empty())
    throw UserError(where,
                    fmt::format("has {}, which no class below 'beads' of the case is; check its unit and material, or add a class", what));
  throw UserError(where, fmt::format("has {}, which is of {} classes below 'beads'; give a column 'material', or sizes that do not overlap",
                                     what, fit.size()));
}

}  // namespace

std::vector<PlacedBead> read_bead_file(const std::string& path) { return BeadFile(path).read(); }

void place_beads(Case& c) {
  c.fill.placed = read_bead_file(c.fill.file);
  std::vector<std::vector<double>> counts;
  for (const BeadCase& bead : c.beads) counts.emplace_back(bead.sizes.size(), 0);
  for (PlacedBead& placed : c.fill.placed) {
    placed.bead_class = class_of(c.beads, placed, c.fill.file);
    const std::vector<SizeClass>& sizes = c.beads[placed.bead_class].sizes;
    const auto nearest = std::min_element(sizes.begin(), sizes.end(), [&](const auto& x, const auto& y) {
      return std::fabs(x.diameter - placed.diameter) < std::fabs(y.diameter - placed.diameter);
    });
    counts[placed.bead_class][static_cast<std::size_t>(nearest - sizes.begin())] += 1;
  }
  for (std::size_t b = 0; b < c.beads.size(); ++b) {
    const double own = std::accumulate(counts[b].begin(), counts[b].end(), 0.0);
    c.beads[b].number_share = own / static_cast<double>(c.fill.placed.size());
    for (std::size_t k = 0; own > 0 && k < counts[b].size(); ++k) c.beads[b].sizes[k].number_fraction = counts[b][k] / own;
  }
}

}  // namespace millscope::config
