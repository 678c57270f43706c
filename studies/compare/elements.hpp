// From a pair of results to elements that can be judged, with their resamples.
#pragma once

#include "kernel/base/mill_regions.hpp"
#include "studies/compare/compare.hpp"
#include "studies/compare/pair.hpp"

namespace millscope::compare {

/// A pair made ready; `tested` and `compared.elements` go together.
struct PreparedObservable {
  ComparedObservable compared;
  TestedObservable tested;
  std::size_t exact_differences = 0;  ///< values without uncertainty that differ
};

/// Takes the values that both have and that rest on enough blocks.
PreparedObservable prepare_observable(const analysis::ResultSet& a, const analysis::ResultSet& b, const ResultPair& pair);

/// Of a map across the mill: means over its regions, of the cells that are judged; without elements where there are none. Where a map
/// shows motion, cells count by the precision of their difference, so nearly by the time spent in them; otherwise all alike.
PreparedObservable prepare_regions(const analysis::ResultSet& a, const analysis::ResultSet& b, const ResultPair& pair);

/// "x −85 mm, y −62 mm (…)", "energy 1–2 mJ", "": where element `index` lies.
std::string where_text(const analysis::ResultSet& results, const analysis::ResultArray& array, std::size_t index,
                       const base::MillPlace& mill);

/// What the results say of the mill.
base::MillPlace mill_place(const analysis::ResultSet& results);

/// "x −85 mm, y −62 mm (0.70 R, 54° past 6 o'clock)"; the part in brackets only where the mill is known.
std::string place_text(double x, double y, const base::MillPlace& mill);

}  // namespace millscope::compare
