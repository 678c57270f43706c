#include <cmath>
#include <nlohmann/json.hpp>

#include "studies/inspect/report.hpp"

namespace millscope::inspect {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json(const base::Interval90& e) { return {{"value", number(e.value)}, {"low", number(e.low)}, {"high", number(e.high)}}; }

Json json(const Finding& f) {
  Json j = f.estimate ? json(*f.estimate) : Json{{"value", nullptr}, {"low", nullptr}, {"high", nullptr}};
  j["bound"] = f.bound == Bound::both ? "both" : "at_least";
  j["note"] = f.note;
  return j;
}

Json json(const Coverage& c) {
  const recording::RunReport& r = c.report;
  return {{"runs", c.runs},
          {"points", c.points},
          {"span_s", c.span},
          {"covered_s", c.covered},
          {"rate_per_s", c.rate},
          {"median_pause_s", c.median_interval},
          {"gap_limit_s", c.gap_limit},
          {"gaps", r.gaps},
          {"gap_time_s", r.gap_time},
          {"longest_gap_s", c.longest_gap},
          {"rows", r.rows},
          {"rows_set_aside",
           {{"outliers", r.outliers},
            {"outside", r.outside},
            {"duplicates", r.duplicates},
            {"false_times", r.false_times},
            {"lost", r.lost},
            {"unreadable", r.unreadable},
            {"not_finite", r.not_finite}}},
          {"rows_out_of_order", r.backwards}};
}

Json json(const Rotor& r) {
  Json plateaus = Json::array();
  for (const Plateau& p : r.plateaus)
    plateaus.push_back({{"run", p.run}, {"start_s", p.start}, {"end_s", p.end}, {"angular_speed_rad_per_s", json(p.speed)}});
  return {{"radius_m", json(r.radius)}, {"centre_m", r.centre},       {"axis", r.axis},
          {"scatter_m", r.scatter},     {"share_on_circle", r.share}, {"plateaus", plateaus}};
}

Json json(const MillMotion& m) {
  return {{"sense", m.sense > 0   ? "counter-clockwise"
                    : m.sense < 0 ? "clockwise"
                                  : "unknown"},
          {"angular_speed_rad_per_s", json(m.speed)},
          {"axis_x_m", json(m.axis[0])},
          {"axis_y_m", json(m.axis[1])},
          {"path_radius_m", json(m.path_radius)},
          {"rides", m.rides},
          {"ride_time_s", m.ride_time},
          {"radial_scatter_m", m.radial_scatter}};
}

Json json(const Losses& l) {
  Json ranges = Json::array();
  for (const SpeedRange& r : l.ranges) {
    ranges.push_back({{"low_m_per_s", r.low},
                      {"high_m_per_s", number(r.high)},
                      {"time_s", r.time},
                      {"rate_per_s", json(r.rate)},
                      {"lost_fraction", json(r.lost)}});
  }
  return {{"lost_fraction", json(l.lost)},
          {"by_speed", ranges},
          {"unassigned_s", l.unassigned},
          {"missed_rising_fraction", json(l.missed_rising)},
          {"missed_falling_fraction", json(l.missed_falling)}};
}

Json json(const std::vector<Verdict>& verdicts) {
  Json list = Json::array();
  for (const Verdict& v : verdicts) {
    list.push_back({{"subject", v.subject},
                    {"support", v.support == Support::yes      ? "yes"
                                : v.support == Support::partly ? "partly"
                                                               : "no"},
                    {"reason", v.reason}});
  }
  return list;
}

}  // namespace

Json inspection_json(const Inspection& i) {
  Json j{{"file", i.file}, {"formats", i.formats}, {"interval", 0.9}, {"recording", json(i.coverage)}};
  j["noise"] = {{"x_m", json(i.noise[0])}, {"y_m", json(i.noise[1])}, {"z_m", json(i.noise[2])}};
  j["rotor"] = i.rotor ? json(*i.rotor) : Json(nullptr);
  if (!i.rotor) {
    const Circulations& c = i.circulations;
    j["mill"] = json(i.motion);
    j["mill"]["stated_angular_velocity_rad_per_s"] = i.stated.angular_velocity ? Json(*i.stated.angular_velocity) : Json(nullptr);
    j["mill"]["stated_angular_speed_rad_per_s"] = i.stated.speed ? Json(*i.stated.speed) : Json(nullptr);
    j["free_flight"] = {{"arcs", i.flight.arcs},
                        {"flights", i.flight.flights},
                        {"gravity_angle_degrees", json(i.flight.angle_degrees)},
                        {"gravity_axial_degrees", json(i.flight.axial_degrees)},
                        {"gravity_m_per_s2", json(i.flight.magnitude)}};
    j["circulations"] = {{"count", c.count},
                         {"least_height_m", c.least_height},
                         {"longest_pause_s", c.longest_pause},
                         {"time_s", json(c.time)},
                         {"per_turn", json(c.per_turn)}};
    j["mean_offset_m"] = json(i.mean_offset);
    j["axial"] = {{"low_m", i.axial.low}, {"high_m", i.axial.high}, {"share_by_tenths", i.axial.share}, {"traverses", i.axial.traverses}};
  }
  j["losses"] = json(i.losses);
  j["verdicts"] = json(i.verdicts);
  return j;
}

}  // namespace millscope::inspect
