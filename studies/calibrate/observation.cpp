#include "studies/calibrate/observation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "kernel/base/error.hpp"

namespace millscope::calibrate {
namespace {

/// In the order of ObservableKind.
constexpr std::array kKindNames{"power", "centre", "x", "y", "speed", "occupancy", "region_speed", "term", "profile", "outline", "frame"};
static_assert(kKindNames.size() == static_cast<std::size_t>(ObservableKind::frame) + 1);

}  // namespace

const char* name_of(ObservableKind kind) { return kKindNames.at(static_cast<std::size_t>(kind)); }

ObservableKind kind_named(const std::string& name) {
  const auto found = std::find(kKindNames.begin(), kKindNames.end(), name);
  if (found == kKindNames.end()) throw std::invalid_argument(name + " is no kind of observable");
  return static_cast<ObservableKind>(found - kKindNames.begin());
}

std::optional<Eigen::Index> Observation::find(ObservableKind kind) const {
  const auto found = std::find_if(observables.begin(), observables.end(), [&](const Observable& o) { return o.kind == kind; });
  return found == observables.end() ? std::nullopt : std::optional<Eigen::Index>(found - observables.begin());
}

double few_blocks_factor(double blocks) { return blocks > 5 ? (blocks - 1) / (blocks - 3) : 2; }

void require_defined(const Observation& o) {
  Eigen::Index i = 0;
  for (const Observable& what : o.observables) {
    if (!std::isfinite(o.value[i++]))
      throw base::UserError(fmt::format(
          "'{}' is undefined in {}: no bead was seen there; leave such speeds out (objective: {{without: [region_speed]}}), or narrow "
          "the ranges",
          what.name, o.of));
  }
}

void leave_out(Observation& o, const std::set<std::string>& names) {
  std::vector<Eigen::Index> kept;
  std::vector<Observable> observables;
  Eigen::Index i = 0;
  for (Observable& what : o.observables) {
    if (!names.contains(what.name)) {
      kept.push_back(i);
      observables.push_back(std::move(what));
    }
    ++i;
  }
  o.observables = std::move(observables);
  o.value = Eigen::VectorXd(o.value(kept));
  o.covariance = Eigen::MatrixXd(o.covariance(kept, kept));
  if (o.resampled.size() > 0) o.resampled = Eigen::MatrixXd(o.resampled(kept, kept));
}

}  // namespace millscope::calibrate
