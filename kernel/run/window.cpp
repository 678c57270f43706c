#include "kernel/run/window.hpp"

#include <cmath>

#include "kernel/run/statistics.hpp"

namespace millscope::run {
namespace {

using Json = nlohmann::ordered_json;

// Halves of a window may differ by this much even when the noise is smaller: what a mill engineer would call steady.
constexpr double kSteadyTolerance = 0.01;

double power_of_centre(const Assembly& a, const Sample& s) { return power_of_centre(a, a.system->total_mass(), s.time, s.centre); }

}  // namespace

double power_of_centre(const Assembly& a, double mass, double time, const std::array<double, 3>& centre) {
  const std::optional<int> body = a.wall_body_of_mill();
  if (!body) return 0.0;
  const dem::Motion& m = a.system->bodies[*body].motion;
  const base::Vector3 r{centre[0] - m.point[0], centre[1] - m.point[1], centre[2] - m.point[2]};
  const double moment = base::dot(m.axis, base::cross(a.gravity, r));
  return mass * dem::angular_speed(m, time) * moment;
}

Sample take_sample(const dem::System& system, const Assembly& a) {
  Sample s;
  s.time = system.time();
  const dem::Ledger ledger = system.ledger();
  const dem::System::KineticEnergy kinetic = system.kinetic_energy();
  s.rotational = kinetic.rotational;
  s.translational = kinetic.translational;
  s.centre = system.centre_of_mass();
  const double mass = system.total_mass();
  for (std::size_t k = 0; k < 3; ++k) s.potential -= mass * a.gravity[k] * s.centre[k];
  for (const dem::PairLedger& p : ledger.pairs) {
    s.elastic += p.elastic;
    s.contacts += p.contacts;
    for (const double d : p.dissipated) s.dissipated += d;
  }
  for (const double w : ledger.body_force_work) s.dissipated += w;
  for (std::size_t b = 0; b < ledger.bodies.size(); ++b) {
    s.wall_work += ledger.bodies[b].work;
    const dem::Motion& motion = system.bodies[b].motion;
    if (motion.speed != 0) {
      s.torque_work += ledger.bodies[b].work;
      for (std::size_t k = 0; k < 3; ++k) s.torque += motion.axis[k] * ledger.bodies[b].torque[k];
    }
  }
  return s;
}

Json means_of(const Course& course) {
  Json j;
  j["window_s"] = {course.from, course.until};
  j["steady"] = true;
  const auto power = [&j](const std::string& by, const std::vector<double>& values) {
    if (values.empty()) return;
    const Mean mean = correlated_mean(values);
    const Steadiness steady = steadiness(values, kSteadyTolerance);
    if (!steady.steady) j["steady"] = false;
    j["steadiness"][by + "_power_drift_W"] = steady.drift;
    j["steadiness"][by + "_power_drift_standard_errors"] = steady.standard_errors;
    j["power_W"][by] = mean.value;
    j["power_W"][by + "_sem"] = mean.standard_error;
  };
  power("torque", course.torque);
  power("com", course.centre);
  for (const std::vector<double>& c : course.place) {
    const Mean m = c.empty() ? Mean{} : correlated_mean(c);
    j["com_m"].push_back(c.empty() ? Json() : Json(m.value));
    j["com_m_sem"].push_back(c.empty() ? Json() : Json(m.standard_error));
  }
  if (course.kinetic.empty()) return j;
  const Mean ke = correlated_mean(course.kinetic);
  j["kinetic_energy_J"] = ke.value;
  j["kinetic_energy_J_sem"] = ke.standard_error;
  return j;
}

Json window_summary(const Assembly& a, const std::vector<Sample>& samples) {
  Json j;
  if (samples.size() < 9) {
    j["steady"] = false;
    j["steady_reason"] = "the analysis window holds fewer than 9 samples of 1 ms: lengthen time.end_s or lower time.analyze_from_s";
    return j;
  }
  const Sample &first = samples.front(), &last = samples.back();
  Course course{first.time, last.time, {}, {}, {}};
  std::vector<double> dissipation;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& s = samples[i];
    course.centre.push_back(power_of_centre(a, s));
    course.kinetic.push_back(s.translational + s.rotational);
    for (std::size_t k = 0; k < 3; ++k) course.place[k].push_back(s.centre[k]);
    if (i == 0) continue;
    const double dt = s.time - samples[i - 1].time;
    course.torque.push_back((s.torque_work - samples[i - 1].torque_work) / dt);
    dissipation.push_back((s.dissipated - samples[i - 1].dissipated) / dt);
  }
  j = means_of(course);
  const Mean pd = correlated_mean(dissipation);
  j["power_W"].update({{"dissipation", pd.value}, {"dissipation_sem", pd.standard_error}});
  const auto stored = [](const Sample& s) { return s.translational + s.rotational + s.elastic + s.potential; };
  const double input = last.wall_work - first.wall_work, lost = last.dissipated - first.dissipated, kept = stored(last) - stored(first);
  j["energy"] = {{"wall_work_J", input},
                 {"dissipated_J", lost},
                 {"stored_change_J", kept},
                 {"imbalance_J", input - lost - kept},
                 {"imbalance_fraction", std::abs(input) > 0 ? (input - lost - kept) / std::abs(input) : 0.0},
                 {"elastic_J", last.elastic},
                 {"mean_power_span_s", last.time - first.time}};
  return j;
}

