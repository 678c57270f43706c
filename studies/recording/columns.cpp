// Names and units of columns.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "kernel/config/units.hpp"
#include "studies/recording/description.hpp"

namespace millscope::recording {

std::optional<Quantity> quantity_of(std::string_view name) {
  std::string word;
  for (const char c : name) {
    if (c != ' ' && c != '_' && c != '-' && c != '.') word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  constexpr std::pair<const char*, Quantity> kNames[] = {{"t", kTime},
                                                         {"time", kTime},
                                                         {"timestamp", kTime},
                                                         {"x", kX},
                                                         {"xpos", kX},
                                                         {"posx", kX},
                                                         {"xposition", kX},
                                                         {"positionx", kX},
                                                         {"y", kY},
                                                         {"ypos", kY},
                                                         {"posy", kY},
                                                         {"yposition", kY},
                                                         {"positiony", kY},
                                                         {"z", kZ},
                                                         {"zpos", kZ},
                                                         {"posz", kZ},
                                                         {"zposition", kZ},
                                                         {"positionz", kZ},
                                                         {"error", kError},
                                                         {"e", kError},
                                                         {"err", kError},
                                                         {"u", kError},
                                                         {"spread", kError},
                                                         {"residual", kError},
                                                         {"uncertainty", kError},
                                                         {"sigma", kError},
                                                         {"events", kEvents},
                                                         {"n", kEvents},
                                                         {"nevents", kEvents}};
  for (const auto& [known, quantity] : kNames) {
    if (word == known) return quantity;
  }
  return std::nullopt;
}

const char* usual_unit(Quantity quantity) { return quantity == kTime ? "ms" : quantity == kEvents ? "1" : "mm"; }

ColumnUnit column_unit(Quantity quantity, std::string_view text) {
  const config::Unit unit = config::parse_unit(text);
  const config::Unit wanted = config::parse_unit(quantity == kTime ? "s" : quantity == kEvents ? "1" : "m");
  if (unit.dimension != wanted.dimension) {
    throw std::invalid_argument(fmt::format("'{}' is a unit of {}, but here stands a {}", text, config::dimension_name(unit.dimension),
                                            quantity == kTime     ? "time, e.g. ms"
                                            : quantity == kEvents ? "number"
                                                                  : "length, e.g. mm"));
  }
  return {std::string(text), unit.factor * std::pow(10.0, std::max(unit.decade, 0)), std::pow(10.0, std::max(-unit.decade, 0))};
}

}  // namespace millscope::recording
