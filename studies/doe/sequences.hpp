// Points in the unit cube. For the files of this room.
#pragma once

#include <Eigen/Core>

namespace millscope::doe {

/// The first points of Sobol's sequence after the corner, [points, dimensions], in (0, 1).
Eigen::MatrixXd sobol_points(Eigen::Index points, Eigen::Index dimensions);

}  // namespace millscope::doe
