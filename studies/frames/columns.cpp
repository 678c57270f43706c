#include "studies/frames/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "kernel/base/text.hpp"
#include "kernel/config/units.hpp"

namespace millscope::frames {
namespace {

struct Name {
  const char* text;
  Quantity quantity;
  double part = 1;  ///< of what the column holds: half of a diameter is a radius
};

constexpr Name kScalars[] = {{"id", kId},
                             {"number", kId},
                             {"globalid", kId},
                             {"globalpointids", kId},
                             {"type", kType},
                             {"typeid", kType},
                             {"material", kType},
                             {"radius", kRadius},
                             {"sphereradius", kRadius},
                             {"r", kRadius},
                             {"rad", kRadius},
                             {"mass", kMass},
                             {"density", kDensity},
                             {"rho", kDensity},
                             {"time", kTime},
                             {"simulationtime", kTime},
                             {"diameter", kRadius, 0.5},
                             {"d", kRadius, 0.5},
                             {"diam", kRadius, 0.5}};
constexpr Name kVectors[] = {{"", kX},
                             {"position", kX},
                             {"pos", kX},
                             {"coordinate", kX},
                             {"coordinates", kX},
                             {"points", kX},
                             {"v", kVelocityX},
                             {"velocity", kVelocityX},
                             {"vel", kVelocityX},
                             {"translationalvelocity", kVelocityX},
                             {"u", kVelocityX},
                             {"omega", kSpinX},
                             {"w", kSpinX},
                             {"spin", kSpinX},
                             {"angularvelocity", kSpinX},
                             {"angvel", kSpinX},
                             {"rotationalvelocity", kSpinX}};

/// Small letters and digits alone, without "Q01 :" before, units behind and the word "particle".
std::string plain(std::string_view name) {
  name = without_number(name);
  if (const std::size_t bracket = name.find_first_of("([{"); bracket != std::string_view::npos && bracket > 0) {
    // "c_spin[1]" of a dump is no unit, and no name that is known.
    name = name.substr(0, bracket);
  }
  std::string out;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (const std::string_view word : {"particle", "atom", "bead"}) {
    if (const std::size_t at = out.find(word); at != std::string::npos && out.size() > word.size()) out.erase(at, word.size());
  }
  return out;
}

/// What stands in brackets behind a name; nothing where nothing does.
std::optional<std::string> unit_in(std::string_view name) {
  const std::size_t open = name.find_last_of("([{"), close = name.find_last_of(")]}");
  if (open == std::string_view::npos || close == std::string_view::npos || close < open || open == 0) return std::nullopt;
  return base::trimmed(name.substr(open + 1, close - open - 1));
}

const char* si_unit(Quantity q) {
  if (q <= kType) return "1";
  if (q <= kZ || q == kRadius) return "m";
  if (q <= kVelocityZ) return "m/s";
  if (q <= kSpinZ) return "rad/s";
  return q == kMass ? "kg" : q == kDensity ? "kg/m^3" : "s";
}

/// Of a column that names no unit.
double usual_factor(Quantity q, const ReadOptions& options) {
  if (q >= kVelocityX && q <= kVelocityZ) return options.speed;
  if (q >= kSpinX && q <= kSpinZ) return options.spin;
  return q == kRadius || (q >= kX && q <= kZ) ? options.length : 1;
}

double factor_of(std::string_view name, Quantity q, const ReadOptions& options) {
  const std::optional<std::string> text = unit_in(name);
  if (!text || q <= kType) return usual_factor(q, options);
  config::Unit unit;
  try {
    unit = config::parse_unit(*text == "sec" ? "s" : *text == "m/sec" ? "m/s" : *text == "rad/sec" ? "rad/s" : *text);
  } catch (const std::exception& e) {
    throw std::invalid_argument(
        fmt::format("column '{}': its unit '{}' is not known ({}); correct the head of the column", name, *text, e.what()));
  }
  if (unit.dimension != config::parse_unit(si_unit(q)).dimension)
    throw std::invalid_argument(
        fmt::format("column '{}': '{}' is no unit like {}; correct the head of the column", name, *text, si_unit(q)));
  return unit.to_si(1);
}

Quantity component(Quantity first, std::size_t which) { return static_cast<Quantity>(static_cast<std::size_t>(first) + which); }

/// Which coordinate a name ends with: x y z, or 0 1 2.
std::optional<std::size_t> coordinate_at_end(const std::string& name) {
  if (name.empty()) return std::nullopt;
  for (const std::string_view letters : {"xyz", "012"}) {
    if (const std::size_t at = letters.find(name.back()); at != std::string_view::npos) return at;
  }
  return std::nullopt;
}

Column found(std::string_view name, Quantity quantity, const ReadOptions& options, double part = 1) {
  return {quantity, part * factor_of(name, quantity, options), unit_in(name).has_value(), false};
}

}  // namespace

std::string_view without_number(std::string_view name) {
  if (name.size() < 3 || (name[0] != 'Q' && name[0] != 'q') || std::isdigit(static_cast<unsigned char>(name[1])) == 0) return name;
  const std::size_t colon = name.find(':');
  if (colon != std::string_view::npos) name.remove_prefix(std::min(name.find_first_not_of(' ', colon + 1), name.size()));
  return name;
}

Column column_of(std::string_view name, const ReadOptions& options) {
  const std::string text = plain(name);
  // Of dumps (LAMMPS, `dump custom`): coordinates unwrapped (u), scaled by the box (s), both.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string letter(1, "xyz"[axis]);
    if (text == letter + "u") return {component(kX, axis), options.length, false, false};
    if (text == letter + "s" || text == letter + "su") return {component(kX, axis), 1, false, true};
  }
  for (const Name& known : kScalars) {
    if (text != known.text) continue;
    const bool needs_si = known.quantity == kMass || known.quantity == kDensity;
    if (needs_si && !unit_in(name) && options.length != 1) return {};  // a kilogram and a kg/m³ are what they are only in SI
    return found(name, known.quantity, options, known.part);
  }
  const std::optional<std::size_t> coordinate = coordinate_at_end(text);
  if (!coordinate) return {};
  for (const Name& known : kVectors) {
    if (text.substr(0, text.size() - 1) != known.text) continue;
    if (text.size() == 1 && std::isdigit(static_cast<unsigned char>(text[0])) != 0) return {};
    const Quantity q = component(known.quantity, *coordinate);
    return found(name, q, options);
  }
  return {};
}

