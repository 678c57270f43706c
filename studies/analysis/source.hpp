// Where an analyzer's blocks come from: the frames of a simulation, beads that are followed, or a recording.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "millscope/analyzer.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::studies {

/// The smallest piece of data that is loaded at once. The host adds consecutive chunks up to a block, the unit of resampling.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual const AnalyzerContext& context() const = 0;
  virtual std::size_t chunk_count() const = 0;
  /// Number of the unbroken stretch (span of a run, bead that is followed) to which a chunk belongs: no block crosses it.
  virtual std::size_t stretch(std::size_t chunk) const = 0;
  /// Fills a view of chunk i; the memory lives until the next call on the same `scratch`. May be called from several threads.
  struct Scratch {
    virtual ~Scratch() = default;
  };
  virtual std::unique_ptr<Scratch> make_scratch() const = 0;
  virtual const FrameBlock& load(std::size_t chunk, Scratch& scratch) const = 0;
  virtual std::string description() const = 0;  ///< for reports: file, beads, seconds
};

}  // namespace millscope::studies
