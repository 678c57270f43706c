// Descriptor fields that the interactions have in common.
#pragma once

#include "millscope/interaction_adapter.hpp"

namespace millscope::interactions {

template <class I, std::size_t N, std::size_t M>
constexpr Descriptor interaction_descriptor(const char* name, const InteractionTable* table, const Parameter (&parameters)[N],
                                            const Hypothesis (&hypotheses)[M]) {
  Descriptor d = make_descriptor(Kind::interaction, kInteractionLayout, table, sizeof(InteractionTable));
  d.name = name;
  d.version = "1.0";
  d.features = kInteractionFeatures<I>;
  d.parameters = parameters;
  d.parameter_count = N;
  d.hypotheses = hypotheses;
  d.hypothesis_count = M;
  return d;
}

}  // namespace millscope::interactions
