// All beads of a simulation, from frames.h5.
#pragma once

#include <optional>

#include "kernel/output/frame_reader.hpp"
#include "studies/analysis/source.hpp"

namespace millscope::analysis {

class FramesSource : public FrameSource {
 public:
  /// Frames with from ≤ time ≤ to, s. `context`: `has`, `largest_id`, `omega`, `start`, `end` and what follows from the beads (mass, count,
  /// mean radius and density) are set here. Throws base::UserError when no frame is left.
  FramesSource(output::FrameReader reader, AnalyzerContext context, std::optional<double> from, std::optional<double> to);

  const AnalyzerContext& context() const override { return context_; }
  std::size_t chunk_count() const override { return chunks_.size(); }
  std::size_t stretch(std::size_t) const override { return 0; }
  std::unique_ptr<Scratch> make_scratch() const override;
  const FrameBlock& load(std::size_t chunk, Scratch& scratch) const override;
  std::string description() const override;
  double duration() const override;
  void cut(double duration, std::size_t most) override;
  std::vector<BasicSeries> survey() const override;
  void want(std::uint64_t fields) override;
  std::vector<std::string> notes() const override;

 private:
  struct Chunk {
    std::size_t first, last;  ///< frames first … last − 1
    bool goes_on;             ///< begins with frame first − 1, of no weight
  };
  struct Buffers;

  void select(std::optional<double> from, std::optional<double> to);
  void weigh();
  void know_beads();
  bool knows(output::BeadField field) const;
  void lay_out(Buffers& buffers, std::size_t frames) const;
  void know_who(Buffers& buffers, std::size_t frames) const;
  void leave_out(Buffers& buffers, std::size_t frames) const;
  void fill(Buffers& buffers, std::size_t first, std::size_t last, bool goes_on) const;
  const FrameBlock& view(Buffers& buffers, std::size_t first, std::size_t last) const;

  output::FrameReader reader_;
  AnalyzerContext context_;
  std::size_t begin_ = 0, end_ = 0;  ///< frames that are analysed
  std::vector<double> share_;        ///< s of each frame of the file
  std::vector<std::int32_t> piece_;  ///< of each frame of the file
  std::vector<double> wall_work_;    ///< of all bodies together, of each frame of the file, J; empty: unknown
  std::vector<const char*> channels_, pairs_;
  std::vector<Chunk> chunks_;
};

}  // namespace millscope::analysis