Column vector_column_of(std::string_view name, const ReadOptions& options) {
  const std::string text = plain(name);
  for (const Name& known : kVectors) {
    // Places are the points of the picture.
    if (text == known.text && known.quantity != kX) return found(name, known.quantity, options);
  }
  return {};
}

Columns::Columns(const std::vector<std::string>& names, const ReadOptions& options) : names_(names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    columns_.push_back(column_of(names[i], options));
    for (std::size_t k = 0; k < i && columns_[i].quantity; ++k) {
      if (columns_[k].quantity == columns_[i].quantity)
        throw std::invalid_argument(fmt::format("columns '{}' and '{}' hold the same quantity; write one of them", names[k], names[i]));
    }
  }
}

bool Columns::has(Quantity quantity) const {
  return std::any_of(columns_.begin(), columns_.end(), [&](const Column& c) { return c.quantity == quantity; });
}

std::string Columns::lacking() const {
  std::string lack, there;
  for (const Quantity q : {kX, kY, kZ}) {
    if (!has(q)) lack += fmt::format("{}{}", lack.empty() ? "" : ", ", "xyz"[q - kX]);
  }
  if (lack.empty()) return "";
  for (std::size_t i = 0; i < std::min<std::size_t>(names_.size(), 12); ++i) there += fmt::format("{}{}", i > 0 ? ", " : "", names_[i]);
  return fmt::format("no column holds {} of the beads (columns: {}{}); write the places as well", lack, there,
                     names_.size() > 12 ? ", …" : "");
}

void Columns::begin(Frame& frame) const {
  frame.clear();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (!columns_[i].quantity && !names_[i].empty()) frame.passed_over.push_back(names_[i]);
  }
}

}  // namespace millscope::frames
