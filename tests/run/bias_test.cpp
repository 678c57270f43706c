// Are short simulations biased? Those that begin where others ended: 60 seeds of the mill of the story from rest and 60 from the ends of
// runs at other frictions and fillings, looked at in the same window of two turns. Those that are looked at early: 60 seeds from rest,
// against the same runs later on; 30 seeds of a larger mill, too.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <tuple>

#include "dem/support.hpp"
#include "kernel/base/text.hpp"
#include "kernel/output/frame_reader.hpp"
#include "kernel/run/simulation.hpp"
#include "millscope/random.hpp"
#include "tests/scratch.hpp"

using namespace dem_test;

namespace {

namespace fs = std::filesystem;

constexpr std::array kSpeeds = {0.75, 0.6, 0.5};   // of the critical speed
constexpr std::array kDevelop = {0.5, 0.75, 1.0};  // turns before the window, from another's end
constexpr double kRest = 1.5, kTurns = 2;          // turns: before the window, from rest; of the window
constexpr int kCells = 25;                         // along x and y
constexpr double kFrame = 0.005, kLag = 0.5;       // s

/// A mill that short simulations are tried with, and how many seeds of it.
struct Mill {
  const char* file;
  const char* wall;               ///< pair of bead and wall
  double diameter, bead, period;  ///< m; period along z, 0: closed
  double low_filling, high_filling;
  std::size_t developed;  ///< which of kDevelop is the first to be tried
  int seeds;
  // Of as many seeds, by chance one of 100 beyond: Fisher's F, and a correlation of two quantities that do not depend on each other.
  double low_f, high_f, correlation;
};
constexpr Mill kStory{"configs/story/mill.yaml", "glass~hdpe", 0.15, 0.01, 0.034, 0.34, 0.36, 0, 60, 0.507, 1.97, 0.330};
constexpr Mill kLarge{"configs/mill10/case.yaml", "glass~liner", 0.3, 0.01, 0, 0.304, 0.322, 2, 30, 0.374, 2.67, 0.463};

constexpr double kErrors = 3;  // by chance one comparison of 250 (60 seeds) or 180 (30) differs by more

struct Quantity {
  const char* name;
  const char* unit;
  double scale;   ///< from SI; 0: told in % of itself
  double wanted;  ///< largest difference that is asked for, in the unit; 0: none
};
constexpr std::array kQuantities = {
    Quantity{"power", "%", 0, 0.3},        Quantity{"centre of mass x", "mm", 1e3, 0.2}, Quantity{"centre of mass y", "mm", 1e3, 0.2},
    Quantity{"kinetic energy", "%", 0, 0}, Quantity{"velocity fluctuation", "%", 0, 0},  Quantity{"axial spread", "%", 0, 0}};
using Shown = std::array<double, kQuantities.size()>;
using Sample = std::vector<double>;

/// Some frames of a run, in their order: x0 y0 z0 x1 … of every bead.
struct Film {
  std::size_t beads, frames;
  std::vector<float> x, v;  ///< m, m/s
};
Film film_of(const output::FrameReader& reader, std::size_t first, std::size_t frames) {
  const std::size_t n = reader.beads().size();
  Film film{n, frames, std::vector<float>(3 * n * frames), std::vector<float>(3 * n * frames)};
  reader.read(output::BeadField::position, first, frames, film.x);
  reader.read(output::BeadField::velocity, first, frames, film.v);
  return film;
}

/// Mean over beads and frames of a third of the variance of the velocity in its cell, m²/s²; and ⟨(z(t + 0.5 s) − z(t))²⟩, m².
std::pair<double, double> motion_in(const Mill& mill, const Film& film) {
  const auto& [n, frames, x, v] = film;
  const std::size_t lag = std::lround(kLag / kFrame);
  struct Cell {
    double count = 0, sum[3] = {}, squares = 0;
  };
  std::vector<Cell> cells(kCells * kCells);
  std::vector<double> z(n * frames);
  const auto cell_of = [&](double along) { return std::clamp(static_cast<int>((along / mill.diameter + 0.5) * kCells), 0, kCells - 1); };
  for (std::size_t i = 0; i < n * frames; ++i) {
    Cell& c = cells[cell_of(x[3 * i]) * kCells + cell_of(x[3 * i + 1])];
    ++c.count;
    for (std::size_t k = 0; k < 3; ++k) c.sum[k] += v[3 * i + k], c.squares += double{v[3 * i + k]} * v[3 * i + k];
    if (i < n) continue;
    const double step = x[3 * i + 2] - x[3 * (i - n) + 2];
    z[i] = z[i - n] + step - (mill.period > 0 ? mill.period * std::round(step / mill.period) : 0);
  }
  double fluctuation = 0, spread = 0;
  for (const Cell& c : cells) {
    if (c.count > 0) fluctuation += (c.squares - (c.sum[0] * c.sum[0] + c.sum[1] * c.sum[1] + c.sum[2] * c.sum[2]) / c.count) / 3;
  }
  for (std::size_t i = 0; i + lag * n < n * frames; ++i) spread += (z[i + lag * n] - z[i]) * (z[i + lag * n] - z[i]);
  return {fluctuation / static_cast<double>(n * frames), spread / static_cast<double>(n * (frames - lag))};
}

struct Ran {
  Shown shown;
  double steps;
};

/// A section of the test for each: `-c "75 %"` runs one alone.
void at_each_speed(void (*trial)(const Mill&, double), const Mill& mill) {
  for (const double fraction : kSpeeds) {
    DYNAMIC_SECTION(100 * fraction << " %") { trial(mill, fraction); }
  }
}

/// s, at a part of the critical speed
double turn_at(const Mill& mill, double fraction) {
  return 2 * std::numbers::pi / (fraction * std::sqrt(2 * kGravity / (mill.diameter - mill.bead)));
}

/// What is looked at, in turns since the start.
struct Window {
  double from, until;
};

/// Runs the mill as its study does.
void run_mill(const Mill& mill, const fs::path& out, double fraction, const Window& window, std::vector<std::string> settings) {
  const double turn = turn_at(mill, fraction);
  run::RunOptions options;
  options.output = out;
  options.quiet = true;
  options.threads = 1;
  options.overrides = std::move(settings);
  options.overrides.insert(
      options.overrides.end(),
      {fmt::format("mill.speed={} %critical", 100 * fraction), "time.step_fraction=22 %",
       fmt::format("time.analyze_from_s={}", window.from * turn), fmt::format("time.end_s={}", window.until * turn + kFrame),
       fmt::format("output={{frames: {{every_s: {}, from_s: {}}}}}", kFrame, window.from * turn)});
  REQUIRE(run::run_case(fmt::format("{}/{}", MILLSCOPE_SOURCE_DIR, mill.file), registry(), options) == run::Outcome::finished);
}

Ran ran(const Mill& mill, const fs::path& out, double fraction, std::vector<std::string> settings) {
  run_mill(mill, out, fraction, {kRest, kRest + kTurns}, std::move(settings));
  const nlohmann::json s = nlohmann::json::parse(base::text_of(out / "summary.json"));
  const output::FrameReader reader(out / "frames.h5");
  const auto [fluctuation, spread] = motion_in(mill, film_of(reader, 0, reader.frame_count()));
  fs::remove(out / "frames.h5");
  return {{s["power_W"]["com"], s["com_m"][0], s["com_m"][1], s["kinetic_energy_J"], fluctuation, spread}, s["steps"]};
}

double mean(const Sample& s) {
  double sum = 0;
  for (const double v : s) sum += v;
  return sum / static_cast<double>(s.size());
}

double covariance(const Sample& a, const Sample& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - mean(a)) * (b[i] - mean(b));
  return sum / static_cast<double>(a.size() - 1);
}

