// The folder of pictures for ParaView: beads and walls at each instant.
#pragma once

#include <filesystem>
#include <optional>

#include "kernel/output/vtk.hpp"
#include "kernel/run/assembly.hpp"

namespace millscope::run {

class Pictures {
 public:
  /// `resume_time`: pictures of an interrupted run, those later than it dropped; nothing: a fresh folder.
  explicit Pictures(const std::filesystem::path& folder, std::optional<double> resume_time = {});

  /// beads_NUMBER.vtp, and BODY_NUMBER.vtp for each body with a surface, at `time`, s. `worked`: whose impacts and shear each triangle
  /// has felt; null: not known.
  void add(const Assembly& a, double time, std::int64_t number, const output::BeadPicture& beads, const dem::System* worked = nullptr);

 private:
  std::filesystem::path folder_;
  output::PictureSeries beads_, walls_;
};

}  // namespace millscope::run
