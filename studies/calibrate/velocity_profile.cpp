#include "studies/calibrate/velocity_profile.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/base/table.hpp"
#include "kernel/config/existing_file.hpp"
#include "kernel/config/units.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;
using config::Node;

constexpr std::size_t kMostValues = 12;
constexpr std::size_t kFewestPoints = 4;
constexpr std::size_t kNeighbours = 2;  // points on either side of a group that its slope is taken from, too
constexpr int kPlaces = 81;             // of bed_profile, from shell to shell

/// One column in SI.
std::vector<double> column(const Node& node, const base::Table& table, const char* unit) {
  node.expect({"column", "unit"});
  const Node name = node.at("column", "the head of the column"), in = node.at("unit", "e.g. mm or m/s");
  if (!table.has(name.text()))
    name.fail(fmt::format("is '{}', which is no column of {}; it has {}", name.text(), table.file(), fmt::join(table.names(), ", ")));
  config::Unit factor;
  try {
    factor = config::parse_unit(in.text());
  } catch (const std::exception& e) {
    in.fail(fmt::format("is '{}': {}", in.text(), e.what()));
  }
  if (factor.dimension != config::parse_unit(unit).dimension) in.fail(fmt::format("is '{}', not a unit like {}", in.text(), unit));
  std::vector<double> values = table.numbers(table.index_of(name.text())).value;
  for (double& v : values) v = factor.to_si(v);
  return values;
}

void keep(VelocityProfile& profile, double from, double to) {
  std::vector<std::size_t> order(profile.position.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) { return profile.position[i] < from || profile.position[i] > to; });
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return profile.position[a] < profile.position[b]; });
  std::vector<double> position, velocity;
  for (const std::size_t i : order) position.push_back(profile.position[i]), velocity.push_back(profile.velocity[i]);
  profile.position = std::move(position), profile.velocity = std::move(velocity);
}

/// Neighbouring points as one: where they lie, their mean velocity, the slope there.
struct Value {
  std::vector<double> places;
  double velocity = 0, slope = 0;
};

/// Slope of the straight line of least squares through points first … last − 1; 0 where they lie at one place.
double slope_of(const VelocityProfile& p, std::size_t first, std::size_t last) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = first; i < last; ++i) {
    n += 1, x += p.position[i], y += p.velocity[i];
    xx += p.position[i] * p.position[i], xy += p.position[i] * p.velocity[i];
  }
  const double spread = xx - x * x / n;
  return spread > 0 ? (xy - x * y / n) / spread : 0;
}

std::vector<Value> values_of(const VelocityProfile& p) {
  const std::size_t n = p.position.size(), groups = std::min(n, kMostValues);
  std::vector<Value> out;
  for (std::size_t g = 0; g < groups; ++g) {
    const std::size_t first = g * n / groups, last = (g + 1) * n / groups;
    Value v;
    for (std::size_t i = first; i < last; ++i) {
      v.places.push_back(p.position[i]);
      v.velocity += p.velocity[i] / static_cast<double>(last - first);
    }
    v.slope = slope_of(p, first - std::min(first, kNeighbours), std::min(n, last + kNeighbours));
    out.push_back(std::move(v));
  }
  return out;
}

/// C_ij = δ_ij (σ_v² + s_i² σ_p²)/n_i + s_i s_j σ_0², s the slope dv/dp: σ_v and σ_p are each point's own, σ_0 all share.
Eigen::MatrixXd covariance_of(const VelocityProfile& p, const std::vector<Value>& values) {
  const auto n = static_cast<Eigen::Index>(values.size());
  Eigen::MatrixXd c(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Value& v = values[i];
    for (Eigen::Index j = 0; j < n; ++j) c(i, j) = v.slope * values[j].slope * p.origin_error * p.origin_error;
    c(i, i) += (std::pow(p.velocity_error, 2) + std::pow(v.slope * p.position_error, 2)) / static_cast<double>(v.places.size());
  }
  return c;
}

