#include "studies/recording/select.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

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
  Run turned = chosen(run, order);
  run.time = std::move(turned.time);
  run.position = std::move(turned.position);
  run.spread = std::move(turned.spread);
  run.events = std::move(turned.events);
}

Run chosen(const Run& run, const std::vector<std::size_t>& points) {
  const auto choose = [&](const auto& values) {
    std::decay_t<decltype(values)> out;
    if (values.empty()) return out;
    out.reserve(points.size());
    for (const std::size_t i : points) out.push_back(values[i]);
    return out;
  };
  Run out;
  out.time = choose(run.time);
  for (std::size_t axis = 0; axis < 3; ++axis) out.position[axis] = choose(run.position[axis]);
  out.spread = choose(run.spread);
  out.events = choose(run.events);
  return out;
}

}  // namespace millscope::recording
