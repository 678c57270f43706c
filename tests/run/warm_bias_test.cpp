// Are runs that begin where others ended biased? 30 seeds of the mill of the story from rest and 30 from the ends of runs at other
// frictions and fillings, looked at in the same window.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "dem/support.hpp"
#include "kernel/base/text.hpp"
#include "kernel/output/frame_reader.hpp"
#include "kernel/run/simulation.hpp"
#include "millscope/random.hpp"
#include "tests/scratch.hpp"

using namespace dem_test;

namespace {

namespace fs = std::filesystem;

constexpr int kRuns = 30;
constexpr std::array kDevelop = {0.3, 0.5, 0.8};  // s before the window
constexpr double kPeriod = 34e-3, kHalf = 75e-3;  // m, of the mill of the story
constexpr int kCells = 25;                        // of 6 mm, along x and y

// Three standard errors: by chance one comparison of 370. Fisher's F of 29 and 29 degrees of freedom, and a correlation of 30 pairs: by
// chance one of 100 beyond these bounds.
constexpr double kErrors = 3, kLowF = 0.376, kHighF = 2.66, kCorrelation = 0.463;

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

/// Mean over beads and frames of a third of the variance of the velocity in its cell, m²/s²; and ⟨(z(t + 0.5 s) − z(t))²⟩, m².
std::pair<double, double> motion_of(const fs::path& run) {
  const output::FrameReader reader(run / "frames.h5");
  const std::size_t n = reader.beads().size(), frames = reader.frame_count(), lag = 100;  // frames of 5 ms
  std::vector<float> x(3 * n * frames), v(3 * n * frames);
  reader.read(output::BeadField::position, 0, frames, x);
  reader.read(output::BeadField::velocity, 0, frames, v);
  struct Cell {
    double count = 0, sum[3] = {}, squares = 0;
  };
  std::vector<Cell> cells(kCells * kCells);
  std::vector<double> z(n * frames);
  const auto cell_of = [](double along) { return std::clamp(static_cast<int>((along + kHalf) / (2 * kHalf) * kCells), 0, kCells - 1); };
  for (std::size_t i = 0; i < n * frames; ++i) {
    Cell& c = cells[cell_of(x[3 * i]) * kCells + cell_of(x[3 * i + 1])];
    ++c.count;
    for (std::size_t k = 0; k < 3; ++k) c.sum[k] += v[3 * i + k], c.squares += double{v[3 * i + k]} * v[3 * i + k];
    if (i < n) continue;
    const double step = x[3 * i + 2] - x[3 * (i - n) + 2];
    z[i] = z[i - n] + step - kPeriod * std::round(step / kPeriod);
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

Ran ran(const fs::path& out, std::vector<std::string> settings) {
  run::RunOptions options;
  options.output = out;
  options.quiet = true;
  options.threads = 1;
  options.overrides = std::move(settings);
  options.overrides.insert(options.overrides.end(), {"time.end_s=4", "time.analyze_from_s=1", "output={frames: {every_s: 0.005}}"});
  REQUIRE(run::run_case(std::string(MILLSCOPE_SOURCE_DIR) + "/configs/story/mill.yaml", registry(), options) == run::Outcome::finished);
  const nlohmann::json s = nlohmann::json::parse(base::text_of(out / "summary.json"));
  const auto [fluctuation, spread] = motion_of(out);
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

/// One line of the table for each quantity.
void compare(const std::string& label, const std::vector<Ran>& cold, const std::vector<Ran>& warm, const std::vector<Ran>& donors) {
  for (std::size_t q = 0; q < kQuantities.size(); ++q) {
    const Quantity& quantity = kQuantities[q];
    const Sample c = column(cold, q), w = column(warm, q), d = column(donors, q);
    const double scale = quantity.scale > 0 ? quantity.scale : 100 / std::fabs(mean(c));
    const double off = scale * (mean(w) - mean(c)), error = scale * std::sqrt((covariance(c, c) + covariance(w, w)) / kRuns);
    const double f = covariance(w, w) / covariance(c, c), r = covariance(w, d) / std::sqrt(covariance(w, w) * covariance(d, d));
    fmt::print("{:<28} {:<22} {:+7.3f} ± {:5.3f} {:<3} {:+5.1f} {:6.2f} {:+6.2f}\n", label, quantity.name, off, error, quantity.unit,
               off / error, f, r);
    INFO(label << ", " << quantity.name);
    CHECK(std::fabs(off) < kErrors * error);
    if (quantity.wanted > 0) CHECK(std::fabs(off) < std::max(quantity.wanted, 2 * error));
    CHECK((f > kLowF && f < kHighF));
    CHECK(std::fabs(r) < kCorrelation);
  }
}

}  // namespace

TEST_CASE("runs that begin where others ended, against runs from rest", "[.warm]") {
  const testing::Scratch folder;
  const char* stiffness = std::getenv("STIFFNESS");  // of the runs that are compared, not of the donors; default: as theirs
  const std::string own = stiffness ? fmt::format("stiffness_factor={}", stiffness) : "name=as it is";
  std::vector<Ran> cold, donors;
  std::map<double, std::vector<Ran>> warm;
  Random draw(28);
  for (int i = 0; i < kRuns; ++i) {
    const fs::path donor = folder / "donor";
    donors.push_back(
        ran(donor, {fmt::format("seed={}", 1000 + i), fmt::format("pairs.glass~glass.static_friction={:.3f}", draw.between(0.1, 0.6)),
                    fmt::format("pairs.glass~hdpe.static_friction={:.3f}", draw.between(0.15, 0.6)),
                    fmt::format("fill.filling={:.4f}", draw.between(0.34, 0.36))}));
    const std::string seed = fmt::format("seed={}", i + 1);
    cold.push_back(ran(folder / "cold", {seed, own}));
    for (const double develop : kDevelop)
      warm[develop].push_back(ran(folder / fmt::format("warm{}", develop),
                                  {seed, own, fmt::format("start={{run: {}, develop_s: {}}}", donor.string(), develop)}));
    fs::remove_all(folder.path);
    fs::create_directory(folder.path);
  }
  fmt::print("{:<28} {:<22} {:>19} {:>6} {:>6} {:>6}\n", "begins", "quantity", "warm less cold", "errors", "F", "r");
  for (const double develop : kDevelop)
    compare(fmt::format("{} s before ({:.3f} of steps)", develop, warm[develop][0].steps / cold[0].steps), cold, warm[develop], donors);
}
