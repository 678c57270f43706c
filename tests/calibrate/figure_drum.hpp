// A drum of which a figure was measured, and what a simulation of it leaves.
#pragma once

#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "kernel/output/frames.hpp"
#include "studies/calibrate/figure.hpp"
#include "tests/calibrate/made_up_mill.hpp"
#include "tests/plugins.hpp"

namespace testing {

inline constexpr double kDrumRadius = 0.1;  ///< m, of drum_case

/// study.yaml with one condition, whose recording is `recording`; `more`: further sections.
struct FigureDrum {
  Folder folder;
  millscope::calibrate::Study study;

  explicit FigureDrum(const std::string& recording, const std::string& more = "") {
    folder.write("drum.yaml", drum_case(10, 1));
    folder.write("r.yaml", recording);
    study = millscope::calibrate::read_study(folder.write("study.yaml",
                                                          "base: drum.yaml\nconditions: {dry: {recording: r.yaml, role: fit}}\n"
                                                          "parameters: {pairs.glass~glass.static_friction: {range: [0.1, 0.8]}}\n" +
                                                              more));
  }
  std::unique_ptr<const millscope::calibrate::Figure> figure() const {
    return millscope::calibrate::read_figure(study.conditions[0].recording);
  }
  millscope::calibrate::RecordedCondition look() const {
    return millscope::calibrate::look_at_figure(*figure(), 0, {study, registry(), 1});
  }
  /// What the run in `folder` shows of it.
  millscope::calibrate::Observation seen(const millscope::calibrate::RecordedCondition& r) const {
    return millscope::calibrate::summarise(millscope::calibrate::figure_of_run(folder.path, r, {study, registry(), 1}), r.summaries);
  }
};

/// Beads that stay where they are, though they have velocities: x, y, z of each.
struct FrozenBeads {
  std::vector<double> position, velocity;
  double radius;
  double omega = 2;  ///< of the drum
  int frames = 6;
};

/// The case and the frames of a run.
inline void write_run(const Folder& folder, const FrozenBeads& beads) {
  folder.write("case.resolved.yaml", drum_case(10, 1));
  const std::size_t n = beads.position.size() / 3;
  std::vector<std::uint32_t> id(n), material(n, 0);
  std::iota(id.begin(), id.end(), 0U);
  const std::vector<double> radius(n, beads.radius), mass(n, 1e-4), spin(3 * n, 0.0), work{0.0};
  auto writer = millscope::output::FrameWriter::create(folder.path / "frames.h5", {id, radius, mass, material, {"glass"}, {"shell"}, {}});
  for (int f = 0; f < beads.frames; ++f)
    writer.append({0.01 * f, beads.omega * 0.01 * f, beads.omega, work, {}, {}, beads.position, beads.velocity, spin});
  writer.close();
}

}  // namespace testing
