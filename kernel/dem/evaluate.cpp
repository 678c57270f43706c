// The order in which plugins act on a batch: pair parameters, interactions before, contact law, interactions after.
#include "kernel/dem/evaluate.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <type_traits>

#include "millscope/pack.hpp"

namespace millscope::dem {
namespace {

static_assert(kPadding == kLanes);
static_assert(std::extent_v<decltype(ContactArrays::power)> == kMaxChannels);

void fill(double* array, std::int64_t count, double value) { std::fill(array, array + count, value); }

InteractionBatch interaction_batch(const BatchRun& run, bool pre, std::int64_t padded, ContactArrays& b) {
  InteractionBatch r{};
  r.count = padded;
  r.time_step = run.time_step;
  r.overlap = b.overlap;
  for (int a = 0; a < 3; ++a) {
    r.normal[a] = b.normal[a];
    r.velocity[a] = b.velocity[a];
    r.spin_i[a] = b.spin_i[a];
    r.spin_j[a] = b.spin_j[a];
    r.moment_i[a] = b.moment_i[a];
    r.moment_j[a] = b.moment_j[a];
  }
  r.radius_i = b.radius_i;
  r.radius_j = b.radius_j;
  r.radius = b.radius;
  r.mass = b.mass;
  r.normal_force = pre ? nullptr : b.normal_force;
  r.normal_stiffness = pre ? nullptr : b.normal_stiffness;
  r.added_force = b.added_force;
  r.added_cap = b.added_cap;
  return r;
}

ContactBatch contact_batch(const BatchRun& run, std::int64_t padded, ContactArrays& b) {
  ContactBatch r{};
  r.count = padded;
  r.time_step = run.time_step;
  r.overlap = b.overlap;
  for (int a = 0; a < 3; ++a) {
    r.normal[a] = b.normal[a];
    r.velocity[a] = b.velocity[a];
    r.force[a] = b.force[a];
  }
  r.radius = b.radius;
  r.mass = b.mass;
  for (int h = 0; h < kMaxHistory; ++h) r.history[h] = b.history[h];
  return r;
}

/// Where the histories and channels of each interaction stand: after those of the law, in the order of the case.
struct Place {
  std::size_t history, channel;
};

void run_interactions(const BatchRun& run, bool pre, std::int64_t padded, ContactArrays& b, PairLedger& ledger) {
  Place at{run.physics->law.table->info.history_count, run.physics->law.table->info.channel_count};
  for (const InteractionReference& i : run.physics->interactions) {
    if (i.pre == pre) {
      InteractionBatch batch = interaction_batch(run, pre, padded, b);
      for (std::size_t h = 0; h < i.table->info.history_count; ++h) batch.history[h] = b.history[at.history + h];
      i.table->evaluate(i.self, &batch);
      ledger.elastic += batch.elastic_sum;
      for (std::size_t c = 0; c < i.table->info.channel_count; ++c) {
        ledger.dissipated[at.channel + c] += batch.power_sum[c] * run.time_step;
      }
    }
    at.history += i.table->info.history_count;
    at.channel += i.table->info.channel_count;
  }
}

/// What interactions press, on top of the law's own.
void add_to_law(std::int64_t padded, ContactArrays& b) {
  const double* __restrict added = b.added_force;
  double* __restrict normal_force = b.normal_force;
  for (std::int64_t k = 0; k < padded; ++k) normal_force[k] += added[k];
  for (int a = 0; a < 3; ++a) {
    const double* __restrict normal = b.normal[a];
    double* __restrict force = b.force[a];
    for (std::int64_t k = 0; k < padded; ++k) force[k] += added[k] * normal[k];
  }
}

void run_pair_parameters(const BatchRun& run, std::int64_t padded, ContactArrays& b, ContactBatch& contacts) {
  std::size_t history = run.physics->law.table->info.history_count;
  for (const InteractionReference& i : run.physics->interactions) history += i.table->info.history_count;
  for (const PairParameterReference& p : run.physics->pair_parameters) {
    PairParameterBatch batch{};
    batch.count = padded;
    batch.time_step = run.time_step;
    batch.overlap = b.overlap;
    for (int a = 0; a < 3; ++a) {
      batch.normal[a] = b.normal[a];
      batch.velocity[a] = b.velocity[a];
    }
    batch.radius = b.radius;
    batch.mass = b.mass;
    for (std::size_t h = 0; h < p.table->info.history_count; ++h) batch.history[h] = b.history[history + h];
    batch.restitution = b.restitution;
    batch.friction = b.friction;
    p.table->evaluate(p.self, &batch);
    if (p.gives_restitution) contacts.restitution = b.restitution;
    if (p.gives_friction) contacts.friction = b.friction;
    history += p.table->info.history_count;
  }
}

void count_collision(std::int64_t k, const ContactArrays& b, PairLedger& ledger) {
  const double closing = -(b.velocity[0][k] * b.normal[0][k] + b.velocity[1][k] * b.normal[1][k] + b.velocity[2][k] * b.normal[2][k]);
  if (closing <= 0) return;
  const double energy = 0.5 * b.mass[k] * closing * closing;
  ++ledger.collisions;
  ledger.impact_energy += energy;
  ledger.largest_closing_speed = std::max(ledger.largest_closing_speed, closing);
  ++ledger.spectrum[ImpactBins::bin(energy)];
}

/// Few contacts are fresh: eight flags are looked at together.
void count_collisions(std::int64_t count, const ContactArrays& b, PairLedger& ledger) {
  for (std::int64_t first = 0; first < count; first += 8) {
    std::uint64_t flags;
    std::memcpy(&flags, b.fresh + first, sizeof flags);  // the arrays are longer than what is in use
    if (flags == 0) continue;
    for (std::int64_t k = first, last = std::min(count, first + 8); k < last; ++k) {
      if (b.fresh[k]) count_collision(k, b, ledger);
    }
  }
}

void note_overlap(std::int64_t count, const ContactArrays& b, PairLedger& ledger) {
  for (std::int64_t k = 0; k < count; ++k) ledger.largest_overlap = std::max(ledger.largest_overlap, b.overlap[k] / b.radius[k]);
}

}  // namespace

void evaluate(const BatchRun& run, ContactArrays& b, PairLedger& ledger) {
  const std::int64_t padded = padded_count(run.count);
  assert(0 < run.count && padded <= kBatchStride);
  ContactBatch contacts = contact_batch(run, padded, b);
  if (!run.physics->pair_parameters.empty()) run_pair_parameters(run, padded, b, contacts);
  const bool pre = run.physics->has_pre(), post = run.physics->has_post();
  if (pre) {
    fill(b.added_force, padded, 0.0);
    fill(b.added_cap, padded, 0.0);
    run_interactions(run, true, padded, b, ledger);
    contacts.added_cap = b.added_cap;
  }
  if (pre || post) {
    contacts.normal_force = b.normal_force;
    contacts.normal_stiffness = b.normal_stiffness;
  }
  const ContactLawTable& law = *run.physics->law.table;
  if (run.per_contact) {
    for (std::size_t c = 0; c < law.info.channel_count; ++c) contacts.power[c] = b.power[c];
  }
  law.evaluate(run.physics->law.self, &contacts);
  ledger.elastic += contacts.elastic_sum;
  for (std::size_t c = 0; c < law.info.channel_count; ++c) ledger.dissipated[c] += contacts.power_sum[c] * run.time_step;
  if (pre) add_to_law(padded, b);
  if (post) {
    for (int a = 0; a < 3; ++a) {
      fill(b.moment_i[a], padded, 0.0);
      fill(b.moment_j[a], padded, 0.0);
    }
    run_interactions(run, false, padded, b, ledger);
  }
}

void book_contacts(std::int64_t step, std::int64_t count, const ContactArrays& b, PairLedger& ledger) {
  count_collisions(count, b, ledger);
  if (step % 16 == 0) note_overlap(count, b, ledger);
  ledger.contacts += count;
}

}  // namespace millscope::dem
