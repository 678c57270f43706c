// How the charge circulates, how it spreads along the axis, and how long it remembers.
//
//   φ                  angle of a bead about the centre of circulation, in the turning sense
//   rate             = Σ Δφ/2π / Σ Δt                            circulations per second; unbiased by gaps and blocks
//   S(t)             = Π (1 − completed_i/at risk_i)             share of circulations longer than t (Kaplan & Meier 1958)
//   axial dispersion   ⟨(z(t + l) − z(t))²⟩ = 2 D l + offset     offset: noise, and what ends within short lags
//   correlation time τ = ∫ (1 − l/L) ρ dl,  N_eff = T/(2 τ)      independent samples in T seconds of beads' time; L: longest lag seen
//
// The centre is the option's, or that of the mean flow in the block itself; blocks without one are left out of the circulations, and their
// time is told. Gaps and the ends of blocks cut circulations: those count as unfinished in S(t), which corrects for them as long as the
// blocks are longer than a circulation.
#include <numbers>
#include <optional>

#include "analyzers/circulation/statistics.hpp"
#include "analyzers/common/centre.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

constexpr Parameter kParameters[] = {
    optional(number_parameter("centre_x", "m", kRequired, -kUnbounded, kUnbounded,
                              "Centre of circulation, with centre_y; without them that of each block's mean flow.")),
    optional(number_parameter("centre_y", "m", kRequired, -kUnbounded, kUnbounded, "Its height.")),
    integer_parameter("beads", 500, 1, 1e9, "At most about this many beads are followed, evenly by id."),
    number_parameter("step", "s", 0.02, 1e-4, 10, "Step of lags and correlations."),
    number_parameter("longest_lag", "s", 8, 1e-3, 1e4, "Longest lag."),
    number_parameter("time_bin", "s", 0.02, 1e-4, 10, "Width of the bins of circulation time."),
    number_parameter("longest_time", "s", 8, 1e-2, 1e4, "Longer circulations count as unfinished there."),
    number_parameter("dispersion_from", "s", 0.5, 0, 1e4, "Shortest lag of the line that gives the axial dispersion."),
    number_parameter("dispersion_to", "s", 2, 0, 1e4, "Longest lag of that line."),
};

enum Array { kCompleted, kUnfinished, kSpread, kCorrelation, kTotals, kArrays };
enum Total { kAngle, kFollowed, kLeftOut, kCoarse, kTime, kCentreX, kCentreY, kTotalCount };
constexpr const char* kSignalNames[kSignals] = {"x", "speed", "axial_velocity", "z"};

class Circulation {
 public:
  static constexpr std::uint64_t kNeeds = kHasVelocity;

  Circulation(const Parameters& p, const AnalyzerContext& context)
      : radius_(shell_radius(context)),
        sense_(known_sense(context)),
        omega_(std::fabs(context.omega)),
        period_(context.is_periodic != 0 ? context.mill_high - context.mill_low : 0),
        length_(context.is_periodic != 0 ? 0 : context.mill_high - context.mill_low),
        stride_(even_stride(context.largest_id, p.integer("beads"))),
        step_(p.number("step")),
        lags_(static_cast<std::int64_t>(std::floor(p.number("longest_lag") / step_ + 1e-9)) + 1),
        spread_lags_(spread_lags(lags_ - 1)),
        times_(0, p.number("longest_time"), static_cast<std::int64_t>(std::ceil(p.number("longest_time") / p.number("time_bin") - 1e-9))),
        from_(p.number("dispersion_from")),
        to_(p.number("dispersion_to")) {
    if (p.given("centre_x") != p.given("centre_y")) throw Refusal("centre_x and centre_y belong together: give both or neither");
    if (p.given("centre_x")) centre_ = Centre{p.number("centre_x"), p.number("centre_y"), 0};
    if (lags_ < 2) throw Refusal("longest_lag is shorter than step: no lags are left");
    if (!(to_ > from_)) throw Refusal("dispersion_to must be longer than dispersion_from");
  }

