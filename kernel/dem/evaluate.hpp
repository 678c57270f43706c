// Runs all physics of one pair of materials over a batch whose geometry and histories are filled, and books it.
#pragma once

#include "kernel/dem/batch.hpp"
#include "kernel/dem/ledger.hpp"
#include "kernel/dem/physics.hpp"

namespace millscope::dem {

struct BatchRun {
  const PairPhysics* physics;
  double time_step;
  std::int64_t count;
  bool per_contact;  ///< fill batch.power of each contact
};
void evaluate(const BatchRun& run, ContactArrays& batch, PairLedger& ledger);

/// Before that: books contacts, first touches and, in every 16th step, the largest overlap.
void book_contacts(std::int64_t step, std::int64_t count, const ContactArrays& batch, PairLedger& ledger);

}  // namespace millscope::dem
