#include "bench/bed.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <numbers>

namespace millscope::bench {
namespace {

using base::UserError;

/// A text file that is there in full or not at all.
class TextFile {
 public:
  explicit TextFile(const std::string& name) : name_(name), file_(std::fopen((name + ".part").c_str(), "w"), &std::fclose) {
    if (!file_) throw UserError(fmt::format("{}: cannot be written", name));
  }
  template <class... T>
  void print(fmt::format_string<T...> format, T&&... values) {
    fmt::print(file_.get(), format, std::forward<T>(values)...);
  }
  void commit() {
    const bool good = std::fflush(file_.get()) == 0;
    file_.reset();
    if (!good || std::rename((name_ + ".part").c_str(), name_.c_str()) != 0) throw UserError(fmt::format("{}: cannot be written", name_));
  }

 private:
  std::string name_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// Greatest extent of the charge, for the box of LIGGGHTS.
double bound_of(const Bed& bed) {
  double greatest = 0;
  for (const Bed::Bead& b : bed.beads) greatest = std::max(greatest, std::hypot(b.position[0], b.position[1]));
  return greatest + 4 * bed.radius;
}

}  // namespace

Bed read_bed(const std::string& file) {
  std::ifstream in(file);
  std::string word;
  std::size_t count = 0;
  Bed bed;
  in >> word >> count >> bed.time >> bed.time_step >> bed.angle >> bed.omega >> bed.radius >> bed.density >> bed.period;
  if (!in || word != "millscope_bed") throw UserError(file + ": is no bed; make one with millscope_bench CASE --until 2 --save FILE");
  bed.beads.resize(count);
  for (Bed::Bead& b : bed.beads) {
    for (auto* v : {&b.position, &b.velocity, &b.spin}) {
      for (double& x : *v) in >> x;
    }
  }
  if (!in) throw UserError(file + ": is cut short; delete it and make it again");
  return bed;
}

void write_bed(const Bed& bed, const std::string& file) {
  TextFile out(file);
  out.print("millscope_bed {} {} {} {} {} {} {} {}\n", bed.beads.size(), bed.time, bed.time_step, bed.angle, bed.omega, bed.radius,
            bed.density, bed.period);
  for (const Bed::Bead& b : bed.beads) {
    out.print("{} {} {} {} {} {} {} {} {}\n", b.position[0], b.position[1], b.position[2], b.velocity[0], b.velocity[1], b.velocity[2],
              b.spin[0], b.spin[1], b.spin[2]);
  }
  out.commit();
}

void write_liggghts(const Bed& bed, const std::string& file) {
  TextFile out(file);
  const double bound = bound_of(bed);
  double low = 0, high = bed.period;
  if (bed.period == 0) {
    high = 0;
    for (const Bed::Bead& b : bed.beads) high = std::max(high, b.position[2]);
    low = -2 * bed.radius;
    high += 4 * bed.radius;
  }
  out.print("A developed bed\n\n{} atoms\n2 atom types\n\n", bed.beads.size());
  out.print("{0} {1} xlo xhi\n{0} {1} ylo yhi\n{2} {3} zlo zhi\n\nAtoms\n\n", -bound, bound, low, high);
  for (std::size_t i = 0; i < bed.beads.size(); ++i) {
    const auto& x = bed.beads[i].position;
    out.print("{} 1 {} {} {} {} {}\n", i + 1, 2 * bed.radius, bed.density, x[0], x[1], x[2]);
  }
  out.print("\nVelocities\n\n");
  for (std::size_t i = 0; i < bed.beads.size(); ++i) {
    const auto &v = bed.beads[i].velocity, &w = bed.beads[i].spin;
    out.print("{} {} {} {} {} {} {}\n", i + 1, v[0], v[1], v[2], w[0], w[1], w[2]);
  }
  out.commit();
}

Bed bed_of(const run::Assembly& a) {
  const dem::System& s = *a.system;
  Bed bed;
  bed.time = s.time();
  bed.time_step = a.time_step;
  for (const dem::Body& body : s.bodies) {
    if (body.motion.speed == 0) continue;
    bed.omega = body.motion.speed;
    bed.angle = dem::pose_at(body.motion, bed.time).angle;
  }
  bed.period = s.settings().periodic.length[2];
  bed.radius = s.particles.position.front().radius;
  bed.density = a.c.beads.front().density;
  bed.beads.resize(s.particles.position.size());
  for (std::size_t i = 0; i < bed.beads.size(); ++i) {
    const dem::PositionLine& x = s.particles.position[i];
    const dem::MotionLine& m = s.particles.motion[i];
    if (x.radius != bed.radius) throw UserError("millscope_bench compares codes with beads of one size; take a case with one");
    double z = x.centre[2];
    if (bed.period > 0) z -= bed.period * std::floor((z - s.settings().periodic_low[2]) / bed.period);
    bed.beads[i] = {{x.centre[0], x.centre[1], z}, {m.v[0], m.v[1], m.v[2]}, {m.w[0], m.w[1], m.w[2]}};
  }
  return bed;
}

void start_from(run::Assembly& a, const Bed& bed) {
  dem::Particles& p = a.system->particles;
  p.resize(bed.beads.size());
  const double mass = 4.0 / 3.0 * std::numbers::pi * bed.radius * bed.radius * bed.radius * bed.density;
  for (std::size_t i = 0; i < bed.beads.size(); ++i) {
    const Bed::Bead& b = bed.beads[i];
    p.position[i] = {b.position[0], b.position[1], b.position[2], bed.radius};
    p.motion[i] = {{b.velocity[0], b.velocity[1], b.velocity[2]},
                   1 / mass,
                   {b.spin[0], b.spin[1], b.spin[2]},
                   1 / (0.4 * mass * bed.radius * bed.radius)};
    p.half[i] = p.motion[i];
    p.force[i] = dem::ForceLine{};
    p.id[i] = static_cast<std::uint32_t>(i);
    p.material[i] = 0;
  }
  a.bead_count = bed.beads.size();
  a.system->start(std::llround(bed.time / a.time_step));
}

Bed replicated(const Bed& bed, int copies) {
  if (copies > 1 && !(bed.period > 0)) throw UserError("--replicate-z needs a bed that is periodic along z");
  Bed more = bed;
  for (int k = 1; k < copies; ++k) {
    for (Bed::Bead b : bed.beads) {
      b.position[2] += k * bed.period;
      more.beads.push_back(b);
    }
  }
  more.period = copies * bed.period;
  return more;
}

Bed between_ends(const Bed& bed, double low, double high) {
  Bed cut = bed;
  cut.period = 0;
  std::erase_if(cut.beads, [&](const Bed::Bead& b) { return b.position[2] < low + bed.radius || b.position[2] > high - bed.radius; });
  return cut;
}

}  // namespace millscope::bench
