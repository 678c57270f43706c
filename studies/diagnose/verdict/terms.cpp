#include "studies/diagnose/verdict/terms.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "kernel/base/random.hpp"

namespace millscope::diagnose {
namespace {

constexpr int kHalves = 400;
constexpr double kStable = 0.85;         // share of the halves
constexpr double kGain = 0.95;           // share of the halves whose other half the term describes better than nothing
constexpr std::size_t kLeastCells = 16;  // fewer cannot be halved for up to two coefficients
constexpr std::size_t kMostTerms = 2;

using Vector2 = std::array<double, 2>;

struct Term {
  const char *name, *equation, *unit;
  Vector2 (*of)(const Vector2& place, const Vector2& velocity, double omega);
};

/// Velocity less that of what turns with the shell: v − Ω × r.
Vector2 slip(const Vector2& r, const Vector2& v, double omega) { return {v[0] + omega * r[1], v[1] - omega * r[0]}; }

/// −|u|^n u
Vector2 against(const Vector2& u, int power) {
  const double factor = -std::pow(std::hypot(u[0], u[1]), power);
  return {factor * u[0], factor * u[1]};
}

constexpr std::array<Term, 7> kTerms = {{
    {"uniform lift", "c y^", "m/s^2",
     [](const Vector2&, const Vector2&, double) {
       return Vector2{0, 1};
     }},
    {"linear drag", "-c v", "1/s", [](const Vector2&, const Vector2& v, double) { return against(v, 0); }},
    {"quadratic drag", "-c |v| v", "1/m", [](const Vector2&, const Vector2& v, double) { return against(v, 1); }},
    {"linear drag towards the shell's motion", "-c (v - Omega x r)", "1/s",
     [](const Vector2& r, const Vector2& v, double omega) { return against(slip(r, v, omega), 0); }},
    {"quadratic drag towards the shell's motion", "-c |v - Omega x r| (v - Omega x r)", "1/m",
     [](const Vector2& r, const Vector2& v, double omega) { return against(slip(r, v, omega), 1); }},
    {"pull towards the shell", "c Omega^2 r", "1",
     [](const Vector2& r, const Vector2&, double omega) {
       return Vector2{omega * omega * r[0], omega * omega * r[1]};
     }},
    {"sideways force", "c Omega x v", "1",
     [](const Vector2&, const Vector2& v, double omega) {
       return Vector2{-omega * v[1], omega * v[0]};
     }},
}};

/// Two rows for each cell, in standard errors.
struct Rows {
  Eigen::MatrixXd term;     // [2 cells, terms]
  Eigen::VectorXd missing;  // [2 cells]
  std::size_t cells() const { return missing.size() / 2; }
};

double sem_of(const base::Interval90& i) { return i.standard_error(); }

Rows rows_of(const std::vector<MissingForce>& missing) {
  std::size_t cells = 0;
  for (const MissingForce& m : missing) cells += m.cells.size();
  Rows rows{Eigen::MatrixXd(static_cast<Eigen::Index>(2 * cells), static_cast<Eigen::Index>(kTerms.size())),
            Eigen::VectorXd(static_cast<Eigen::Index>(2 * cells))};
  Eigen::Index row = 0;
  for (const MissingForce& m : missing) {
    for (const ForceCell& c : m.cells) {
      const double sem[] = {sem_of(c.x), sem_of(c.y)}, value[] = {c.x.value, c.y.value};
      for (std::size_t axis = 0; axis < 2; ++axis, ++row) {
        rows.missing[row] = value[axis] / sem[axis];
        for (std::size_t k = 0; k < kTerms.size(); ++k)
          rows.term(row, static_cast<Eigen::Index>(k)) =
              kTerms[k].of({c.place[0], c.place[1]}, {c.velocity[0], c.velocity[1]}, m.omega)[axis] / sem[axis];
      }
    }
  }
  return rows;
}

/// Rows of the cells [from, to) of an order.
std::vector<Eigen::Index> rows_of_cells(const std::vector<std::size_t>& order, std::size_t from, std::size_t to) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = from; i < to; ++i) {
    rows.push_back(static_cast<Eigen::Index>(2 * order[i]));
    rows.push_back(static_cast<Eigen::Index>(2 * order[i] + 1));
  }
  return rows;
}

struct Half {
  Eigen::VectorXd coefficients;
  double left = 0;       ///< misfit of its own cells
  double elsewhere = 0;  ///< misfit of the other half, with these coefficients
};

Half fitted(const Rows& rows, const std::vector<Eigen::Index>& own, const std::vector<Eigen::Index>& other,
            const std::vector<Eigen::Index>& terms) {
  Half half;
  const Eigen::MatrixXd a = rows.term(own, terms);
  const Eigen::VectorXd b = rows.missing(own);
  half.coefficients = a.completeOrthogonalDecomposition().solve(b);
  half.left = (b - a * half.coefficients).squaredNorm();
  half.elsewhere = (rows.missing(other) - rows.term(other, terms) * half.coefficients).squaredNorm();
  return half;
}