Sample column(const std::vector<Ran>& runs, std::size_t quantity) {
  Sample s;
  for (const Ran& r : runs) s.push_back(r.shown[quantity]);
  return s;
}

/// What one sample shows more than another, in the quantity's unit; Fisher's F of the two.
struct Difference {
  double off, error, f;
};

/// One line of the table.
void tell(const std::string& label, const Quantity& quantity, const Difference& d, const std::string& more = "") {
  fmt::print("{:<32} {:<22} {:+7.3f} ± {:5.3f} {:<3} {:+5.1f} {:6.2f}{}\n", label, quantity.name, d.off, d.error, quantity.unit,
             d.off / d.error, d.f, more);
}

void check(const Mill& mill, const std::string& label, const Quantity& quantity, const Difference& d) {
  INFO(label << ", " << quantity.name);
  CHECK(std::fabs(d.off) < kErrors * d.error);
  if (quantity.wanted > 0) CHECK(std::fabs(d.off) < std::max(quantity.wanted, 2 * d.error));
  CHECK((d.f > mill.low_f && d.f < mill.high_f));
}

void compare(const Mill& mill, const std::string& label, const std::vector<Ran>& cold, const std::vector<Ran>& warm,
             const std::vector<Ran>& donors) {
  for (std::size_t q = 0; q < kQuantities.size(); ++q) {
    const Quantity& quantity = kQuantities[q];
    const Sample c = column(cold, q), w = column(warm, q), d = column(donors, q);
    const double scale = quantity.scale > 0 ? quantity.scale : 100 / std::fabs(mean(c)),
                 r = covariance(w, d) / std::sqrt(covariance(w, w) * covariance(d, d));
    const Difference more{scale * (mean(w) - mean(c)), scale * std::sqrt((covariance(c, c) + covariance(w, w)) / mill.seeds),
                          covariance(w, w) / covariance(c, c)};
    tell(label, quantity, more, fmt::format(" {:+6.2f}", r));
    check(mill, label, quantity, more);
    INFO(label << ", " << quantity.name << ", r " << r);
    CHECK(std::fabs(r) < mill.correlation);
  }
}

