// Does one bead, followed long, tell the same as the whole charge? The comparison of Chagas 2015 and a test (fluctuation.hpp).
//
//   power of bead j           P_j = M g ⟨s x⟩_j |Ω|,   s = sign Ω
//   variance of a time mean   Var(f̄ over T) = A/T,     A = Ω_f(t) t for late t
//   time for an error e       T = A_x/(e ⟨s x⟩)²       of the power from one bead
//   map cell                  relative variance of a cell's occupancy after T: Σ d²/(Σ d)² · T_seen/T · inflation;  d: length of a visit
//
// `inflation` is how much more the occupancy of coarse cells (a tenth of the mill's diameter) differs between beads than chance visits
// would make it: a bead that stays on its streamline for a while visits the same cells again.
#include <array>
#include <numbers>
#include <optional>

#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"
#include "analyzers/common/tracks.hpp"
#include "analyzers/ergodicity/fluctuation.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

constexpr std::int64_t kCoarse = 10;

constexpr Parameter kParameters[] = {
    integer_parameter("beads", 200, 8, 100000, "About this many beads are averaged one by one, evenly by id."),
    integer_parameter("windows", 48, 8, 10000, "Windows into which the analysed time is cut."),
    integer_parameter("singles", 3, 1, 50, "So many beads are shown with maps and distributions of their own; Chagas 2015 shows three."),
    integer_parameter("cells", 50, 5, 500, "Cells of the maps along x and along y, from shell to shell."),
};

/// `kVisited` and `kVisitedCoarse` hold time, visits and squared length of visits of the followed beads.
enum Array { kWindows, kMoments, kMap, kSingleMaps, kVisited, kVisitedCoarse, kBeadCoarse, kArrays };
enum Quantity { kX, kSpeed, kDepth, kQuantities };
enum Visit { kVisitTime, kVisits, kVisitSquare, kVisitMoments };
constexpr const char* kNames[kQuantities] = {"x", "speed", "depth"};
constexpr const char* kSquareUnits[kQuantities] = {"m^2", "m^2/s^2", "m^2"};

class Ergodicity {
 public:
  static constexpr std::uint64_t kNeeds = kHasVelocity | kHasAllBeads;

  Ergodicity(const Parameters& p, const AnalyzerContext& context)
      : context_(context),
        sense_(known_sense(context)),
        windows_(p.integer("windows")),
        stride_(even_stride(context.largest_id, p.integer("beads"))),
        beads_(context.largest_id / stride_ + 1),
        singles_(std::min(p.integer("singles"), beads_)),
        cells_(-shell_radius(context), shell_radius(context), p.integer("cells")),
        coarse_(-shell_radius(context), shell_radius(context), kCoarse) {
    if (!(context.end > context.start)) throw Refusal("the analysed span is empty");
  }

  std::vector<ArrayInfo> arrays() const {
    const auto w = static_cast<std::uint64_t>(windows_), b = static_cast<std::uint64_t>(beads_), s = static_cast<std::uint64_t>(singles_);
    const auto n = static_cast<std::uint64_t>(cells_.count);
    return {additive("windows", "mixed", {w, b, kQuantities + 1}),
            additive("moments", "mixed", {kQuantities, 3}),
            additive("map", "s", {n, n}),
            additive("single_maps", "s", {s, n, n}),
            additive("visited", "mixed", {n, n, kVisitMoments}),
            additive("visited_coarse", "mixed", {kCoarse, kCoarse, kVisitMoments}),
            additive("bead_coarse", "s", {b, kCoarse * kCoarse})};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    const double per_window = static_cast<double>(windows_) / (context_.end - context_.start);
    for (std::int64_t f = 0; f < block.frame_count; ++f) {
      const auto place = static_cast<std::int64_t>(std::floor((block.time[f] - context_.start) * per_window));
      const std::int64_t window = std::clamp<std::int64_t>(place, 0, windows_ - 1);
      for (std::int64_t s = block.first[f]; s < block.first[f + 1]; ++s) add_sample(block, s, window, sums);
    }
    for_each_track(block, stride_, [&](const Track& track) {
      add_visits(block, track, cells_, sums[kVisited]);
      add_visits(block, track, coarse_, sums[kVisitedCoarse]);
    });
  }

