#include <cstring>

#include "kernel/base/error.hpp"
#include "kernel/dem/wide.hpp"

namespace millscope::dem {
namespace {

bool runs_v3() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"); }
bool runs_v4() {
  return runs_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd");
}

}  // namespace

const WideTable& wide_table(const char* wanted) {
  const bool v4 = runs_v4(), v3 = runs_v3();
  if (*wanted == '\0') return v4 ? wide_v4 : v3 ? wide_v3 : wide_v2;
  if (std::strcmp(wanted, "v2") == 0) return wide_v2;
  if (std::strcmp(wanted, "v3") == 0 && v3) return wide_v3;
  if (std::strcmp(wanted, "v4") == 0 && v4) return wide_v4;
  throw base::UserError(std::string("instruction set '") + wanted + "' is not one that this machine runs (v2" + (v3 ? ", v3" : "") +
                        (v4 ? ", v4" : "") + ")");
}

}  // namespace millscope::dem