std::vector<std::string> series_columns(const Assembly& a) {
  (void)a;
  return {"time_s",
          "translational_energy_J",
          "rotational_energy_J",
          "elastic_energy_J",
          "potential_energy_J",
          "wall_work_J",
          "dissipated_J",
          "torque_N_m",
          "power_torque_W",
          "power_com_W",
          "com_x_m",
          "com_y_m",
          "com_z_m",
          "contacts"};
}

std::vector<double> series_row(const Sample& s, const Assembly& a, double power) {
  return {s.time,   s.translational, s.rotational,          s.elastic,   s.potential, s.wall_work, s.dissipated,
          s.torque, power,           power_of_centre(a, s), s.centre[0], s.centre[1], s.centre[2], static_cast<double>(s.contacts)};
}

Json collision_summary(const Assembly& a, const dem::Ledger& now, const dem::Ledger& before, double seconds) {
  Json list = Json::array();
  const auto& physics = a.system->physics();
  const auto& channels = a.system->layout().channels;
  for (std::size_t p = 0; p < physics.size(); ++p) {
    const dem::PairLedger &n = now.pairs[p], &b = before.pairs[p];
    Json j;
    j["pair"] = physics[p].name;
    j["collisions_per_s"] = static_cast<double>(n.collisions - b.collisions) / seconds;
    j["impact_energy_W"] = (n.impact_energy - b.impact_energy) / seconds;
    j["largest_closing_speed_m_per_s"] = n.largest_closing_speed;
    j["largest_overlap_of_effective_radius"] = n.largest_overlap;
    Json power;
    for (std::size_t c = 0; c < channels.size(); ++c) power[channels[c]] = (n.dissipated[c] - b.dissipated[c]) / seconds;
    j["dissipation_W"] = power;
    for (std::size_t w = 0; w < n.worn.size(); ++w) j["worn_m3_per_s"][physics[p].wear[w].name] = n.worn[w] / seconds;
    Json edges = Json::array(), counts = Json::array();
    int low = dem::ImpactBins::kCount, high = -1;
    for (int k = 0; k < dem::ImpactBins::kCount; ++k) {
      if (n.spectrum[k] - b.spectrum[k] > 0) {
        low = std::min(low, k);
        high = k;
      }
    }
    for (int k = low; k <= high; ++k) {
      edges.push_back(dem::ImpactBins::lower_edge(k));
      counts.push_back(n.spectrum[k] - b.spectrum[k]);
    }
    j["impact_spectrum"] = {{"lower_edge_J", edges}, {"count", counts}};
    list.push_back(j);
  }
  return list;
}

}  // namespace millscope::run
