#include <fmt/format.h>

#include <cmath>
#include <set>

#include "kernel/base/error.hpp"
#include "studies/doe/least_squares.hpp"
#include "studies/doe/words.hpp"

namespace millscope::doe {
namespace {

using base::UserError;
constexpr int kMostRuns = 65536;

void check_centre_points(int centre_points) {
  if (centre_points < 0 || centre_points > 1000) throw UserError(fmt::format("{} centre points; give 0 to 1000", centre_points));
}

/// −1 and +1 in standard order.
Eigen::MatrixXd corners(int factors) {
  Eigen::MatrixXd signs(1 << factors, factors);
  for (Eigen::Index run = 0; run < signs.rows(); ++run) {
    for (int i = 0; i < factors; ++i) signs(run, i) = run >> i & 1 ? 1 : -1;
  }
  return signs;
}

Eigen::VectorXd product(const Eigen::MatrixXd& signs, Word word) {
  Eigen::VectorXd column = Eigen::VectorXd::Constant(signs.rows(), word.negative ? -1 : 1);
  for (const int i : members(word)) column.array() *= signs.col(i).array();
  return column;
}

void check_runs(int factors) {
  if (factors > 16) {
    throw UserError(fmt::format("2^{} runs are more than {}; make some factors by generators, or use latin_hypercube", factors, kMostRuns));
  }
}

Eigen::MatrixXd fraction(const std::vector<Generator>& generators, int factors) {
  std::vector<int> free;
  std::uint32_t made = 0;
  for (const Generator& g : generators) made |= 1u << g.made;
  for (int i = 0; i < factors; ++i) {
    if (!(made >> i & 1)) free.push_back(i);
  }
  check_runs(static_cast<int>(free.size()));
  const Eigen::MatrixXd base = corners(static_cast<int>(free.size()));
  Eigen::MatrixXd signs(base.rows(), factors);
  for (std::size_t i = 0; i < free.size(); ++i) signs.col(free[i]) = base.col(static_cast<Eigen::Index>(i));
  for (const Generator& g : generators) signs.col(g.made) = product(signs, g.of);
  return signs;
}

Eigen::MatrixXd stacked(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below) {
  Eigen::MatrixXd all(above.rows() + below.rows(), above.cols());
  all << above, below;
  return all;
}

void append(Design& design, const Eigen::MatrixXd& runs, const char* kind) {
  if (runs.rows() == 0) return;
  design.coded = design.coded.size() == 0 ? runs : stacked(design.coded, runs);
  design.kind.insert(design.kind.end(), runs.rows(), kind);
}

/// The shortest word tells what is lost: one factor is constant, two factors are one.
void refuse_confounded(const std::vector<Word>& relation, const std::vector<Factor>& factors) {
  for (const Word& word : relation) {
    if (word.length() > 2) continue;
    throw UserError(fmt::format("these generators hold {} constant, so that its {} cannot be told apart; take products of more factors",
                                text_of(word, factors), word.length() == 2 ? "two factors" : "effect and the mean"));
  }
}

}  // namespace

void check(const std::vector<Factor>& factors) {
  if (factors.empty()) throw UserError("a plan of no factors; name at least one");
  if (factors.size() > static_cast<std::size_t>(kMostFactors)) {
    throw UserError(fmt::format("{} factors; at most {} are planned for", factors.size(), kMostFactors));
  }
  std::set<std::string> names;
  for (const Factor& f : factors) {
    if (f.name.empty() || f.name.find_first_of("*=,\"\n") != std::string::npos) {
      throw UserError(fmt::format("factor '{}': a name is not empty and has no '*', '=', ',' or quotes", f.name));
    }
    if (!names.insert(f.name).second) throw UserError(fmt::format("factor '{}' stands twice; leave one out", f.name));
    if (!std::isfinite(f.centre) || !std::isfinite(f.step) || f.step <= 0) {
      throw UserError(
          fmt::format("factor '{}': centre {} and step {}; its high level must lie above its low one", f.name, f.centre, f.step));
    }
  }
}

Eigen::VectorXd natural(const std::vector<Factor>& factors, const Eigen::VectorXd& coded) {
  Eigen::VectorXd values(coded.size());
  for (Eigen::Index i = 0; i < coded.size(); ++i) {
    const Factor& f = factors.at(i);
    values[i] = f.centre + f.step * coded[i];
  }
  return values;
}

Eigen::VectorXd coded(const std::vector<Factor>& factors, const Eigen::VectorXd& natural) {
  Eigen::VectorXd values(natural.size());
  for (Eigen::Index i = 0; i < natural.size(); ++i) {
    const Factor& f = factors.at(i);
    values[i] = (natural[i] - f.centre) / f.step;
  }
  return values;
}

Design two_level(std::vector<Factor> factors, const std::vector<std::string>& generators, int centre_points) {
  check(factors);
  check_centre_points(centre_points);
  const int count = static_cast<int>(factors.size());
  const std::vector<Generator> parsed = parse_generators(generators, factors);
  std::vector<Word> words;
  for (const Generator& g : parsed) words.push_back(g.of * Word{1u << g.made, false});
  if (words.size() > 16) throw UserError(fmt::format("{} generators; at most 16", words.size()));
  const std::vector<Word> relation = closure(words);
  refuse_confounded(relation, factors);
  Design design;
  append(design, fraction(parsed, count), "factorial");
  append(design, Eigen::MatrixXd::Zero(centre_points, count), "centre");
  design.resolution = resolution_of(relation);
  for (const auto& chain : chains(count, relation)) {
    if (chain.size() > 1) design.aliases.push_back(text_of(chain, factors));
  }
  design.factors = std::move(factors);
  return design;
}

double rotatable(int factors) { return std::pow(2.0, factors / 4.0); }

Design central_composite(std::vector<Factor> factors, double axial_distance, int centre_points) {
  check(factors);
  check_centre_points(centre_points);
  const int count = static_cast<int>(factors.size());
  if (count < 2) throw UserError("a central composite plan of one factor; name at least two");
  if (!std::isfinite(axial_distance) || axial_distance <= 0) {
    throw UserError(fmt::format("axial distance {}: give a positive number of steps, e.g. 1 (face-centred) or {:.4g} (rotatable)",
                                axial_distance, rotatable(count)));
  }
  check_runs(count);
  Design design;
  append(design, corners(count), "factorial");
  Eigen::MatrixXd axial = Eigen::MatrixXd::Zero(2 * count, count);
  for (int i = 0; i < count; ++i) {
    axial(2 * i, i) = -axial_distance;
    axial(2 * i + 1, i) = axial_distance;
  }
  append(design, axial, "axial");
  append(design, Eigen::MatrixXd::Zero(centre_points, count), "centre");
  design.factors = std::move(factors);
  return design;
}

}  // namespace millscope::doe