  void finish(const double* const* sums, Results& results) const {
    std::array<Fluctuation, kQuantities> found;
    for (std::int64_t q = 0; q < kQuantities; ++q) element(found, q) = fluctuation(sums, q);
    double verdict = 1;
    for (const Fluctuation& f : found) verdict = std::fmin(verdict, f.verdict);
    const bool lasting = verdict < 0;
    add_verdict(results, verdict, found[kX].elapsed);
    for (std::size_t q = 0; q < kQuantities; ++q) add_fluctuation(results, kNames[q], kSquareUnits[q], found[q]);
    add_power(results, sums, found[kX], lasting);
    add_maps(results, sums);
    add_cell_times(results, sums);
  }

 private:
  void add_sample(const FrameBlock& block, std::int64_t s, std::int64_t window, double* const* sums) const {
    const double x = block.position[0][s], y = block.position[1][s], w = block.weight[s];
    const double u = block.velocity[0][s], v = block.velocity[1][s], axial = block.velocity[2][s];
    const double f[kQuantities] = {sense_ * x, std::sqrt(u * u + v * v + axial * axial), std::sqrt(x * x + y * y)};
    for (std::int64_t q = 0; q < kQuantities; ++q) {
      double* moment = sums[kMoments] + 3 * q;
      moment[0] += w;
      moment[1] += w * f[q];
      moment[2] += w * f[q] * f[q];
    }
    const std::optional<std::int64_t> fine = cell_at(cells_, x, y);
    if (fine) sums[kMap][*fine] += w;
    if (block.id[s] % stride_ != 0) return;
    const std::int64_t bead = block.id[s] / stride_;
    const std::optional<std::int64_t> coarse = cell_at(coarse_, x, y), single = single_of(bead);
    double* sum = sums[kWindows] + (window * beads_ + bead) * (kQuantities + 1);
    sum[0] += w;
    for (std::int64_t q = 0; q < kQuantities; ++q) sum[q + 1] += w * f[q];
    if (coarse) sums[kBeadCoarse][bead * kCoarse * kCoarse + *coarse] += w;
    if (fine && single) sums[kSingleMaps][*single * cells_.count * cells_.count + *fine] += w;
  }

  /// Number of the single bead, if it is one. Singles are spread evenly over the followed beads.
  std::optional<std::int64_t> single_of(std::int64_t bead) const {
    const std::int64_t every = beads_ / singles_;
    if (bead % every != 0 || bead / every >= singles_) return std::nullopt;
    return bead / every;
  }

  static void add_visits(const FrameBlock& block, const Track& track, const Bins& bins, double* sums) {
    std::optional<std::int64_t> here;
    double dwell = 0;
    const auto leave = [&] {
      if (!here || !(dwell > 0)) return;
      double* sum = sums + kVisitMoments * *here;
      sum[kVisitTime] += dwell;
      sum[kVisits] += 1;
      sum[kVisitSquare] += dwell * dwell;
    };
    for (const TrackPoint& point : track.points) {
      const std::optional<std::int64_t> now = cell_at(bins, block.position[0][point.sample], block.position[1][point.sample]);
      if (now != here) {
        leave();
        here = now;
        dwell = 0;
      }
      dwell += block.weight[point.sample];
    }
    leave();
  }

  Fluctuation fluctuation(const double* const* sums, std::int64_t q) const {
    const double* moment = sums[kMoments] + 3 * q;
    const double mean = ratio(moment[1], moment[0]), variance = ratio(moment[2], moment[0]) - mean * mean;
    return find_fluctuation({sums[kWindows], sums[kWindows] + 1 + q, windows_, beads_, kQuantities + 1}, variance,
                            2 * std::numbers::pi / std::fabs(context_.omega));
  }

  static void add_verdict(Results& results, double verdict, const std::vector<double>& elapsed) {
    results.add(
        "verdict", "1", verdict,
        "1: ergodic within the data; -1: not, beads keep what sets them apart; 0: the data cannot tell. The least of x, speed, depth.",
        kBookkeeping);
    results.add("elapsed", "s", elapsed.data(), {elapsed.size()}, "Time over which the beads' averages are taken.");
  }

