// Where the charge is and how it moves, in the words of the mill engineer (Powell & McBride 2004; Bbosa et al. 2011; Chagas 2015).
//
// Angles are in degrees from 6 o'clock, positive in the turning sense; the free surface's from the horizontal. Definitions:
//   centre of circulation   common/centre.hpp   where the mean flow stands still
//   equilibrium surface     shell.hpp     radius at which the flow turns from rising to falling
//   departure shoulder      shell.hpp     where the mean flow along the shell begins to turn inwards
//   bulk toe                shell.hpp     angle that halves the flow which comes back to the shell
//   impact toe              here          median angle at which free flights end that fall at least R/2 from their highest point
//   head                    here          height above which the charge spends 0.1 % of its time
//   centre of mass          here          (⟨x⟩, ⟨y⟩); power = M g |(⟨x⟩, ⟨y⟩)| sin(angle) |Ω|
//   free surface, regions   regions.hpp
#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "analyzers/charge_features/regions.hpp"
#include "analyzers/charge_features/shell.hpp"
#include "analyzers/common/flight.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

constexpr std::int64_t kAngleBins = 180, kRings = 40, kHeightBins = 400, kSectors = 36;
constexpr double kSlack = 1.05;        // of the shell's radius: noise may put a bead beyond the shell
constexpr double kCataractDrop = 0.5;  // of the shell's radius: a flight that falls less is a hop over the bed

constexpr Parameter kParameters[] = {
    integer_parameter("cells", 50, 10, 500, "Cells of the map from shell to shell; two more at each side take what noise puts outside."),
    number_parameter("lifter_height", "m", 0, 0, 10, "Beads nearer to the shell are in lifter pockets; 0: unknown, no pockets."),
    number_parameter("end_band", "m", 0, 0, 100, "Length at each end face that counts as its band; 0: no end bands."),
    integer_parameter("flight_beads", 4000, 1, 1e9, "Free flights are looked for in at most about this many beads, evenly by id."),
    kFlightTolerance,
    kFlightWindow,
    kLeastFlight,
};

FieldShape shape_of(const Parameters& p, const AnalyzerContext& context) {
  const double radius = shell_radius(context), sense = known_sense(context);
  const std::int64_t cells = p.integer("cells");
  const double half = radius * (1 + 4.0 / static_cast<double>(cells));
  const double lifters = p.number("lifter_height"), band = p.number("end_band");
  if (lifters >= radius) throw Refusal("lifter_height is not smaller than the mill's radius");
  const double length = context.mill_high - context.mill_low;
  if (band > 0 && (context.is_periodic != 0 || !(length > 0)))
    throw Refusal("end_band needs end faces: this mill's are unknown or it is periodic along z");
  if (band > 0 && 2 * band > length) throw Refusal("the end bands overlap: end_band is more than half of the mill's length");
  return {radius,
          radius - context.bead_radius,
          sense,
          std::fabs(context.omega),
          Bins(-half, half, cells + 4),
          Bins(-std::numbers::pi, std::numbers::pi, kAngleBins),
          Bins(0, kSlack * radius, static_cast<std::int64_t>(std::lround(kSlack * kRings))),
          Bins(-kSlack * radius, kSlack * radius, kHeightBins),
          lifters,
          band};
}

class ChargeFeatures {
 public:
  static constexpr std::uint64_t kNeeds = kHasVelocity;

  ChargeFeatures(const Parameters& p, const AnalyzerContext& context)
      : shape_(shape_of(p, context)),
        flights_known_(context.gravity > 0),
        flight_(flights_known_ ? flight_options(p, context) : FlightOptions{}),
        flight_stride_(even_stride(context.largest_id, p.integer("flight_beads"))),
        low_(context.mill_low + shape_.end_bands),
        high_(context.mill_high - shape_.end_bands) {
    flight_.keep_cut = true;
  }

  std::vector<ArrayInfo> arrays() const {
    const auto n = static_cast<std::uint64_t>(shape_.cells.count), a = static_cast<std::uint64_t>(shape_.angles.count);
    const auto k = static_cast<std::uint64_t>(shape_.rings.count), h = static_cast<std::uint64_t>(shape_.heights.count);
    return {additive("map", "mixed", {n, n, kMapMoments}),
            additive("pockets", "mixed", {kShareMoments}),
            additive("polar", "mixed", {a, k, kPolarMoments}),
            additive("heights", "mixed", {h, kHeightMoments}),
            additive("launches", "1", {a}),
            additive("landings", "1", {a}),
            additive("end_bands", "mixed", {kShareMoments}),
            additive("totals", "mixed", {kTotals_})};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    for (std::int64_t s = block.first[0]; s < block.first[block.frame_count]; ++s) {
      if (block.weight[s] > 0) add_sample(block, s, sums);
    }
    if (!flights_known_) return;
    FlightFinder finder(flight_);
    for_each_track(block, flight_stride_, [&](const Track& track) { add_flights(block, track, finder.find(block, track), sums); });
  }

