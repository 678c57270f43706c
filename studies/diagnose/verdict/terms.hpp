// A few terms that would describe the missing mean acceleration: offered as a hypothesis to be tested, never as a finding.
//
//   Δa ≈ Σ c_k f_k(place, velocity, Ω)      c_k with the unit that makes it an acceleration
//
// Which terms: stability selection (Meinshausen & Bühlmann 2010, doi:10.1111/j.1467-9868.2010.00740.x). Of many random halves of the
// cells, the share in which a term describes the half best; by their theorem 1, with one term chosen of p, a share of at least π lets in
// 1/((2π − 1) p) wrong terms on average: 0.21 for π = 0.85 and p = 7. A second term is looked for in what the first leaves over.
#pragma once

#include <string>
#include <vector>

#include "studies/diagnose/verdict/missing_force.hpp"

namespace millscope::diagnose {

struct OfferedTerm {
  std::string name;              ///< "linear drag"
  std::string equation;          ///< "-c v"
  std::string unit;              ///< of the coefficient
  base::Interval90 coefficient;  ///< from halves of the cells
  double share = 0;              ///< of the halves that chose it
};

struct TermOffer {
  std::vector<OfferedTerm> terms;  ///< at most two; empty: none is stable
  double explained = 0;            ///< part of the misfit of the cells that were not used for fitting that the terms take away
  std::size_t cells = 0;
};

/// From the cells of all conditions; deterministic.
TermOffer offer_terms(const std::vector<MissingForce>& missing);

/// "Terms that would describe it: …", or that none is stable.
std::string sentence_of(const TermOffer& offer);

}  // namespace millscope::diagnose
