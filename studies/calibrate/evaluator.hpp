// Parameter sets in, objectives out: every set is simulated in all fit conditions, through the campaign's cache.
//
// Nothing is kept between calls but the cache of simulations: a driver that is run again asks for the same points in the same order and
// gets the same answers, so a study that was killed ends as if it had not been.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "studies/calibrate/machinery.hpp"
#include "studies/calibrate/objective.hpp"
#include "studies/calibrate/study.hpp"

namespace millscope::calibrate {

/// A parameter set with what it gave.
struct Trial {
  Eigen::VectorXd point;  ///< natural units, in the order of the study's parameters
  int replicate = 0;      ///< another seed
  std::string stage;      ///< "screening", "descent", …
  bool failed = false;
  std::string message;                  ///< why it failed
  std::vector<std::size_t> conditions;  ///< of the study
  std::vector<Observation> observed;    ///< of each of them
  std::vector<std::filesystem::path> folders;
  ChagasObjective chagas;  ///< mean over the conditions
  double misfit = 0;       ///< sum over the conditions
  double wall_s = 0;       ///< of its simulations
};

class Evaluator {
 public:
  /// `recorded`: of every condition of the study, as the data say; to their uncertainty the study's power error is added.
  Evaluator(const Study& study, Machinery machinery, std::vector<Observation> recorded);

  struct Wanted {
    Eigen::VectorXd point;
    int replicate = 0;  ///< not 0: another seed
  };
  /// Runs the sets in the fit conditions, remembers and returns them in their order. A set that was tried before is not counted twice.
  /// Throws UserError when all that have been tried so far have failed.
  std::vector<Trial> evaluate(const std::vector<Wanted>& wanted, const std::string& stage);
  std::vector<Trial> evaluate(const std::vector<Eigen::VectorXd>& points, const std::string& stage);
  /// One set in single conditions, all in one campaign; not counted against the budget and not remembered.
  std::vector<std::pair<std::size_t, Trial>> each_in(const Eigen::VectorXd& point, const std::vector<std::size_t>& conditions) const;

  const std::vector<Trial>& trials() const { return trials_; }  ///< in the order of their evaluation, each once
  int simulations() const { return simulations_; }              ///< that the budget counts
  /// How many more sets the budget allows.
  int left() const;
  double objective(const Trial& trial) const;  ///< as the study chose; +infinity for a failed one
  const Study& study() const { return study_; }
  const Observation& recorded(std::size_t condition) const { return recorded_[condition]; }  ///< with the power error
  void say(const std::string& line) const { machinery_.say(line); }

 private:
  struct Job {
    Wanted wanted;
    std::vector<std::size_t> conditions;
  };
  std::vector<Trial> run(const std::vector<Job>& jobs, const std::string& stage) const;
  Trial look(const Job& job, std::span<const campaign::Outcome> outcomes) const;
  const Trial* known(const Wanted& wanted) const;

  const Study& study_;
  Machinery machinery_;
  std::vector<Observation> recorded_;
  std::vector<Trial> trials_;
  int simulations_ = 0;
  double wall_ = 0;  ///< s, of all simulations
};

}  // namespace millscope::calibrate