void warm_against_cold(const Mill& mill, double fraction) {
  const std::vector<double> develop(kDevelop.begin() + mill.developed, kDevelop.end());
  fmt::print("{:<32} {:<22} {:>19} {:>6} {:>6} {:>6}\n", "turns before", "quantity", "warm less cold", "errors", "F", "r");
  const testing::Scratch folder;
  const char* stiffness = std::getenv("STIFFNESS");  // of the runs that are compared, not of the donors; default: as theirs
  const std::string own = stiffness ? fmt::format("stiffness_factor={}", stiffness) : "name=as it is";
  std::vector<Ran> cold, donors;
  std::map<double, std::vector<Ran>> warm;
  Random draw(28);
  for (int i = 0; i < mill.seeds; ++i) {
    const fs::path donor = folder / "donor";
    donors.push_back(ran(mill, donor, fraction,
                         {fmt::format("seed={}", 1000 + i), fmt::format("pairs.glass~glass.static_friction={:.3f}", draw.between(0.1, 0.6)),
                          fmt::format("pairs.{}.static_friction={:.3f}", mill.wall, draw.between(0.15, 0.6)),
                          fmt::format("fill.filling={:.4f}", draw.between(mill.low_filling, mill.high_filling))}));
    const std::string seed = fmt::format("seed={}", i + 1);
    cold.push_back(ran(mill, folder / "cold", fraction, {seed, own}));
    for (const double turns : develop) {
      const std::string start = fmt::format("start={{run: {}, develop_s: {}}}", donor.string(), turns * turn_at(mill, fraction));
      warm[turns].push_back(ran(mill, folder / fmt::format("warm{}", turns), fraction, {seed, own, start}));
    }
    fs::remove_all(folder.path);
    fs::create_directory(folder.path);
  }
  for (const double turns : develop)
    compare(mill, fmt::format("{} %, {} turns ({:.2f} of steps)", 100 * fraction, turns, warm[turns][0].steps / cold[0].steps), cold,
            warm[turns], donors);
}

}  // namespace

TEST_CASE("runs that begin where others ended, against runs from rest", "[.warm]") { at_each_speed(warm_against_cold, kStory); }

TEST_CASE("runs of a mill of 300 mm that begin where others ended, against runs from rest", "[.warm300]") {
  at_each_speed(warm_against_cold, kLarge);
}

