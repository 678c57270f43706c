// Where an analyzer's blocks come from: the frames of a simulation, beads that are followed, or a recording.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "millscope/analyzer.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::analysis {

struct BasicSeries;  // times.hpp

/// The data in chunks, the smallest piece that is loaded at once. The host adds consecutive chunks up to a block, the unit of resampling.
///
/// Where a chunk goes on without a break from the one before, it begins with the last frame of that one, whose samples have weight 0: so
/// every change from one frame to the next lies within a chunk.
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
  virtual double duration() const = 0;          ///< s, of all stretches together
  /// What a reader of the results must know, one sentence each.
  virtual std::vector<std::string> notes() const { return {}; }

  /// Before anything is loaded: cuts each stretch into even chunks of at least `duration` (s) each, at most about `most` chunks in all. Ids
  /// of chunks change.
  virtual void cut(double duration, std::size_t most) = 0;
  /// A first look at the motion, one series per stretch, from which the length of blocks follows. Cheap beside loading everything.
  virtual std::vector<BasicSeries> survey() const = 0;
  /// Which fields of FrameField the analyzers use beyond those that are always there; others need not be loaded.
  virtual void want(std::uint64_t fields) = 0;
};

}  // namespace millscope::analysis
