// From natural levels to coded ones. For the files of this room.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/doe/recognise.hpp"

namespace millscope::doe {

/// A factor's column of the table.
struct FactorColumn {
  std::string name;
  base::Column column;
};

struct Coded {
  Design design;
  PlanKind kind = PlanKind::other;
  std::vector<std::string> notes;
};

/// Each run on the low or high level of all factors, or midway of all; nothing where that does not hold.
std::optional<Coded> code_two_level(const std::vector<FactorColumn>& columns);

/// Corners, axial runs and centre runs. Tables print rounded values: with `axial` "auto" the axial distance is the rotatable, spherical or
/// face-centred one where all axial runs are so within their last digit, else it is as written. Nothing where a run is none of the three.
std::optional<Coded> code_composite(const std::vector<FactorColumn>& columns, const std::string& axial);

/// Any levels: −1 and +1 are the ends of the runs.
Coded code_range(const std::vector<FactorColumn>& columns);

}  // namespace millscope::doe
