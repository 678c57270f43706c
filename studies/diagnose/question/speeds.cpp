// A recorded mill turns as it did, whatever is thought to be in it.
#include <fmt/format.h>

#include <cmath>

#include "kernel/config/units.hpp"
#include "studies/diagnose/question/question.hpp"

namespace millscope::diagnose {
namespace {

bool in_percent_of_critical(const config::Node& speed) {
  static const config::Dimension critical = config::parse_unit("%critical").dimension;
  if (!speed.is_scalar() || speed.text() == "mill") return false;
  const config::Quantity said = config::read_quantity(speed);
  return said.has_unit && said.unit.dimension == critical;
}

}  // namespace

std::vector<std::string> speeds_settled(const config::Case& c) {
  std::vector<std::string> out;
  if (!c.mill) return out;  // there is no critical speed
  if (in_percent_of_critical(c.root.at("mill").at("speed"))) out.push_back(fmt::format("mill.speed={} rad/s", std::fabs(c.mill->speed)));
  for (const config::GeometryCase& g : c.geometry) {
    if (!g.motion.rotation || g.motion.rotation->follows_mill) continue;
    if (in_percent_of_critical(g.plugin.node.at("motion").at("rotation").at("speed")))
      out.push_back(fmt::format("geometry.{}.motion.rotation.speed={} rad/s", g.plugin.name, g.motion.rotation->speed));
  }
  return out;
}

}  // namespace millscope::diagnose
