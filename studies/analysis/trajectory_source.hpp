// Beads that are followed: tracers of a recording or of a simulation, one sample per frame at even times.
#pragma once

#include <functional>

#include "studies/analysis/source.hpp"

namespace millscope::analysis {

/// What is known of the mill's motion at a time.
struct ShellMotion {
  std::function<double(double)> omega;  ///< rad/s at a time in s; empty: unknown
  std::function<double(double)> phase;  ///< rad; empty: unknown
};

class TrajectorySource : public FrameSource {
 public:
  /// `context.has`, `largest_id`, `start` and `end` are set here. `exact`: positions without noise, so that no variance is given.
  /// Trajectories without a piece, all of whose samples were trimmed, are left out; throws base::UserError when none remains.
  TrajectorySource(std::vector<trajectory::Trajectory> trajectories, AnalyzerContext context, ShellMotion motion, bool exact,
                   std::string description);
  ~TrajectorySource() override;

  const AnalyzerContext& context() const override { return context_; }
  std::size_t chunk_count() const override { return chunks_.size(); }
  std::size_t stretch(std::size_t chunk) const override;
  std::unique_ptr<Scratch> make_scratch() const override;
  const FrameBlock& load(std::size_t chunk, Scratch& scratch) const override;
  std::string description() const override { return description_; }
  std::vector<std::string> notes() const override { return notes_; }
  double duration() const override;
  void cut(double duration, std::size_t most) override;
  std::vector<BasicSeries> survey() const override;
  void want(std::uint64_t) override {}

 private:
  struct Arrays;  ///< all samples of one trajectory side by side, a zero-weight sample before each chunk that goes on from another
  struct Chunk {
    std::size_t stretch, first, last;  ///< samples first … last − 1 of the stretch's arrays
    double duration;                   ///< s
    std::size_t location_first, location_last;
  };

  void tell_trimmed();
  void lay_out(std::size_t trajectory, std::size_t parts);

  std::vector<trajectory::Trajectory> trajectories_;
  AnalyzerContext context_;
  ShellMotion motion_;
  bool exact_;
  std::string description_;
  std::vector<std::string> notes_;
  std::vector<std::unique_ptr<Arrays>> arrays_;
  std::vector<Chunk> chunks_;
  std::vector<std::int64_t> first_;  ///< 0, 1, 2, …: one sample per frame
};

}  // namespace millscope::analysis
