// The running surface of a liner as a profile: how far it is from the axis, round one pitch and along the mill.
//
// A pitch is what repeats round the mill: one lifter and the shell beside it. The profile has a number for each direction, so a surface
// that turns back under itself (a hook) has none; what the axis sees of it is taken.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernel/run/faces_round.hpp"
#include "millscope/geometry.hpp"

namespace millscope::wear {

using run::kTurn;

struct Profile {
  int pitches = 1;
  std::size_t columns = 0, rows = 1;             ///< directions of one pitch; rows along z
  double low = 0, high = 0;                      ///< ends along z, m
  bool periodic = false;                         ///< it goes on beyond `high` as at `low`
  bool low_face = false, high_face = false;      ///< a flat face closes the end
  std::vector<double> radius;                    ///< [rows, columns] m, in direction `columns` · step …
  std::vector<std::uint32_t> material;           ///< [columns] slot between a direction and the next
  std::array<std::uint32_t, 2> face_material{};  ///< slots of the end faces, low and high

  double step() const;  ///< angle between two directions, rad
  double row_length() const { return (high - low) / static_cast<double>(rows); }
  double& at(std::size_t row, std::size_t column) { return radius[row * columns + column % columns]; }
  double at(std::size_t row, std::size_t column) const { return radius[row * columns + column % columns]; }
  /// From the lowest to the highest place of the mean over rows, m: the height of the lifters.
  double relief() const;
  std::vector<double> mean_row() const;
};

/// How finely a profile is taken.
struct Resolution {
  double cell = 0;  ///< along the surface, m
  std::size_t rows = 1;
  int pitches = 0;                                   ///< 0: found out
  std::optional<std::array<double, 2>> period = {};  ///< along z, of a periodic slice, m
};

/// Takes the profile of a surface, the mean over its pitches. Throws UserError with `name` where the surface is no mill's: another axis, a
/// hole, an end that is half open, pitches that are not alike, one row where the liner changes along the mill.
Profile profile_of(const Surface& surface, const Interior& interior, const Resolution& resolution, const std::string& name);

}  // namespace millscope::wear
