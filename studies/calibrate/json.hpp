// Observations and what they rest on as JSON, for the cache. NaN, what is undefined, is null there. For the files of this room.
#pragma once

#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "kernel/output/summary.hpp"
#include "studies/calibrate/recorded.hpp"

namespace nlohmann {

template <>
struct adl_serializer<Eigen::VectorXd> {
  static void to_json(json& j, const Eigen::VectorXd& v) { j = std::vector<double>(v.begin(), v.end()); }
  static void from_json(const json& j, Eigen::VectorXd& v) {
    v.resize(static_cast<Eigen::Index>(j.size()));
    Eigen::Index i = 0;
    for (const json& x : j) v[i++] = x.is_null() ? std::numeric_limits<double>::quiet_NaN() : x.get<double>();
  }
};

/// By columns.
template <>
struct adl_serializer<Eigen::MatrixXd> {
  static void to_json(json& j, const Eigen::MatrixXd& m) { j = {{"rows", m.rows()}, {"values", Eigen::VectorXd(m.reshaped())}}; }
  static void from_json(const json& j, Eigen::MatrixXd& m) {
    const Eigen::VectorXd values = j.at("values");
    const Eigen::Index rows = j.at("rows");
    m = values.reshaped(rows, rows > 0 ? values.size() / rows : 0);
  }
};

}  // namespace nlohmann

namespace millscope::recording {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Travel, speed, noise)
}
namespace millscope::analysis {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BlockLengths, least, wished, correlation)
}

namespace millscope::calibrate {

inline void to_json(nlohmann::json& j, ObservableKind kind) { j = name_of(kind); }
inline void from_json(const nlohmann::json& j, ObservableKind& kind) { kind = kind_named(j.get<std::string>()); }

// A struct with a member that is not named here comes back without it: the test of this room compares whole structs.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Observable, name, unit, kind)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Histogram, edges, percent, sem)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PowerFigure, value, sem, how)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Observation, of, observables, value, covariance, resampled, power, x, speed, bead_seconds, blocks, notes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Summary, observable, kind, analyzer, result, weight, cells, factor, places)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Smoothing, noise, noise_correlation, roughness, gap_limit, travel, blocks)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AxialPlace, low, high, middle)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RecordedCondition, observation, summaries, analyzers, camera, smoothing, place, mass, omega,
                                   measured_power, axis_path, axis_noise, identity)

/// What lies in the cache; nothing where it is not there, damaged or of another shape.
template <class T>
std::optional<T> read_cached(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  try {
    return nlohmann::json::parse(in).get<T>();
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

template <class T>
void write_cached(const std::filesystem::path& file, const T& value) {
  output::write_json(file, nlohmann::ordered_json(nlohmann::json(value)));
}

}  // namespace millscope::calibrate