  std::vector<ArrayInfo> arrays() const {
    const auto bins = static_cast<std::uint64_t>(times_.count) + 1, lags = static_cast<std::uint64_t>(lags_);
    return {additive("completed", "1", {bins}), additive("unfinished", "1", {bins}),
            additive("spread", "mixed", {spread_lags_.size(), kSpreadMoments}),
            additive("correlation", "mixed", {kSignals, lags, kCorrelationMoments}), additive("totals", "mixed", {kTotalCount})};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    const std::optional<Centre> centre = centre_ ? centre_ : block_centre(block);
    Series series;
    for_each_track(block, stride_, [&](const Track& track) {
      const double span = track.time(track.size() - 1) - track.time(0);
      sums[kTotals][kTime] += span;
      if (centre) {
        add_circulations(follow(block, track, sense_, centre->x, centre->y), span, sums);
        sums[kTotals][kCentreX] += span * centre->x;
        sums[kTotals][kCentreY] += span * centre->y;
      } else {
        sums[kTotals][kLeftOut] += span;
      }
      if (track.size() < 2 || span > 1.5 * step_ * static_cast<double>(track.size() - 1)) {
        sums[kTotals][kCoarse] += span;
        return;
      }
      resample(block, track, step_, period_, series);
      add_spread(series[kSignalZ], spread_lags_, sums[kSpread]);
      for (std::int64_t signal = 0; signal < kSignals; ++signal) {
        add_correlation(element(series, signal), lags_, sums[kCorrelation] + kCorrelationMoments * lags_ * signal);
      }
    });
  }

  void finish(const double* const* sums, Results& results) const {
    add_rates(results, sums);
    add_times(results, sums);
    add_axial(results, sums[kSpread]);
    add_correlations(results, sums);
  }

 private:
  std::optional<Centre> block_centre(const FrameBlock& block) const {
    constexpr std::int64_t kCells = 54;
    constexpr double kHalf = 1.08;  // of the radius
    const Bins cells(-kHalf * radius_, kHalf * radius_, kCells);
    std::vector<double> map(3 * kCells * kCells, 0.0);
    for (std::int64_t s = block.first[0]; s < block.first[block.frame_count]; ++s) {
      const std::optional<std::int64_t> cell = cell_at(cells, block.position[0][s], block.position[1][s]);
      if (!cell || !(block.weight[s] > 0)) continue;
      double* sum = map.data() + 3 * *cell;
      sum[0] += block.weight[s];
      sum[1] += block.weight[s] * block.velocity[0][s];
      sum[2] += block.weight[s] * block.velocity[1][s];
    }
    return find_centre(FlowMap{cells, map.data(), 3, radius_, sense_});
  }

  void add_circulations(const Circulations& found, double span, double* const* sums) const {
    sums[kTotals][kAngle] += found.angle;
    sums[kTotals][kFollowed] += span;
    for (const double time : found.completed) {
      const std::optional<std::int64_t> bin = times_.at(time);
      sums[bin ? kCompleted : kUnfinished][bin.value_or(times_.count)] += 1;
    }
    if (found.unfinished) sums[kUnfinished][times_.at(*found.unfinished).value_or(times_.count)] += 1;
  }

  void add_rates(Results& results, const double* const* sums) const {
    const double* totals = sums[kTotals];
    const double rate = ratio(totals[kAngle] / (2 * std::numbers::pi), totals[kFollowed]);
    results.add("circulation_rate", "1/s", rate, "Turns about the centre of circulation per second.");
    results.add("circulations_per_turn", "1", rate * 2 * std::numbers::pi / omega_, "Circulations per turn of the mill.");
    results.add("mean_circulation_time", "s", rate > 0 ? 1 / rate : kNaN, "One over the rate; unbiased by gaps and the length of blocks.");
    results.add("circulation_centre_x", "m", ratio(totals[kCentreX], totals[kFollowed]),
                "Mean over the blocks of the centre that was used.", kOdd);
    results.add("circulation_centre_y", "m", ratio(totals[kCentreY], totals[kFollowed]), "Its height.");
    results.add("followed_fraction", "1", ratio(totals[kFollowed], totals[kTime]),
                "Fraction of the followed beads' time in blocks that have a centre of circulation; the rest is left out of circulations.",
                kBookkeeping | kShare);
  }

