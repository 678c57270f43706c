#include "kernel/dem/common.hpp"

#include <numeric>

namespace millscope::dem {

void Slabs::cut(const std::vector<std::uint32_t>& work) {
  const std::uint64_t total = std::accumulate(work.begin(), work.end(), std::uint64_t{0});
  std::uint64_t before = 0;
  int k = 0;
  for (std::int64_t i = 0; i < std::ssize(work); ++i) {
    for (; k <= count && before * count >= total * k; ++k) bounds[k] = i;
    before += work[i];
  }
  for (; k <= count; ++k) bounds[k] = std::ssize(work);
}

}  // namespace millscope::dem
