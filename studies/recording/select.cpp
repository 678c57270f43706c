#include "studies/recording/select.hpp"

#include <algorithm>
#include <cmath>

namespace millscope::recording {
namespace {

template <class Change>
void for_each_array(Run& run, Change change) {
  change(run.time);
  for (auto& component : run.position) change(component);
  change(run.spread);
  change(run.events);
}

}  // namespace

std::uint64_t keep_only(Run& run, const std::vector<char>& keep) {
  const auto gone = static_cast<std::uint64_t>(std::count(keep.begin(), keep.end(), 0));
  run.report.used = keep.size() - gone;
  if (gone == 0) return 0;
  for_each_array(run, [&](auto& values) {
    if (values.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < keep.size(); ++i) {
      if (keep[i] != 0) values[kept++] = values[i];
    }
    values.resize(kept);
  });
  return gone;
}

double distance(const Run& run, std::size_t i, std::size_t j) {
  return std::hypot(run.position[0][j] - run.position[0][i], run.position[1][j] - run.position[1][i],
                    run.position[2][j] - run.position[2][i]);
}

void reorder(Run& run, const std::vector<std::size_t>& order) {
  for_each_array(run, [&](auto& values) {
    if (values.empty()) return;
    auto old = values;
    values.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) values[i] = old[order[i]];
  });
}

}  // namespace millscope::recording