  void finish(const double* const* sums, Results& results) const {
    const ChargeFields fields(shape_, sums);
    const std::optional<Centre> centre = find_centre(fields.flow());
    add_centre(results, fields, centre);
    add_shell(results, centre ? find_shell_features(fields, *centre) : ShellFeatures{});
    add_head_and_mass(results, fields);
    if (flights_known_) add_flight_angles(results, fields);
    add_regions(results, fields, centre);
    add_profiles(results, fields);
  }

 private:
  void add_sample(const FrameBlock& block, std::int64_t s, double* const* sums) const {
    const double x = block.position[0][s], y = block.position[1][s], z = block.position[2][s], w = block.weight[s];
    const double u = block.velocity[0][s], v = block.velocity[1][s], axial = block.velocity[2][s];
    const double r = std::sqrt(x * x + y * y), speed = std::sqrt(u * u + v * v + axial * axial);
    const std::optional<std::int64_t> cell = cell_at(shape_.cells, x, y), ring = shape_.rings.at(r), height = shape_.heights.at(y);
    sums[kTotals][kTotalTime] += w;
    if (!cell || !ring || !height) {
      sums[kTotals][kTotalOutside] += w;
      return;
    }
    sums[kTotals][kTotalX] += w * x;
    sums[kTotals][kTotalY] += w * y;
    if (shape_.end_bands > 0 && (z < low_ || z > high_)) {
      sums[kEndBands][kShareTime] += w;
      sums[kEndBands][kShareSpeed] += w * speed;
    }
    sums[kHeights][kHeightMoments * *height + kHeightTime] += w;
    sums[kHeights][kHeightMoments * *height + kHeightX] += w * x;
    if (r > 0) {
      double* polar = sums[kPolar] + kPolarMoments * (*shape_.angles.at(shape_.angle(x, y)) * shape_.rings.count + *ring);
      polar[kPolarTime] += w;
      polar[kOutward] += w * (x * u + y * v) / r;
      polar[kAround] += w * shape_.sense * (x * v - y * u) / r;
    }
    if (shape_.lifters > 0 && r > shape_.radius - shape_.lifters) {
      sums[kPockets][kShareTime] += w;
      sums[kPockets][kShareSpeed] += w * speed;
      return;
    }
    double* map = sums[kMap] + kMapMoments * *cell;
    map[kCellTime] += w;
    map[kCellVx] += w * u;
    map[kCellVy] += w * v;
    map[kCellSpeed] += w * speed;
  }

  /// From the highest point of a flight to its end, m.
  static double drop(const FrameBlock& block, const Track& track, const Arc& arc) {
    const auto y = [&](std::size_t i) { return block.position[1][track.points[i].sample]; };
    double highest = y(arc.first);
    for (std::size_t i = arc.first; i <= arc.last; ++i) highest = std::fmax(highest, y(i));
    return highest - y(arc.last);
  }

  void add_flights(const FrameBlock& block, const Track& track, const std::vector<Arc>& arcs, double* const* sums) const {
    std::size_t next = 0;
    for (std::size_t i = 0; i < track.size(); ++i) {
      const std::int64_t s = track.points[i].sample;
      const std::optional<std::int64_t> cell = cell_at(shape_.cells, block.position[0][s], block.position[1][s]);
      while (next < arcs.size() && arcs[next].last < i) ++next;
      if (!cell) continue;
      double* map = sums[kMap] + kMapMoments * *cell;
      map[kCellWatched] += block.weight[s];
      if (next < arcs.size() && arcs[next].first <= i) map[kCellFlight] += block.weight[s];
    }
    const auto count = [&](FieldArray name, std::size_t i) {
      const std::int64_t s = track.points[i].sample;
      const std::optional<std::int64_t> bin = shape_.angles.at(shape_.angle(block.position[0][s], block.position[1][s]));
      if (bin) sums[name][*bin] += 1;
    };
    for (const Arc& arc : arcs) {
      if (arc.launch_seen) count(kLaunches, arc.first);
      if (arc.landing_seen && drop(block, track, arc) > kCataractDrop * shape_.radius) count(kLandings, arc.last);
    }
  }