/// The part of the length that is looked at. A slice stands for every part of a long mill: there it is none.
std::string range_text(const VelocityProfile& p, const Condition& c, const analysis::MillOfCase& mill, Observation& o) {
  if (!p.z_low) return "";
  if (mill.period > 0) {
    o.notes.push_back("the case is periodic along z: 'z' of the profile is left out");
    return "";
  }
  if (*p.z_low < mill.context.mill_low || *p.z_high > mill.context.mill_high)
    throw UserError(c.where,
                    fmt::format("condition '{}': 'z' of {} goes from {:.4g} to {:.4g} mm, but the case's mill from {:.4g} to {:.4g} "
                                "mm; correct one of them",
                                c.name, c.recording.string(), 1e3 * *p.z_low, 1e3 * *p.z_high, 1e3 * mill.context.mill_low,
                                1e3 * mill.context.mill_high));
  return fmt::format(", z_from: {:.9g}, z_to: {:.9g}", *p.z_low, *p.z_high);
}

}  // namespace

VelocityProfile VelocityProfile::read(const Node& section) {
  section.expect({"file", "position", "velocity", "position_error", "velocity_error", "origin_error", "from", "to", "z"});
  VelocityProfile profile;
  const Node file = section.at("file", "the table of points, e.g. points.csv");
  profile.files = {config::existing_file(file)};
  const base::Table table = base::Table::read(profile.files.front());
  profile.position = column(section.at("position", "{column: NAME, unit: mm}"), table, "m");
  profile.velocity = column(section.at("velocity", "{column: NAME, unit: m/s}"), table, "m/s");
  const auto error = [&](const char* key, const char* example, const char* unit) {
    return config::read_number(section.at(key, example), unit, config::positive("it is the standard error of a point"));
  };
  profile.position_error = error("position_error", "e.g. 1 mm", "m");
  profile.velocity_error = error("velocity_error", "e.g. 0.01 m/s", "m/s");
  if (const auto node = section.find("origin_error"))
    profile.origin_error = config::read_number(*node, "m", config::between(0, 1, "it is the standard error of all positions together"));
  const auto place = [&](const char* key, double otherwise) {
    const auto node = section.find(key);
    return node ? config::read_number(*node, "m") : otherwise;
  };
  constexpr double kAll = std::numeric_limits<double>::infinity();
  keep(profile, place("from", -kAll), place("to", kAll));
  if (profile.position.size() < kFewestPoints)
    file.fail(fmt::format("has {} points between 'from' and 'to', and fewer than {} are no profile; widen the range",
                          profile.position.size(), kFewestPoints));
  if (const auto z = section.find("z")) {
    const auto ends = z->items();
    if (ends.size() != 2) z->fail("wants two lengths, e.g. [0 mm, 360 mm]");
    profile.z_low = config::read_number(ends[0], "m"), profile.z_high = config::read_number(ends[1], "m");
    if (!(*profile.z_high > *profile.z_low)) z->fail("must rise");
  }
  return profile;
}

void VelocityProfile::measure(const FigureOf& of, RecordedCondition& r) const {
  const Condition& c = of.condition;
  const double radius = of.mill.context.mill_radius, farthest = std::max(-position.front(), position.back());
  if (farthest >= radius)
    throw UserError(c.where,
                    fmt::format("condition '{}': {} has a point {:.4g} mm from the axis, but the mill of {} has a radius of {:.4g} mm; "
                                "correct one of them, or narrow 'from' and 'to'",
                                c.name, c.recording.string(), 1e3 * farthest, of.study.base.string(), 1e3 * radius));
  const std::vector<Value> values = values_of(*this);
  Observation& o = r.observation;
  r.analyzers = fmt::format("  bed_profile: {{points: {}{}}}\n", kPlaces, range_text(*this, c, of.mill, o));
  o.value.resize(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::vector<double>& at = values[i].places;
    const double middle = std::accumulate(at.begin(), at.end(), 0.0) / static_cast<double>(at.size());
    const Observable what{fmt::format("velocity at {:.1f} mm", 1e3 * middle), "m/s", ObservableKind::profile};
    r.summaries.push_back({what, Summary::along, "bed_profile", "velocity", "", {}, 1, at});
    o.value[static_cast<Eigen::Index>(i)] = values[i].velocity;
  }
  o.covariance = covariance_of(*this, values);
  o.notes.push_back(fmt::format("{} points of {} as {} values, with the errors that are stated", position.size(),
                                files.front().filename().string(), values.size()));
}

}  // namespace millscope::calibrate
