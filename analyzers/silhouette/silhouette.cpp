// The bed as a camera sees it through the mill's end face: averaged over time, and measured ring by ring as a picture of a real drum is.
//
// A place is covered while any bead's disc lies over it, in front or behind. The camera stands far away on the mill's axis.
#include <algorithm>
#include <cmath>
#include <vector>

#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"

#include "millscope/element.hpp"
#include "millscope/silhouette.hpp"

namespace millscope::analyzers {
namespace {

constexpr double kLeastArc = 0.01;  // part of a ring that has a middle, be it covered or free

constexpr Parameter kParameters[] = {
    integer_parameter("cells", 160, 20, 1000, "Cells from shell to shell, in both directions."),
    kAxialFrom,
    kAxialTo,
    kEndTrim,
};

class Silhouette {
 public:
  static constexpr std::uint64_t kNeeds = kHasAllBeads;

  Silhouette(const Parameters& p, const AnalyzerContext& context)
      : range_(axial_range(p, context)),
        radius_(shell_radius(context)),
        sense_(known_sense(context)),
        n_(p.integer("cells")),
        cells_(-radius_, radius_, n_) {}

  std::vector<ArrayInfo> arrays() const {
    const auto n = static_cast<std::uint64_t>(n_);
    return {additive("covered", "s", {n, n}), additive("time", "s")};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    std::vector<char> covered(as_size(n_ * n_));
    for (std::int64_t f = 0; f < block.frame_count; ++f) {
      const std::int64_t first = block.first[f], end = block.first[f + 1];
      const double time = first < end ? block.weight[first] : 0;  // of one frame all beads have the same
      if (!(time > 0)) continue;
      std::fill(covered.begin(), covered.end(), char{0});
      for (std::int64_t s = first; s < end; ++s) {
        if (range_.contains(block.position[2][s])) cover(block.position[0][s], block.position[1][s], block.radius[s], covered);
      }
      for (std::int64_t c = 0; c < n_ * n_; ++c) sums[0][c] += covered[as_size(c)] ? time : 0;
      sums[1][0] += time;
    }
  }

  void finish(const double* const* sums, Results& results) const {
    const auto n = as_size(n_), rings = as_size(std::int64_t{kSilhouetteRings});
    std::vector<double> map(n * n), share, direction, edge, area, border{kSilhouetteInner};
    for (std::size_t c = 0; c < map.size(); ++c) map[c] = ratio(sums[0][c], sums[1][0]);
    const SilhouetteShape shape = silhouette_shape(map.data(), n_);
    for (const SilhouetteRing& ring : shape.rings) {
      border.push_back(ring.outer);
      area.push_back(ring.outer * ring.outer - ring.inner * ring.inner);
      share.push_back(100 * ring.share);
      direction.push_back(ring.has_middle(kLeastArc) ? kDegrees * sense_ * ring.direction : kNaN);
      edge.push_back(radius_ * ring.edge);
    }
    results.add("x_edges", "m", cells_.edges().data(), {n + 1}, "Edges of the cells along x.", {}, kAlongX);
    results.add("y_edges", "m", cells_.edges().data(), {n + 1}, "Edges of the cells along y.");
    results.add("covered", "1", map.data(), {n, n}, "Share of the time that beads cover the cell.", {"y_edges", "x_edges"}, kShare);
    results.add("ring", "1", border.data(), {rings + 1}, "Edges of the rings, in radii of the shell.");
    results.add("ring_area", "1", area.data(), {rings}, "Area of the rings, parts of the cross-section.", {"ring"}, kNotNegative);
    results.add("share", "%", share.data(), {rings}, "Share of the ring that the bed covers.", {"ring"}, kShare);
    results.add("direction", "deg", direction.data(), {rings},
                "Middle of what it covers, from 6 o'clock in the turning sense; NaN: nearly free, or nearly full.", {"ring"});
    results.add("edge", "m", edge.data(), {rings}, "Width of the blurred edge along the ring.", {"ring"}, kNotNegative);
    results.add("area", "%", 100 * shape.area, "Share of the mill's cross-section that the bed covers.");
    results.add("surface_angle", "deg", kDegrees * std::atan(sense_ * shape.slope),
                "Slope of the straight line through the surface over the middle half of the width.");
  }

 private:
  void cover(double x, double y, double radius, std::vector<char>& covered) const {
    const auto number = [&](double at) { return (at - cells_.low) * cells_.per_unit - 0.5; };  // of the cell whose centre lies there
    const auto from = [&](double at) { return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(number(at)))); };
    const auto to = [&](double at) { return std::min(n_ - 1, static_cast<std::int64_t>(std::floor(number(at)))); };
    for (std::int64_t row = from(y - radius), last = to(y + radius); row <= last; ++row) {
      const double off = cells_.centre(row) - y, half = std::sqrt(std::max(0.0, radius * radius - off * off));
      const std::int64_t left = from(x - half), right = to(x + half);
      if (left <= right) std::fill_n(covered.begin() + row * n_ + left, right - left + 1, char{1});
    }
  }

  AxialRange range_;
  double radius_, sense_;
  std::int64_t n_;
  Bins cells_;
};

constexpr Descriptor kDescriptor = describe<Silhouette>({
    .name = "silhouette",
    .version = "0.1.0",
    .doc = "The bed as a camera sees it through the end face, averaged over time: outline by rings, area, angle of the surface.",
    .equation = "S = <P>, phi = arg <P (cos, sin)> over each ring; P: share of the time that any bead covers the place",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