namespace {

/// What is seen from one frame to another. Power: what the shell does.
Shown seen_in(const Mill& mill, const output::FrameReader& reader, std::size_t first, std::size_t frames) {
  const output::FrameScalars& scalars = reader.scalars();
  const std::size_t walls = scalars.wall_names.size(), last = first + frames - 1;
  const Film film = film_of(reader, first, frames);
  const std::size_t places = film.beads * frames;
  Shown shown{};
  for (std::size_t w = 0; w < walls; ++w) shown[0] += scalars.wall_work[last * walls + w] - scalars.wall_work[first * walls + w];
  shown[0] /= scalars.time[last] - scalars.time[first];
  for (std::size_t i = 0; i < places; ++i) {
    shown[1] += film.x[3 * i], shown[2] += film.x[3 * i + 1];
    for (std::size_t k = 0; k < 3; ++k) shown[3] += double{film.v[3 * i + k]} * film.v[3 * i + k];
  }
  for (std::size_t q = 1; q < 4; ++q) shown[q] /= static_cast<double>(places);
  std::tie(shown[4], shown[5]) = motion_in(mill, film);
  return shown;
}

constexpr std::array kFrom = {0.5, 1.0, kRest};  // turns before it, of the early ones
constexpr std::array kLate = {3.0, 5.0};         // of the late ones

/// Early windows [kFrom], then late ones [kLate], of a run from rest.
std::vector<Shown> windows_of(const Mill& mill, const fs::path& out, double fraction, int seed) {
  const double turn = turn_at(mill, fraction);
  run_mill(mill, out, fraction, {0, kLate.back() + kTurns}, {fmt::format("seed={}", seed)});
  const output::FrameReader reader(out / "frames.h5");
  const std::vector<double>& time = reader.scalars().time;
  const auto frame_at = [&](double turns) { return std::lower_bound(time.begin(), time.end(), turns * turn) - time.begin(); };
  std::vector<Shown> shown;
  const auto look = [&](double from) { shown.push_back(seen_in(mill, reader, frame_at(from), frame_at(from + kTurns) - frame_at(from))); };
  for (const double from : kFrom) look(from);
  for (const double from : kLate) look(from);
  return shown;
}

/// One line of the table for each quantity: what windows after `from` turns show more than the late ones of the same runs.
void compare_early(const Mill& mill, const std::string& label, const std::vector<std::vector<Shown>>& runs, std::size_t early) {
  const auto late_of = [&](const std::vector<Shown>& w, std::size_t q) { return 0.5 * (w[kFrom.size()][q] + w[kFrom.size() + 1][q]); };
  for (std::size_t q = 0; q < kQuantities.size(); ++q) {
    const Quantity& quantity = kQuantities[q];
    Sample first, late, more;
    for (const auto& w : runs) {
      first.push_back(w[early][q]), late.push_back(w[kFrom.size()][q]);
      more.push_back(w[early][q] - late_of(w, q));
    }
    const double scale = quantity.scale > 0 ? quantity.scale : 100 / std::fabs(mean(late));
    const Difference d{scale * mean(more), scale * std::sqrt(covariance(more, more) / mill.seeds),
                       covariance(first, first) / covariance(late, late)};
    tell(label, quantity, d);
    if (kFrom[early] >= kRest) check(mill, label, quantity, d);  // what comes before is known to be too early
  }
}

void early_against_late(const Mill& mill, double fraction) {
  const testing::Scratch folder;
  std::vector<std::vector<Shown>> runs;
  for (int seed = 1; seed <= mill.seeds; ++seed) {
    runs.push_back(windows_of(mill, folder / "run", fraction, seed));
    fs::remove_all(folder / "run");
  }
  for (std::size_t early = 0; early < kFrom.size(); ++early)
    compare_early(mill, fmt::format("{} %, after {} turns", 100 * fraction, kFrom[early]), runs, early);
}

}  // namespace

TEST_CASE("windows of two turns early in a run, against later ones", "[.window]") { at_each_speed(early_against_late, kStory); }

TEST_CASE("windows of two turns early in a run of a mill of 300 mm, against later ones", "[.window300]") {
  at_each_speed(early_against_late, kLarge);
}