  static void add_fluctuation(Results& results, const std::string& name, const char* unit, const Fluctuation& f) {
    const auto add = [&](const char* what, const char* of_what, double value, const char* doc, std::uint32_t traits) {
      results.add((name + what).c_str(), of_what, value, doc, traits);
    };
    results.add((name + "_fluctuation").c_str(), unit, f.metric.data(), {f.metric.size()},
                ("Variance between beads of their time averages of " + name + " (Thirumalai & Mountain 1993).").c_str(), {"elapsed"},
                kSpread | kNotNegative);
    add("_verdict", "1", f.verdict, "1: ergodic within the data, -1: not, 0: cannot tell.", kBookkeeping);
    add("_exponent", "1", f.exponent, "Decay of the fluctuation: 1 as 1/t, 0 level.", kSpread | kBookkeeping);
    add("_persistent", "1", f.persistent,
        "Share of the last fluctuation that beads had from the first third to the last third of the time.", kSpread | kBookkeeping);
    add("_persistent_error", "1", f.persistent_error, "Its standard error if nothing persists.", kSpread | kBookkeeping | kNotNegative);
    add("_diffusion", "1/s", f.diffusion, "D of fluctuation(0)/fluctuation(t) = D t; 1/(2 D) is the correlation time.", kSpread);
    add("_distance", "1", f.distance,
        "Distance of single beads to all, in units of a bead's own noise, rms over beads; about 1: their noise explains it.",
        kSpread | kBookkeeping);
  }

  void add_power(Results& results, const double* const* sums, const Fluctuation& x, bool lasting) const {
    const double arm = ratio(sums[kMoments][1], sums[kMoments][0]);
    const WindowSums windows{sums[kWindows], sums[kWindows] + 1 + kX, windows_, beads_, kQuantities + 1};
    const std::vector<double> means = bead_means(windows, 0, windows_);
    const double between = std::sqrt(covariance(means, means));
    const double seconds = x.elapsed.back();
    results.add("single_power_error", "1", between / arm,
                "Standard deviation of the power from single beads over the analysed time, of the power.",
                kSpread | kBookkeeping | kNotNegative);
    // The 1/t law does not hold where beads keep what sets them apart.
    const double rate = lasting ? kNaN : x.rate;
    results.add("time_for_power_1_percent", "s", rate / std::pow(0.01 * arm, 2),
                "Time to follow one bead for a power within 1 % (standard error); NaN when not ergodic.", kSpread);
    results.add("time_for_power_2_percent", "s", rate / std::pow(0.02 * arm, 2), "The same for 2 %.", kSpread);
    results.add("time_for_power_5_percent", "s", rate / std::pow(0.05 * arm, 2), "The same for 5 %.", kSpread);
    results.add("power_error_in_an_hour", "1", std::sqrt(rate / 3600) / arm,
                "Standard error of the power from one bead followed for an hour.", kSpread);
    results.add("time_per_bead", "s", seconds, "Mean time over which each bead was followed.", kBookkeeping | kNotNegative);
    const double per_arm = context_.charge_mass * context_.gravity * std::fabs(context_.omega);
    if (!(per_arm > 0)) return;
    std::vector<double> single(as_size(singles_), kNaN);
    for (std::int64_t bead = 0; bead < beads_; ++bead) {
      if (const auto number = single_of(bead)) element(single, *number) = per_arm * element(means, bead);
    }
    results.add("power_all", "W", per_arm * arm, "M g <x> |Omega| of the whole charge.");
    results.add("power_single", "W", single.data(), {single.size()}, "The same from each of the single beads.");
  }

  void add_maps(Results& results, const double* const* sums) const {
    const std::int64_t n = cells_.count;
    const auto size = as_size(n * n), s = as_size(singles_), side = as_size(n);
    std::vector<double> all(sums[kMap], sums[kMap] + size), single(sums[kSingleMaps], sums[kSingleMaps] + size * s);
    normalise(all.data(), size);
    for (std::size_t i = 0; i < s; ++i) normalise(single.data() + i * size, size);
    results.add("x_edges", "m", cells_.edges().data(), {side + 1}, "Edges of the cells along x.", {}, kAlongX);
    results.add("y_edges", "m", cells_.edges().data(), {side + 1}, "Edges of the cells along y.");
    results.add("occupancy_all", "1", all.data(), {side, side}, "Fraction of the time of all beads in each cell.", {"y_edges", "x_edges"},
                kShare);
    results.add("occupancy_single", "1", single.data(), {s, side, side}, "The same of each single bead.", {nullptr, "y_edges", "x_edges"},
                kShare);
    for (const bool along_x : {true, false}) {
      const std::string name = along_x ? "x" : "y", edges = name + "_edges";
      const std::vector<double> reference = marginal(all.data(), along_x);
      std::vector<double> alone, off;
      for (std::size_t i = 0; i < s; ++i) {
        const std::vector<double> one = marginal(single.data() + i * size, along_x);
        double square = 0;
        for (std::size_t k = 0; k < side; ++k) square += (one[k] - reference[k]) * (one[k] - reference[k]);
        off.push_back(std::sqrt(square / static_cast<double>(n)));
        alone.insert(alone.end(), one.begin(), one.end());
      }
      results.add((name + "_percent_all").c_str(), "%", reference.data(), {side},
                  ("Percent of all beads' time along " + name + ".").c_str(), {edges.c_str()}, kShare);
      results.add((name + "_percent_single").c_str(), "%", alone.data(), {s, side}, "The same of each single bead.",
                  {nullptr, edges.c_str()}, kShare);
      results.add((name + "_percent_difference").c_str(), "%", off.data(), {s}, "Rms over the bins of the difference of the two.", {},
                  kSpread | kBookkeeping | kNotNegative);
    }
  }