  void add_centre(Results& results, const ChargeFields& fields, const std::optional<Centre>& centre) const {
    const double x = centre ? centre->x : kNaN, y = centre ? centre->y : kNaN;
    results.add("centre_of_circulation_x", "m", x,
                "Where the mean flow stands still and the charge turns about it; NaN: no such place inside the charge.", kOdd);
    results.add("centre_of_circulation_y", "m", y, "Its height.");
    results.add("centre_of_circulation_radius", "m", std::hypot(x, y), "Its distance from the mill's axis.");
    results.add("centre_of_circulation_angle", "deg", kDegrees * shape_.angle(x, y),
                "Its angle from 6 o'clock, positive in the turning sense.");
    results.add("rotation_at_centre", "rad/s", centre ? centre->rotation : kNaN,
                "Half of the mean flow's curl there, positive in the turning sense.");
    const std::vector<double> surface = equilibrium_surface(fields, kAngleBins / kSectors);
    results.add("equilibrium_angle_edges_deg", "deg", Bins(-180, 180, kSectors).edges().data(), {kSectors + 1}, "Edges of the sectors.");
    results.add("equilibrium_radius", "m", surface.data(), {kSectors},
                "Radius at which the flow turns from rising to falling, per sector; NaN where it does not.",
                {"equilibrium_angle_edges_deg"});
  }

  static void add_shell(Results& results, const ShellFeatures& found) {
    results.add("departure_shoulder", "deg", kDegrees * found.shoulder,
                "Angle at which the mean flow along the shell begins to turn inwards; NaN without a centre of circulation.");
    results.add("departure_median", "deg", kDegrees * found.departure_median, "Angle by which half of the shell's stream has left it.");
    results.add("departure_last", "deg", kDegrees * found.departure_last, "Angle by which 90 % of the shell's stream has left it.");
    results.add("bulk_toe", "deg", kDegrees * found.bulk_toe,
                "Angle that halves the flow which comes back to the shell; NaN without a centre of circulation.");
    results.add("farthest_toe", "deg", kDegrees * found.farthest_toe, "Angle before which 10 % of that flow comes back.");
  }

  void add_head_and_mass(Results& results, const ChargeFields& fields) const {
    constexpr double kHead = 1e-3;
    const double time = fields.total(kTotalTime) - fields.total(kTotalOutside);
    double above = 0, x_above = 0;
    std::int64_t bin = shape_.heights.count;
    while (bin > 0 && !(above > kHead * time)) {
      --bin;
      above += fields.height(bin)[kHeightTime];
      x_above += fields.height(bin)[kHeightX];
    }
    const double over = above - kHead * time, here = fields.height(bin)[kHeightTime];
    const double head = time > 0 ? shape_.heights.edge(bin) + shape_.heights.width() * over / here : kNaN;
    results.add("head_height", "m", head, "Height above the axis that 0.1 % of the charge's time lies above.");
    results.add("head_angle", "deg", kDegrees * shape_.angle(ratio(x_above, above), head), "Angle of that place, at the mean x above it.");

    const double x = ratio(fields.total(kTotalX), time), y = ratio(fields.total(kTotalY), time);
    results.add("centre_of_mass_x", "m", x, "Mean x of the charge; in a recording the tracer's.", kOdd);
    results.add("centre_of_mass_y", "m", y, "Mean height.");
    results.add("centre_of_mass_angle", "deg", kDegrees * shape_.angle(x, y),
                "Its angle from 6 o'clock, also called the power angle: power = M g (distance from the axis) sin(angle) |Omega|.");
    results.add("torque_arm", "m", shape_.sense * x, "Mean x on the rising side: power = M g (torque arm) |Omega|.");
    results.add("outside_fraction", "1", ratio(fields.total(kTotalOutside), fields.total(kTotalTime)),
                "Fraction of the time outside the maps, beyond 1.05 radii of the shell; left out of everything else.", kShare);
  }

  void add_flight_angles(Results& results, const ChargeFields& fields) const {
    const auto counts = [&](FieldArray name) { return std::vector<double>(fields.array(name), fields.array(name) + kAngleBins); };
    const std::vector<double> launches = counts(kLaunches), landings = counts(kLandings);
    double flights = 0;
    for (const double n : landings) flights += n;
    results.add("flights_landed", "1", flights, "Free flights of the cataract (they fall at least half a radius) whose end was seen.",
                kBookkeeping | kNotNegative);
    results.add("launch_angle", "deg", kDegrees * quantile(launches, shape_.angles, 0.5), "Median angle at which free flights begin.");
    results.add("impact_toe", "deg", kDegrees * quantile(landings, shape_.angles, 0.5),
                "Median angle at which the cataract's free flights end; NaN without any.");
    results.add("farthest_impact", "deg", kDegrees * quantile(landings, shape_.angles, 0.1), "Angle before which 10 % of them end.");
  }

