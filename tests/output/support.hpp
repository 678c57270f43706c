// What the tests of the output room share.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernel/output/frames.hpp"
#include "tests/scratch.hpp"

namespace output_test {

using testing::refusal;
using testing::Scratch;

/// A file system of `bytes` on a scratch directory; `mounted` is false where that is not permitted.
class SmallDisk {
 public:
  explicit SmallDisk(std::size_t bytes);
  ~SmallDisk();
  Scratch scratch;
  bool mounted;
};

void spill(const std::filesystem::path& path, const std::string& text);

/// Beads that move with the frame's number: what a resumed file must repeat.
class Story {
 public:
  explicit Story(std::size_t beads, std::size_t walls = 2);
  millscope::output::BeadTable table() const;
  /// Frame k; valid until the next call.
  millscope::output::FrameView frame(int k);

 private:
  std::vector<std::uint32_t> id_, material_;
  std::vector<std::uint64_t> impacts_;
  std::vector<double> radius_, mass_, work_, position_, velocity_, spin_;
};

/// All values of a dataset as doubles, read by HDF5 alone, without any help of ours; throws when HDF5 refuses.
std::vector<double> read_all(const std::filesystem::path& file, const std::string& dataset);

}  // namespace output_test
