#include "studies/inspect/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millscope::inspect {
namespace {

constexpr double kRpm = 30 / std::numbers::pi;

/// A unit to print in: factor from SI, name, digits after the point.
struct Unit {
  double factor;
  const char* name;
  int digits;
};

constexpr Unit kMillimetre{1e3, "mm", 2}, kRevolutions{kRpm, "rpm", 2}, kDegree{1, "degrees", 1}, kSecond{1, "s", 3}, kPercent{100, "%", 0};

std::string line(const std::string& name, const std::string& value) { return fmt::format("  {:<26}{}\n", name, value); }

std::string text(const base::Interval90& e, const Unit& u) {
  const auto number = [&](double v) { return fmt::format("{:.{}f}", v * u.factor, u.digits); };
  if (!std::isfinite(e.high)) return fmt::format("{} {}, and at least {}", number(e.value), u.name, number(e.low));
  return fmt::format("{} {}  [{}, {}]", number(e.value), u.name, number(e.low), number(e.high));
}

std::string line(const std::string& name, const Finding& f, const Unit& u) {
  if (!f.estimate) return line(name, "cannot be said: " + f.note);
  return line(name, fmt::format("{:<34} {}", text(*f.estimate, u), f.note));
}

std::string coverage_text(const Coverage& c) {
  const recording::RunReport& r = c.report;
  std::string out = "\nRecording\n";
  out += line("runs", fmt::format("{}", c.runs));
  out += line("span", fmt::format("{:.1f} s", c.span));
  out += line("covered", fmt::format("{:.1f} s ({:.0f} %)", c.covered, c.span > 0 ? 100 * c.covered / c.span : 0));
  out += line("points used", fmt::format("{} of {} rows", c.points, r.rows));
  out += line("rate", fmt::format("{:.0f} per covered second, median pause {:.1f} ms", c.rate, c.median_interval * 1e3));
  out += line("gaps", fmt::format("{} longer than {:.0f} ms, {:.1f} s together, the longest {:.1f} s", r.gaps, c.gap_limit * 1e3,
                                  r.gap_time, c.longest_gap));
  out += line(
      "rows set aside",
      fmt::format("{} outliers, {} outside the mill, {} duplicate times, {} false times, {} of a lost bead, {} unreadable, {} not finite",
                  r.outliers, r.outside, r.duplicates, r.false_times, r.lost, r.unreadable, r.not_finite));
  out += line("rows out of order", fmt::format("{}", r.backwards));
  return out;
}

std::string noise_text(const Inspection& i) {
  std::string out;
  const char* names[] = {"noise of x", "noise of y", "noise of z"};
  for (std::size_t a = 0; a < 3; ++a) out += line(names[a], i.noise[a], kMillimetre);
  return out;
}

std::string rotor_text(const Rotor& r) {
  std::string out = "\nTracer on a rotor\n";
  out += line("radius", text(r.radius, kMillimetre));
  out += line("centre", fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", r.centre[0] * 1e3, r.centre[1] * 1e3, r.centre[2] * 1e3));
  out += line("axis", fmt::format("({:.3f}, {:.3f}, {:.3f})", r.axis[0], r.axis[1], r.axis[2]));
  out += line("scatter about the circle", fmt::format("{:.2f} mm; {:.1f} % of the points lie on it", r.scatter * 1e3, r.share * 100));
  for (const Plateau& p : r.plateaus) out += line(fmt::format("{:.0f} to {:.0f} s", p.start, p.end), text(p.speed, kRevolutions));
  if (r.plateaus.empty()) out += line("plateaus", "none: the speed is never steady for sixteen seconds");
  return out;
}

std::string stated_text(const recording::Condition& stated, const MillMotion& m) {
  const auto words = [](Agreement agreement) {
    switch (agreement) {
      case Agreement::within:
        return ", within the interval";
      case Agreement::outside:
        return ", outside the interval";
      case Agreement::far:
        return ", far outside the interval: check its unit";
      case Agreement::opposite:
        return ", the other way round: check the axes of recording.yaml, or its direction";
      case Agreement::unknown:
        break;
    }
    return "";
  };
  return fmt::format("{:.2f} rpm{}", *stated.speed * kRpm, words(compare_speed(stated, m)));
}

std::string motion_text(const Inspection& i) {
  const MillMotion& m = i.motion;
  std::string out = "\nMill, from the tracer alone\n";
  if (m.sense == 0) return out + line("sense, speed, axis", m.speed, kRevolutions);
  out += line("turning sense",
              m.sense > 0 ? "counter-clockwise, z towards the viewer (Omega > 0)" : "clockwise, z towards the viewer (Omega < 0)");
  out += line("speed", m.speed, kRevolutions);
  if (i.stated.speed) out += line("speed that is stated", stated_text(i.stated, m));
  out += line("axis x", m.axis[0], kMillimetre);
  out += line("axis y", m.axis[1], kMillimetre);
  out += line("radius of the path", m.path_radius, kMillimetre);
  if (m.radial_scatter > 0)
    out += line("scatter along rides", fmt::format("{:.2f} mm: the noise with its slow part, across the path", m.radial_scatter * 1e3));
  return out;
}

std::string flight_text(const FreeFlight& f) {
  std::string out = "\nFree flight\n";
  if (!f.magnitude.estimate) return out + line("gravity", f.magnitude, kDegree);
  out += line("gravity, from -y to +x", f.angle_degrees, kDegree);
  out += line("gravity, towards +z", f.axial_degrees, kDegree);
  out += line("gravity", f.magnitude, {1, "m/s2", 2});
  return out;
}

std::string circulation_text(const Inspection& i) {
  const Circulations& c = i.circulations;
  std::string out = "\nCirculations\n";
  out += line("whole ones", fmt::format("{} (rises and falls of {:.0f} mm or more, no pause above {:.0f} ms)", c.count,
                                        c.least_height * 1e3, c.longest_pause * 1e3));
  out += line("time of one", c.time, kSecond);
  out += line("per turn of the mill", c.per_turn, {1, "", 2});
  out += line("mean x beside the axis", i.mean_offset, kMillimetre);
  return out;
}

std::string losses_text(const Losses& l, bool tumbling) {
  std::string out = "\nLosses\n";
  out += line("locations lost", l.lost, kPercent);
  for (const SpeedRange& r : l.ranges) {
    const std::string name =
        std::isfinite(r.high) ? fmt::format("{:.2f} to {:.2f} m/s", r.low, r.high) : fmt::format("above {:.2f} m/s", r.low);
    const std::string lost =
        r.lost.high > 0 ? text({std::max(0.0, r.lost.value), std::max(0.0, r.lost.low), r.lost.high}, kPercent) : "none";
    out += line("  " + name, fmt::format("{:>5.0f} per s  lost {:<20} {:.1f} s", r.rate.value, lost, r.time));
  }
  out += line("pauses without a speed", fmt::format("{:.1f} s", l.unassigned));
  if (!tumbling) return out;
  out += line("rises missed", l.missed_rising, kPercent);
  out += line("falls missed", l.missed_falling, kPercent);
  return out;
}

std::string axial_text(const Axial& a) {
  std::string out = "\nAlong the axis\n", tenths;
  for (const double share : a.share) tenths += fmt::format(" {:.0f}", share * 100);
  out += line("z of the tracer", fmt::format("{:.1f} to {:.1f} mm (99 % of the covered time)", a.low * 1e3, a.high * 1e3));
  out += line("% of the time by tenths", tenths.substr(1));
  out += line("traverses", fmt::format("{} from one third to the opposite one", a.traverses));
  return out;
}

std::string verdict_text(const std::vector<Verdict>& verdicts) {
  std::string out = "\nWhat it supports\n";
  for (const Verdict& v : verdicts) {
    const char* word = v.support == Support::yes ? "yes" : v.support == Support::partly ? "partly" : "no";
    out += fmt::format("  {:<36}{:<8}{}\n", v.subject, word, v.reason);
  }
  return out;
}

}  // namespace

std::string inspection_text(const Inspection& i) {
  std::string out = i.file + "\n";
  for (const std::string& format : i.formats) out += fmt::format("read as {}\n", format);
  out += "(intervals in brackets hold with 90 %)\n";
  out += coverage_text(i.coverage) + noise_text(i);
  if (i.rotor) {
    out += rotor_text(*i.rotor);
  } else {
    out += motion_text(i) + flight_text(i.flight) + circulation_text(i);
  }
  out += losses_text(i.losses, !i.rotor);
  if (!i.rotor) out += axial_text(i.axial);
  return out + verdict_text(i.verdicts);
}

}  // namespace millscope::inspect
