#include "studies/camera/ctrack_writer.hpp"

#include <fmt/format.h>

#include <iterator>

#include "kernel/config/units.hpp"

namespace millscope::studies {
namespace {

constexpr const char* kHeader = "\n\nSeparation=\n\nf(opt) :  0.500      \n\n\nFixed slices:    250 events/slice,    1 locations/slice\n\n";

}  // namespace

std::string ctrack_text(const Run& run) {
  std::string out = kHeader;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const double u = run.spread.empty() ? 0.0 : run.spread[i];
    const std::int64_t events = run.events.empty() ? 0 : run.events[i];
    fmt::format_to(std::back_inserter(out), "{:12.4f} {:9.3f} {:9.3f} {:9.3f} {:9.3f}{:10.1f}{:10.2f}{:5d}\n", 1e3 * run.time[i],
                   1e3 * run.position[0][i], 1e3 * run.position[1][i], 1e3 * run.position[2][i], 1e3 * u, 0.0, 0.0, events);
  }
  return out;
}

}  // namespace millscope::studies