/// Of all halves: which term each would add to `chosen`, and whether its own choice describes the other half better than without it.
struct Vote {
  std::array<int, kTerms.size()> chosen{}, helps{};
};

template <class Visit>
void each_half(const Rows& rows, Visit&& visit) {
  base::RandomStream random(2010);
  std::vector<std::size_t> order(rows.cells());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (int h = 0; h < kHalves; ++h) {
    random.shuffle(order);
    visit(rows_of_cells(order, 0, order.size() / 2), rows_of_cells(order, order.size() / 2, order.size()));
  }
}

Vote vote(const Rows& rows, const std::vector<Eigen::Index>& chosen) {
  Vote votes;
  each_half(rows, [&](const std::vector<Eigen::Index>& own, const std::vector<Eigen::Index>& other) {
    const double before = chosen.empty() ? rows.missing(other).squaredNorm() : fitted(rows, own, other, chosen).elsewhere;
    std::size_t best = kTerms.size();
    Half found;
    for (std::size_t k = 0; k < kTerms.size(); ++k) {
      std::vector<Eigen::Index> with = chosen;
      if (std::find(with.begin(), with.end(), static_cast<Eigen::Index>(k)) != with.end()) continue;
      with.push_back(static_cast<Eigen::Index>(k));
      Half half = fitted(rows, own, other, with);
      if (best == kTerms.size() || half.left < found.left) best = k, found = std::move(half);
    }
    ++votes.chosen[best];
    if (found.elsewhere < before) ++votes.helps[best];
  });
  return votes;
}

}  // namespace

TermOffer offer_terms(const std::vector<MissingForce>& missing) {
  const Rows rows = rows_of(missing);
  TermOffer offer;
  offer.cells = rows.cells();
  if (offer.cells < kLeastCells) return offer;
  std::vector<Eigen::Index> chosen;
  while (chosen.size() < kMostTerms) {
    const Vote votes = vote(rows, chosen);
    const auto best = std::max_element(votes.chosen.begin(), votes.chosen.end()) - votes.chosen.begin();
    const double share = static_cast<double>(votes.chosen[best]) / kHalves;
    if (share < kStable || votes.helps[best] < kGain * votes.chosen[best]) break;
    chosen.push_back(static_cast<Eigen::Index>(best));
    offer.terms.push_back({kTerms[best].name, kTerms[best].equation, kTerms[best].unit, {}, share});
  }
  if (chosen.empty()) return offer;
  std::vector<std::vector<double>> coefficients(chosen.size());
  double left = 0, nothing = 0;
  each_half(rows, [&](const std::vector<Eigen::Index>& own, const std::vector<Eigen::Index>& other) {
    const Half half = fitted(rows, own, other, chosen);
    for (std::size_t k = 0; k < chosen.size(); ++k) coefficients[k].push_back(half.coefficients[k]);
    left += half.elsewhere, nothing += rows.missing(other).squaredNorm();
  });
  offer.explained = 1 - left / nothing;
  // A half drawn without replacement scatters about the whole with variance s²(2/n − 1/n) = s²/n: that of the whole itself.
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    double mean = 0, square = 0;
    for (const double c : coefficients[k]) mean += c / kHalves;
    for (const double c : coefficients[k]) square += (c - mean) * (c - mean) / (kHalves - 1);
    offer.terms[k].coefficient = base::Interval90::about(mean, std::sqrt(square));
  }
  return offer;
}

std::string sentence_of(const TermOffer& offer) {
  if (offer.cells < kLeastCells) return fmt::format("Terms that would describe it were not looked for: {} cells are too few.", offer.cells);
  if (offer.terms.empty())
    return fmt::format("No term of {} describes it alike in random halves of the {} cells: none is offered.", kTerms.size(), offer.cells);
  std::string text = "A hypothesis to test, not a finding: ";
  for (std::size_t k = 0; k < offer.terms.size(); ++k) {
    const OfferedTerm& t = offer.terms[k];
    text += fmt::format("{}{} ({}), c = {:.3g} ({:.3g} … {:.3g}) {}", k == 0 ? "" : " and ", t.name, t.equation, t.coefficient.value,
                        t.coefficient.low, t.coefficient.high, t.unit);
  }
  return text +
         fmt::format(
             ". Chosen in at least {:.0f} % of random halves of the {} cells; takes {:.0f} % of the misfit away in the other "
             "halves. 'millscope plugin new body_force NAME' makes a plugin of it, and a candidate.",
             100 * std::min_element(offer.terms.begin(), offer.terms.end(), [](const auto& a, const auto& b) { return a.share < b.share; })
                       ->share,
             offer.cells, 100 * offer.explained);
}

}  // namespace millscope::diagnose