  void add_regions(Results& results, const ChargeFields& fields, const std::optional<Centre>& centre) const {
    const std::vector<Region> labels = label_regions(fields, centre);
    const std::vector<RegionSums> regions = sum_regions(fields, labels);
    const double all = fields.total(kTotalTime) - fields.total(kTotalOutside);
    const auto n = static_cast<std::uint64_t>(shape_.cells.count);
    results.add("x_edges", "m", shape_.cells.edges().data(), {n + 1}, "Edges of the map's cells along x.", {}, kAlongX);
    results.add("y_edges", "m", shape_.cells.edges().data(), {n + 1}, "Edges of the map's cells along y.");
    const std::vector<double> numbers(labels.begin(), labels.end());
    results.add("region", "1", numbers.data(), {n, n}, "0 nothing, 1 en masse, 2 cascading layer, 3 cataracting, 4 eye, 5 lifter pockets.",
                {"y_edges", "x_edges"});
    std::vector<double> flight(labels.size());
    for (std::size_t i = 0; i < flight.size(); ++i) {
      const double* cell = fields.array(kMap) + kMapMoments * static_cast<std::int64_t>(i);
      flight[i] = ratio(cell[kCellFlight], cell[kCellWatched]);
    }
    if (flights_known_)
      results.add("flight_fraction", "1", flight.data(), {n, n}, "Fraction of a cell's time that beads are in free flight.",
                  {"y_edges", "x_edges"}, kShare);
    add_share(results, "en_masse", regions[kEnMasse].time, regions[kEnMasse].speed, all);
    add_share(results, "cascading", regions[kCascading].time, regions[kCascading].speed, all);
    if (flights_known_) add_share(results, "cataracting", regions[kCataracting].time, regions[kCataracting].speed, all);
    add_share(results, "eye", centre ? regions[kEye].time : kNaN, regions[kEye].speed, all);
    if (shape_.lifters > 0) add_share(results, "pocket", regions[kPocket].time, regions[kPocket].speed, all);
    const double* bands = fields.array(kEndBands);
    if (shape_.end_bands > 0) add_share(results, "end_band", bands[kShareTime], bands[kShareSpeed], all);
    results.add("free_surface_angle", "deg", centre ? kDegrees * surface_angle(fields, labels, *centre) : kNaN,
                "Angle below the horizontal of the mean flow in the cascading layer within 30 deg of the centre of circulation.");
  }

  static void add_share(Results& results, const std::string& region, double time, double speed, double all) {
    results.add((region + "_share").c_str(), "1", ratio(time, all), "Fraction of the charge's time in this region.", kShare);
    results.add((region + "_speed").c_str(), "m/s", ratio(speed, time), "Mean speed in this region.");
  }

  /// Along the shell, in the zone that the toe is found in.
  void add_profiles(Results& results, const ChargeFields& fields) const {
    std::vector<double> occupancy(kAngleBins), outward(kAngleBins);
    const double all = fields.total(kTotalTime) - fields.total(kTotalOutside);
    for (std::int64_t a = 0; a < kAngleBins; ++a) {
      double time = 0, flow = 0;
      for (std::int64_t k = 0; k < shape_.rings.count; ++k) {
        if (shape_.rings.centre(k) <= detail::kShellZone * shape_.reach) continue;
        time += fields.polar(a, k)[kPolarTime];
        flow += fields.polar(a, k)[kOutward];
      }
      element(occupancy, a) = ratio(time, all) / shape_.angles.width();
      element(outward, a) = ratio(flow, time);
    }
    results.add("angle_edges_deg", "deg", shape_.angles.edges(kDegrees).data(), {kAngleBins + 1},
                "Edges of the angles from 6 o'clock, positive in the turning sense.");
    results.add("shell_occupancy", "1/rad", occupancy.data(), {kAngleBins},
                "Fraction of the charge's time next to the shell (beyond 0.85 of the largest radius), per angle.", {"angle_edges_deg"});
    results.add("shell_outward_velocity", "m/s", outward.data(), {kAngleBins}, "Mean outward velocity there.", {"angle_edges_deg"});
  }

  FieldShape shape_;
  bool flights_known_;  ///< false: gravity is unknown, so flights cannot be told from other motion and are left out
  FlightOptions flight_;
  std::int64_t flight_stride_;
  double low_, high_;
};

constexpr Descriptor kDescriptor = describe<ChargeFeatures>({
    .name = "charge_features",
    .version = "0.1.0",
    .doc = "Centre of circulation, equilibrium surface, shoulder, head, toes, free surface, and the regions of the charge.",
    .equation =
        "shoulder: -v_r/(|Omega| r_max) = A max(0, theta - theta_s + b (1 - r/r_max)); toe: int_{-120 deg}^{toe} flux = 1/2 int flux",
    .citation = "Powell & McBride 2004, Minerals Engineering 17; Bbosa et al. 2011, Minerals Engineering 24; Chagas 2015",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
