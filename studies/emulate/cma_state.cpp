// The search's state as text.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kernel/base/error.hpp"
#include "studies/emulate/cma_es.hpp"

namespace millscope::emulate {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::json;

constexpr int kVersion = 1;

json from(const VectorXd& v) { return std::vector<double>(v.begin(), v.end()); }

VectorXd vector_of(const json& node, Index size) {
  const auto values = node.get<std::vector<double>>();
  if (static_cast<Index>(values.size()) != size) throw base::UserError(fmt::format("{} numbers where {} belong", values.size(), size));
  return VectorXd::Map(values.data(), size);
}

/// JSON has no infinity: null stands for it.
json number(double x) { return std::isfinite(x) ? json(x) : json(nullptr); }
double number_of(const json& node) { return node.is_null() ? std::numeric_limits<double>::infinity() : node.get<double>(); }

}  // namespace

std::string CmaEs::save() const {
  json history = json::array(), asked = json::array();
  for (const double x : state_.history) history.push_back(number(x));
  for (const VectorXd& x : state_.asked) asked.push_back(from(x));
  const json state = {{"version", kVersion},
                      {"lower", from(box_.lower)},
                      {"upper", from(box_.upper)},
                      {"mean", from(state_.mean)},
                      {"path_sigma", from(state_.path_sigma)},
                      {"path_covariance", from(state_.path_covariance)},
                      {"covariance", from(state_.covariance.reshaped())},
                      {"best", from(state_.best)},
                      {"best_value", number(state_.best_value)},
                      {"sigma", state_.sigma},
                      {"generation", state_.generation},
                      {"population", state_.population},
                      {"seed", state_.random},
                      {"history", history},
                      {"asked", asked}};
  return state.dump();
}

CmaEs CmaEs::restore(const Box& box, const std::string& text) {
  try {
    const json node = json::parse(text);
    const Index n = box.size();
    if (node.at("version") != kVersion) throw base::UserError("it is of another version");
    if (vector_of(node.at("lower"), n) != box.lower || vector_of(node.at("upper"), n) != box.upper) {
      throw base::UserError("it was saved with other ranges");
    }
    State s;
    s.mean = vector_of(node.at("mean"), n);
    s.path_sigma = vector_of(node.at("path_sigma"), n);
    s.path_covariance = vector_of(node.at("path_covariance"), n);
    s.covariance = vector_of(node.at("covariance"), n * n).reshaped(n, n);
    s.best = vector_of(node.at("best"), n);
    s.best_value = number_of(node.at("best_value"));
    s.sigma = node.at("sigma").get<double>();
    s.generation = node.at("generation").get<int>();
    s.population = node.at("population").get<int>();
    s.random = node.at("seed").get<std::uint64_t>();
    for (const json& x : node.at("history")) s.history.push_back(number_of(x));
    for (const json& x : node.at("asked")) s.asked.push_back(vector_of(x, n));
    return {box, std::move(s)};
  } catch (const json::exception& error) {
    throw base::UserError(fmt::format("the saved state of the search cannot be read: {}; start the search again", error.what()));
  } catch (const base::UserError& error) {
    throw base::UserError(fmt::format("the saved state of the search does not fit: {}; start the search again", error.what()));
  }
}

}  // namespace millscope::emulate
