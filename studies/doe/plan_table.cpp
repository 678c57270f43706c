#include "studies/doe/plan_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "kernel/base/error.hpp"

namespace millscope::doe {
namespace {

double number(const std::string& text, const std::string& whole) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw base::UserError(fmt::format("--factor '{}': '{}' is no number; write NAME=LOW:HIGH, e.g. friction=0.2:0.4", whole, text));
  }
  return value;
}

}  // namespace

Factor parse_factor(const std::string& text) {
  const std::size_t equals = text.find('='), colon = text.find(':', equals);
  if (equals == std::string::npos || colon == std::string::npos) {
    throw base::UserError(fmt::format("--factor '{}': write NAME=LOW:HIGH, e.g. friction=0.2:0.4", text));
  }
  const double low = number(text.substr(equals + 1, colon - equals - 1), text), high = number(text.substr(colon + 1), text);
  if (low >= high) throw base::UserError(fmt::format("--factor '{}': the high level must lie above the low one", text));
  return {text.substr(0, equals), (low + high) / 2, (high - low) / 2, ""};
}

std::string plan_table(const Design& design) {
  std::string text;
  if (!design.resolution.empty()) text += fmt::format("# resolution: {}\n", design.resolution);
  if (!design.aliases.empty()) text += fmt::format("# aliases, up to two factors: {}\n", fmt::join(design.aliases, "; "));
  text += "run,kind";
  for (const Factor& f : design.factors) text += "," + f.name;
  text += "\n";
  for (Eigen::Index run = 0; run < design.coded.rows(); ++run) {
    text += fmt::format("{},{}", run + 1, design.kind[run]);
    for (const double value : natural(design.factors, design.coded.row(run).transpose())) text += fmt::format(",{:.10g}", value);
    text += "\n";
  }
  return text;
}

}  // namespace millscope::doe