  static void normalise(double* values, std::size_t size) {
    double sum = 0;
    for (std::size_t i = 0; i < size; ++i) sum += values[i];
    for (std::size_t i = 0; i < size; ++i) values[i] = ratio(values[i], sum);
  }

  std::vector<double> marginal(const double* map, bool along_x) const {
    const auto n = as_size(cells_.count);
    std::vector<double> percent(n, 0.0);
    for (std::size_t iy = 0; iy < n; ++iy) {
      for (std::size_t ix = 0; ix < n; ++ix) percent[along_x ? ix : iy] += 100 * map[iy * n + ix];
    }
    return percent;
  }

  /// Between-bead variance of the coarse cells' occupancy over what chance visits of the same lengths would give.
  double inflation(const double* const* sums) const {
    constexpr std::size_t kCells = kCoarse * kCoarse;
    std::vector<double> time(as_size(beads_), 0.0);
    double all = 0, per_bead = 0;
    for (std::size_t bead = 0; bead < time.size(); ++bead) {
      for (std::size_t c = 0; c < kCells; ++c) time[bead] += sums[kBeadCoarse][bead * kCells + c];
      all += time[bead];
      if (time[bead] > 0) per_bead += 1 / time[bead];
    }
    double seen = 0, chance = 0;
    for (std::size_t c = 0; c < kCells; ++c) {
      std::vector<double> share(time.size());
      for (std::size_t bead = 0; bead < time.size(); ++bead) share[bead] = ratio(sums[kBeadCoarse][bead * kCells + c], time[bead]);
      const double between = covariance(share, share);
      if (std::isnan(between)) return kNaN;
      seen += between;
      chance += ratio(sums[kVisitedCoarse][c * kVisitMoments + kVisitSquare], all) * per_bead / static_cast<double>(beads_);
    }
    return ratio(seen, chance);
  }

  void add_cell_times(Results& results, const double* const* sums) const {
    constexpr double kError = 0.1;
    const auto n = as_size(cells_.count);
    const double factor = inflation(sums);
    std::vector<double> needed(n * n, kNaN);
    double all = 0, weighted = 0, weight = 0;
    for (std::size_t c = 0; c < n * n; ++c) all += sums[kVisited][c * kVisitMoments + kVisitTime];
    for (std::size_t c = 0; c < n * n; ++c) {
      const double* cell = sums[kVisited] + c * kVisitMoments;
      if (!(cell[kVisitTime] > 0)) continue;
      needed[c] = cell[kVisitSquare] / (cell[kVisitTime] * cell[kVisitTime]) * all * factor / (kError * kError);
      weighted += cell[kVisitTime] / needed[c];
      weight += cell[kVisitTime];
    }
    results.add("revisit_inflation", "1", factor, "How much more coarse cells differ between beads than chance visits would make them.",
                kSpread);
    results.add("cell_time_10_percent", "s", needed.data(), {n, n}, "Time to follow one bead until a cell's occupancy is within 10 %.",
                {"y_edges", "x_edges"}, kSpread);
    results.add("typical_cell_time_10_percent", "s", ratio(weight, weighted),
                "The same for a typical cell: harmonic mean, weighted by occupancy.", kSpread);
  }

  AnalyzerContext context_;
  double sense_;
  std::int64_t windows_, stride_, beads_, singles_;
  Bins cells_, coarse_;
};

constexpr Descriptor kDescriptor = describe<Ergodicity>({
    .name = "ergodicity",
    .version = "0.1.0",
    .doc = "Single beads against the whole charge: power, distributions, maps, a test, and how long a recording must be.",
    .equation = "Omega_f(t) = 1/(N-1) sum_j (f_j(t) - <f>(t))^2; Omega_f(0)/Omega_f(t) -> D t",
    .citation = "Thirumalai & Mountain 1993, Physical Review E 47; Chagas 2015",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
