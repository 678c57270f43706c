// The bank: simulations of the mill over θ, without and with each candidate, in every condition; computed once, kept by content.
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "studies/calibrate/machinery.hpp"
#include "studies/diagnose/bank/frame_readings.hpp"

namespace millscope::diagnose {

inline constexpr double kLeastStrength = 0.1;  ///< of a one-sided candidate's simulations

/// One parameter set of the bank.
struct BankPoint {
  std::string group;  ///< "base", "again", a candidate's or a nuisance's name, "candidate*nuisance", "candidate+candidate"; with > or <
                      ///< where it is beyond.hpp's
  int index = 0;      ///< within the group
  VectorXd theta;
  std::vector<naming::ActiveCandidate> active;
};

/// What is varied in some of the bank's simulations beside the parameters: nothing, the strength of a candidate or of two, or a nuisance.
struct Group {
  std::optional<Index> candidate = {};
  std::optional<Index> nuisance = {};  ///< coordinate of θ
  std::optional<Index> second = {};    ///< candidate
  bool base() const { return !candidate && !nuisance; }
  Index size() const { return (candidate ? 1 : 0) + (nuisance ? 1 : 0) + (second ? 1 : 0); }
};
/// The coordinates of nuisances that are varied apart, in groups of their own.
std::vector<Index> varied_apart(const Question& question);

/// Sobol' points over the ranges; what is simulated of a group does not depend on the other groups, on how many are asked for, nor on the
/// camera's nuisances, so that a bank grows without losing a run. One-sided strengths lie in 0.1 … 1.
std::vector<BankPoint> plan_group(const Question& question, const Group& group, int count);
/// The first half without a candidate, eight at least, each once more with another seed: what runs differ by alone, Surrogate::chance().
std::vector<BankPoint> plan_again(const Question& question);
/// What tells which candidates cannot matter: all without a candidate, the first with every candidate alone.
std::vector<BankPoint> plan_screening(const Question& question);
/// A candidate together with a nuisance that is varied apart, which tells whether it acts otherwise there (rolling friction does in stiffer
/// contacts): of every two of its parameter sets the stronger, with the nuisance far from the case's value. None where they would be too
/// few.
std::vector<BankPoint> plan_together(const Question& question, Index candidate, Index nuisance);
/// What a candidate that may matter has besides: the rest of those with it alone, and those with it and each nuisance that is varied apart.
std::vector<BankPoint> plan_rest(const Question& question, Index candidate);
/// As many with a candidate alone as the bank has already, for one that helps.
std::vector<BankPoint> plan_more(const Question& question, Index candidate);
/// Two candidates at once, as many as with one: whether they add up. Named and seeded alike in either order.
std::vector<BankPoint> plan_pair(const Question& question, Index one, Index other);
/// Both, for all candidates.
std::vector<BankPoint> plan_bank(const Question& question);

/// Candidates that somebody asks after in held-out conditions, and how many coefficients the surrogate has for them.
struct AskedCandidates {
  std::set<Index> which = {};
  Index coefficients = 0;
};
/// Of some points what is simulated in held-out conditions: all without a candidate, and of candidates what is asked; everything where
/// these are too few parameter sets to tell the base.
std::vector<BankPoint> held_out_points(const Question& question, std::vector<BankPoint> points, const AskedCandidates& asked);

/// From a filling at rest.
campaign::Simulation simulation_of(const Question& question, const BankPoint& point, std::size_t condition);
/// [points × conditions] as the bank has them: where it develops (BankSize::develop_turns), most begin at another's end (warm_starts.cpp).
std::vector<campaign::Simulation> simulations_of(const Question& question, const std::vector<BankPoint>& points,
                                                 const std::vector<std::size_t>& conditions);

/// A simulation at a chosen parameter set; `replicate`: seed.
campaign::Simulation simulation_at(const Question& question, const VectorXd& theta, const std::vector<naming::ActiveCandidate>& active,
                                   std::size_t condition, int replicate, const std::string& label);

/// What the recordings show, and what of it is compared.
struct Evidence {
  std::vector<calibrate::Observation> recorded;          ///< of every condition, with the readings
  std::vector<std::vector<FrameReading>> readings = {};  ///< of every recording's frame; empty: nothing of it is doubted
  std::vector<std::set<std::string>> without = {};       ///< [conditions] observables that are compared nowhere; empty: all are

  /// What a simulation at θ shows, readings of the frame included; NaN for what is undefined: the speed where no bead was seen. Throws
  /// base::UserError where it failed.
  calibrate::Observation look(const calibrate::Machinery& machinery, const Question& question, std::size_t condition,
                              const campaign::Outcome& outcome, const VectorXd& theta) const;
};

/// The points with what was seen of them in some conditions.
struct Bank {
  std::vector<BankPoint> points;
  std::vector<std::size_t> conditions;
  std::vector<std::vector<std::optional<calibrate::Observation>>> seen;  ///< [points][conditions]; nothing: it failed
  std::vector<std::string> failures;                                     ///< one line each
  std::vector<std::vector<std::filesystem::path>> runs = {};             ///< [points][conditions] where each simulation is

  /// Where a condition of the study stands among `conditions`.
  std::optional<std::size_t> place_of(std::size_t condition) const {
    const auto found = std::find(conditions.begin(), conditions.end(), condition);
    return found == conditions.end() ? std::nullopt : std::optional<std::size_t>(found - conditions.begin());
  }
};

/// Runs what is not in the cache. What is undefined is NaN.
Bank fill_bank(const Question& question, const calibrate::Machinery& machinery, const Evidence& evidence, std::vector<BankPoint> points,
               std::vector<std::size_t> conditions);

/// Both, each of other conditions: what was seen of a point of `more` stands with the same point of the first; of its others nothing.
Bank joined(Bank bank, const Bank& more);

/// What some of the bank's simulations leave undefined: the speed in a region into which they throw no bead.
struct Undefined {
  std::vector<std::set<std::string>> names;  ///< [conditions of the study] of observables
  std::vector<std::string> notes;            ///< one sentence for each
};
Undefined undefined_in(const Question& question, const Bank& bank);
/// The same without these observables, which are compared nowhere from now on.
Evidence leave_out(Evidence evidence, const Undefined& undefined);
Bank leave_out(Bank bank, const Undefined& undefined);

/// Which of some conditions' simulations are not steady yet when they begin to be looked at, by all of them together: one run's chance
/// hides what they share, and what they share is wrong in all of the surrogate. One sentence for each.
std::vector<std::string> unsettled(const Question& question, const Bank& bank, const std::vector<std::size_t>& conditions);

/// The numbers of some of the bank's conditions; points of which one failed are left out.
naming::BankData data_of(const Question& question, const Bank& bank, const std::vector<std::size_t>& conditions);

}  // namespace millscope::diagnose
