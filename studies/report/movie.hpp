// The mill turning, for the page: bead positions of some frames, and the surfaces that they touch.
#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

#include "kernel/config/case.hpp"
#include "kernel/host/registry.hpp"
#include "kernel/output/frame_reader.hpp"

namespace millscope::report {

/// Bytes of positions and speeds before compression that a movie may have, unless the user wants another number.
inline constexpr std::uint64_t kMovieBytes = 6'000'000;

/// `movie` of the page: frames evenly chosen so that they stay within `bytes`, at least one. Where not even one frame of all beads does,
/// every k-th bead is shown and the rest counted in `beads_left_out`. null without a frame.
nlohmann::ordered_json movie_of(const output::FrameReader& frames, std::uint64_t bytes);

/// `liner` of the page: every geometry of the case that has triangles, at wall angle 0. Those that move otherwise than the mill turns
/// are drawn where they start; `notes` then says so.
nlohmann::ordered_json liner_of(const config::Case& c, const host::Registry& registry, nlohmann::ordered_json& notes);

}  // namespace millscope::report
