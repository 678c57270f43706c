#include "studies/calibrate/observation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/error.hpp"

namespace millscope::calibrate {
namespace {

using Json = nlohmann::ordered_json;

Json histogram_json(const Histogram& h) { return {{"edges", h.edges}, {"percent", h.percent}, {"sem", h.sem}}; }

Histogram histogram_from(const Json& j) {
  return {j.at("edges").get<std::vector<double>>(), j.at("percent").get<std::vector<double>>(), j.at("sem").get<std::vector<double>>()};
}

}  // namespace

void require_defined(const Observation& o) {
  for (Eigen::Index i = 0; i < o.value.size(); ++i) {
    if (!std::isfinite(o.value[i]))
      throw base::UserError(fmt::format(
          "'{}' is undefined in {}: no bead was seen there; leave such speeds out (objective: {{without: [region_speed]}}), or narrow "
          "the ranges",
          o.observables[static_cast<std::size_t>(i)].name, o.of));
  }
}

void leave_out(Observation& o, const std::set<std::string>& names) {
  std::vector<Eigen::Index> kept;
  std::vector<Observable> observables;
  for (Eigen::Index i = 0; i < o.value.size(); ++i) {
    Observable& what = o.observables[static_cast<std::size_t>(i)];
    if (names.contains(what.name)) continue;
    kept.push_back(i);
    observables.push_back(std::move(what));
  }
  o.observables = std::move(observables);
  o.value = Eigen::VectorXd(o.value(kept));
  o.covariance = Eigen::MatrixXd(o.covariance(kept, kept));
}

Json to_json(const Observation& o) {
  Json observables = Json::array();
  for (Eigen::Index i = 0; i < o.value.size(); ++i) {
    const Observable& what = o.observables[static_cast<std::size_t>(i)];
    observables.push_back({{"name", what.name}, {"unit", what.unit}, {"group", what.group}, {"value", o.value[i]}});
  }
  std::vector<double> covariance(o.covariance.data(), o.covariance.data() + o.covariance.size());
  return {{"of", o.of},
          {"observables", observables},
          {"covariance", covariance},
          {"power", {{"value_W", o.power.value}, {"sem_W", o.power.sem}, {"how", o.power.how}}},
          {"x", histogram_json(o.x)},
          {"speed", histogram_json(o.speed)},
          {"bead_seconds", o.bead_seconds},
          {"blocks", o.blocks},
          {"notes", o.notes}};
}

void add_power_error(Observation& o, double relative) {
  o.power.sem = std::hypot(o.power.sem, relative * o.power.value);
  for (Eigen::Index i = 0; i < o.value.size(); ++i) {
    if (o.observables[static_cast<std::size_t>(i)].group == "power") o.covariance(i, i) += std::pow(relative * o.value[i], 2);
  }
}

Observation observation_from(const Json& j) {
  Observation o;
  o.of = j.value("of", std::string());
  const Json& observables = j.at("observables");
  const auto n = static_cast<Eigen::Index>(observables.size());
  o.value.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Json& item = observables.at(static_cast<std::size_t>(i));
    o.observables.push_back({item.at("name"), item.at("unit"), item.at("group")});
    o.value[i] = item.at("value").is_null() ? std::numeric_limits<double>::quiet_NaN() : item.at("value").get<double>();
  }
  const auto covariance = j.at("covariance").get<std::vector<double>>();
  o.covariance = Eigen::Map<const Eigen::MatrixXd>(covariance.data(), n, n);
  o.power = {j.at("power").at("value_W"), j.at("power").at("sem_W"), j.at("power").at("how")};
  o.x = histogram_from(j.at("x"));
  o.speed = histogram_from(j.at("speed"));
  o.bead_seconds = j.at("bead_seconds");
  o.blocks = j.at("blocks");
  o.notes = j.at("notes").get<std::vector<std::string>>();
  return o;
}

}  // namespace millscope::calibrate