  void add_times(Results& results, const double* const* sums) const {
    const auto bins = as_size(times_.count);
    double completed = 0, unfinished = 0;
    for (std::size_t i = 0; i <= bins; ++i) completed += sums[kCompleted][i], unfinished += sums[kUnfinished][i];
    results.add("circulations_completed", "1", completed, "Circulations seen from passage to passage.", kBookkeeping | kNotNegative);
    results.add("unfinished_fraction", "1", ratio(unfinished, completed + unfinished),
                "Circulations that a gap or the end of a block cut, or longer than longest_time, of all that were seen to begin.",
                kBookkeeping | kShare);
    const std::vector<double> share = survival(sums[kCompleted], sums[kUnfinished], bins);
    std::vector<double> density(bins);
    for (std::size_t i = 0; i < bins; ++i) density[i] = (share[i] - share[i + 1]) / times_.width();
    results.add("circulation_time_edges", "s", times_.edges().data(), {bins + 1}, "Edges of the bins of circulation time.");
    results.add("circulation_time_survival", "1", share.data(), {bins + 1}, "Share of circulations that last longer than each edge.",
                {"circulation_time_edges"}, kShare);
    results.add("circulation_time_density", "1/s", density.data(), {bins},
                "Density of circulation times, corrected for the unfinished ones.", {"circulation_time_edges"});
    results.add("circulation_time_median", "s", survival_quantile(share, times_, 0.5), "Half of the circulations are shorter.");
    results.add("circulation_time_short", "s", survival_quantile(share, times_, 0.1), "A tenth of the circulations are shorter.");
    results.add("circulation_time_long", "s", survival_quantile(share, times_, 0.9),
                "A tenth of the circulations are longer; NaN where the blocks are too short to tell.");
  }

  void add_axial(Results& results, const double* sums) const {
    const Spread spread = find_spread(spread_lags_, step_, sums, from_, to_);
    const auto n = static_cast<std::uint64_t>(spread.lag.size());
    results.add("axial_lag", "s", spread.lag.data(), {n}, "Lags of the axial spread.");
    results.add("axial_square_displacement", "m^2", spread.msd.data(), {n}, "Mean square displacement along the axis.", {"axial_lag"});
    results.add("axial_dispersion", "m^2/s", spread.dispersion,
                "D of msd = 2 D lag + offset; NaN where blocks are shorter than the lags. End faces that are near make it too small.");
    results.add("axial_offset", "m^2", spread.offset, "Offset of that line: twice the variance of the measurement, and fast motion.");
    if (length_ > 0) {
      results.add("axial_mixing_time", "s", length_ * length_ / (std::numbers::pi * std::numbers::pi * spread.dispersion),
                  "Time in which a bead forgets where along the axis it was: L^2/(pi^2 D).");
    }
  }

  void add_correlations(Results& results, const double* const* sums) const {
    std::vector<double> lag(as_size(lags_));
    for (std::size_t i = 0; i < lag.size(); ++i) lag[i] = static_cast<double>(i) * step_;
    results.add("lag", "s", lag.data(), {lag.size()}, "Lags of the correlations.");
    const double time = sums[kTotals][kTime] - sums[kTotals][kCoarse];
    for (std::int64_t signal = 0; signal < kSignals; ++signal) {
      const std::string name = kSignalNames[signal];
      const std::vector<double> rho = correlation(sums[kCorrelation] + kCorrelationMoments * lags_ * signal, lags_);
      const double tau = correlation_time(rho, step_);
      results.add((name + "_correlation").c_str(), "1", rho.data(), {rho.size()},
                  ("Correlation of a bead's " + name + " with itself.").c_str(), {"lag"});
      results.add(
          (name + "_correlation_time").c_str(), "s", tau,
          ("Integral correlation time of a bead's " + name + " over the longest lag seen; NaN where a sixth of that is shorter.").c_str(),
          kBookkeeping);
      results.add((name + "_independent_samples").c_str(), "1", tau > 0 ? time / (2 * tau) : kNaN,
                  ("Independent samples of " + name + " in the followed beads' time, T/(2 tau); NaN where tau may be 0.").c_str(),
                  kBookkeeping | kNotNegative);
    }
    results.add("correlated_time", "s", time,
                "Time of beads that went into spread and correlations; frames farther apart than step do not.",
                kBookkeeping | kNotNegative);
  }

  double radius_, sense_, omega_, period_, length_;
  std::int64_t stride_;
  double step_;
  std::int64_t lags_;
  std::vector<std::int64_t> spread_lags_;
  Bins times_;
  double from_, to_;
  std::optional<Centre> centre_;
};

constexpr Descriptor kDescriptor = describe<Circulation>({
    .name = "circulation",
    .version = "0.1.0",
    .doc = "Circulation times, circulations per turn, axial dispersion, correlation times and independent samples.",
    .equation = "rate = sum dphi/2pi / sum dt; <dz^2> = 2 D lag + offset; tau = int (1 - lag/L) rho dlag; N_eff = T/(2 tau)",
    .citation = "Kaplan & Meier 1958, J. Am. Stat. Assoc. 53; Priestley 1981, Spectral Analysis and Time Series",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
