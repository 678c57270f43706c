#include "studies/picture/map_colors.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include "kernel/base/statistics.hpp"

namespace millscope::picture {
Color MapColors::operator()(double value) const {
  if (named) return distinct_color(std::lround(value) - 1);
  const double fraction = (value - low) / (high - low);
  return diverging ? diverging_color(fraction) : sequential_color(fraction);
}

MapColors choose_colors(const MapPicture& picture) {
  std::vector<double> values;
  std::copy_if(picture.value.values.begin(), picture.value.values.end(), std::back_inserter(values), [](double v) { return !is_blank(v); });
  MapColors colors;
  colors.named = !picture.names.empty();
  if (values.empty()) return colors;
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  colors.any = true;
  colors.smallest = *smallest, colors.largest = *largest;
  if (colors.named) {
    colors.low = 0.5, colors.high = static_cast<double>(picture.names.size()) - 0.5;
    return colors;
  }
  double low = base::quantile(values, 0.01), high = base::quantile(values, 0.99);
  const double span = std::max(high - low, 0.5 * std::max(std::abs(low), std::abs(high)));
  if (colors.largest - high < 0.3 * span) high = colors.largest;
  if (low - colors.smallest < 0.3 * span) low = colors.smallest;
  const double size = std::max(std::abs(low), std::abs(high));
  const bool both_signs = low < -0.05 * size && high > 0.05 * size;
  colors.diverging = picture.scale == ColorScale::diverging || (picture.scale == ColorScale::automatic && both_signs);
  if (colors.diverging) {
    low = -size, high = size;
  } else if (high > 0 && low < 0.5 * high) {
    low = 0;  // a scale from zero, unless that would waste more than half of it
  } else if (high < 0 && high > 0.5 * low) {
    high = 0;
  }
  if (!(high > low)) low -= 0.5 * size, high += 0.5 * size;
  colors.low = low, colors.high = high;
  return colors;
}

}  // namespace millscope::picture
