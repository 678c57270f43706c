#include "studies/analysis/results.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace millscope::analysis {

const ResultArray* ResultSet::find(const std::string& analyzer, const std::string& name) const {
  const auto found =
      std::find_if(arrays.begin(), arrays.end(), [&](const ResultArray& a) { return a.analyzer == analyzer && a.name == name; });
  return found == arrays.end() ? nullptr : &*found;
}

const ResultArray* ResultSet::axis(const ResultArray& array, std::size_t dimension) const {
  if (dimension >= array.axes.size() || array.axes[dimension].empty()) return nullptr;
  return find(array.analyzer, array.axes[dimension]);
}

std::string entry_name(const ResultSet& results, const CovarianceEntry& entry) {
  const ResultArray& array = results.arrays.at(entry.array);
  const std::string name = array.analyzer + "." + array.name;
  return array.shape.empty() ? name : fmt::format("{}[{}]", name, entry.element);
}

}  // namespace millscope::analysis
