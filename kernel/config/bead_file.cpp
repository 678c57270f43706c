#include "kernel/config/bead_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "kernel/base/error.hpp"
#include "kernel/base/text.hpp"
#include "kernel/config/units.hpp"

namespace millscope::config {
namespace {

using base::UserError;
using Words = std::vector<std::string_view>;

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
constexpr std::size_t kDiameter = 3, kRadius = 4, kVelocity = 5, kSpin = 8;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string_view::npos ? std::string_view() : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

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
    const std::string_view word = trimmed(line.substr(begin, end - begin));
    const bool unit = separator == ' ' && !words.empty() && !word.empty() && (word[0] == '[' || word[0] == '(');
    if (unit)
      words.back() = {words.back().data(), static_cast<std::size_t>(word.data() + word.size() - words.back().data())};
    else
      words.push_back(word);
    begin = end + 1;
  }
  return words;
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
      const std::string_view line = trimmed(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
      const bool remark = !line.empty() && line[0] == '#';
      if (line.empty() || (remark && !columns_.empty()) || (remark && !are_heads(trimmed(line.substr(1))))) continue;
      if (columns_.empty())
        read_heads(remark ? trimmed(line.substr(1)) : line);
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
      return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return plain_name(word) == wanted.name; });
    });
  }

  /// Of "X [mm]" x; of "v_x [m/s]" vx; of "x_mm" x.
  static std::string plain_name(std::string_view head) {
    std::string name;
    for (const char c : trimmed(head.substr(0, head.find_first_of("[(")))) {
      if (c != '_' && c != ' ') name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    const auto is = [&](const std::string& text) {
      return text == "material" ||
             std::any_of(kBeadColumns.begin(), kBeadColumns.end(), [&](const BeadColumn& known) { return text == known.name; });
    };
    const std::size_t mark = head.find_last_of('_');
    if (!is(name) && mark != std::string_view::npos && head.find_first_of("[(") == std::string_view::npos)
      return plain_name(head.substr(0, mark));
    return name;
  }

  void read_heads(std::string_view line) {
    separator_ = separator_of(line);
    for (const std::string_view word : split(line, separator_)) columns_.push_back(column_of(word));
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

  /// "x [mm]", "x (mm)", "x_mm", "X".
  ReadColumn column_of(std::string_view head) const {
    const std::string name = plain_name(head);
    std::size_t mark = head.find_first_of("[(");
    if (mark == std::string_view::npos && head.find('_') != std::string_view::npos &&
        plain_name(head.substr(0, head.find_last_of('_'))) == name)
      mark = head.find_last_of('_');
    if (name == "material") return {std::nullopt, true, {}};
    const auto known = std::find_if(kBeadColumns.begin(), kBeadColumns.end(), [&](const BeadColumn& q) { return name == q.name; });
    if (known == kBeadColumns.end()) {
      // A speed that is passed over would leave the beads at rest.
      if (name.starts_with("v") || name.starts_with("w") || name.starts_with("omega") || name.starts_with("spin"))
        fail(fmt::format("has a column '{}'; call velocities vx, vy, vz and spins wx, wy, wz, or leave it out", head));
      return {};
    }
    const auto quantity = static_cast<std::size_t>(known - kBeadColumns.begin());
    if (has(quantity)) fail(fmt::format("names '{}' twice", name));
    std::string_view unit = mark == std::string_view::npos ? std::string_view(known->unit) : head.substr(mark + 1);
    while (!unit.empty() && (unit.back() == ']' || unit.back() == ')' || unit.back() == ' ')) unit.remove_suffix(1);
    return {quantity, false, unit_of(trimmed(unit), *known)};
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
      if (column.material) bead.material = std::string(words[k]);
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

}  // namespace

std::vector<PlacedBead> read_bead_file(const std::string& path) { return BeadFile(path).read(); }

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

void take_mixture(std::vector<BeadCase>& classes, const std::string& path) {
  const std::vector<PlacedBead> beads = read_bead_file(path);
  std::vector<std::vector<double>> counts;
  for (const BeadCase& c : classes) counts.emplace_back(c.sizes.size(), 0);
  for (const PlacedBead& bead : beads) {
    const std::size_t b = class_of(classes, bead, path);
    const auto nearest = std::min_element(classes[b].sizes.begin(), classes[b].sizes.end(), [&](const auto& x, const auto& y) {
      return std::fabs(x.diameter - bead.diameter) < std::fabs(y.diameter - bead.diameter);
    });
    counts[b][static_cast<std::size_t>(nearest - classes[b].sizes.begin())] += 1;
  }
  for (std::size_t b = 0; b < classes.size(); ++b) {
    double own = 0;
    for (const double count : counts[b]) own += count;
    classes[b].number_share = own / static_cast<double>(beads.size());
    for (std::size_t k = 0; own > 0 && k < counts[b].size(); ++k) classes[b].sizes[k].number_fraction = counts[b][k] / own;
  }
}

}  // namespace millscope::config
