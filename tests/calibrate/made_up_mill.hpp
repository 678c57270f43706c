// A mill that answers at once: observables are smooth functions of the parameters, with noise from the seed. Its campaign remembers what it
// has computed, as the cache does, and can be told to fail or to be interrupted.
#pragma once

#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "studies/calibrate/evaluator.hpp"
#include "studies/calibrate/study.hpp"

namespace testing {

/// A folder that goes with the test.
struct Folder {
  std::filesystem::path path;
  Folder();
  ~Folder();
  std::filesystem::path write(const std::string& name, const std::string& text) const;
};

/// study.yaml beside an empty base and recordings; `more`: further sections.
millscope::calibrate::Study study_of(const Folder& folder, const std::string& parameters, const std::string& more);

/// A periodic drum of glass beads of 4 mm, 200 mm wide, turning at 2 rad/s until `end` in s.
std::string drum_case(int beads, double end);

/// The message of the UserError that `body` throws; "" when it throws none.
template <class Body>
std::string message_of(Body&& body) {
  try {
    body();
  } catch (const millscope::base::UserError& e) {
    CHECK(std::string(e.what()).find('\n') == std::string::npos);
    return e.what();
  }
  return "";
}

class MadeUpMill {
 public:
  /// The recording is that of `truth`.
  MadeUpMill(const millscope::calibrate::Study& study, const Eigen::VectorXd& truth, double noise = 0.01);

  millscope::calibrate::Machinery machinery();
  std::vector<millscope::calibrate::Observation> recorded() const;  ///< of every condition
  int computed() const { return computed_; }                        ///< simulations, each once

  std::function<bool(const Eigen::VectorXd&)> fails;  ///< empty: none
  int interrupted_after = 1 << 30;                    ///< simulations computed

  /// What this mill shows.
  millscope::calibrate::Observation observation(const Eigen::VectorXd& point, const std::string& settings) const;

 private:
  const millscope::calibrate::Study& study_;
  Eigen::VectorXd truth_;
  double noise_;
  int computed_ = 0;
  std::map<std::string, Eigen::VectorXd> cache_;
};

}  // namespace testing
