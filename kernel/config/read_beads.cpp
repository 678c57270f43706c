// `beads` and `fill`.
#include <fmt/format.h>
#include <cmath>
#include <numbers>

#include "kernel/config/existing_file.hpp"
#include "kernel/config/reader.hpp"

namespace millscope::config {
namespace {

constexpr double kSumTolerance = 1e-6;     // of fractions written by hand
constexpr double kExactTolerance = 1e-12;  // sums this near to 1 are left alone, so that a resolved file reads back to the same bits
constexpr double kTails = 3;               // standard deviations kept on each side of a distribution

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

struct Distribution {
  std::string kind;
  double mean = 0, deviation = 0, low = 0, high = 0;
  int bins = 0;

  /// Parameters of the normal that ln d follows.
  double log_deviation() const { return std::sqrt(std::log1p(deviation * deviation / (mean * mean))); }
  double log_mean() const { return std::log(mean) - 0.5 * log_deviation() * log_deviation(); }

  double cumulative(double d) const {
    if (kind == "uniform") return (d - low) / (high - low);
    return kind == "normal" ? normal_cdf((d - mean) / deviation) : normal_cdf((std::log(d) - log_mean()) / log_deviation());
  }
};

Distribution read_distribution(const Node& node) {
  node.expect({"kind", "mean", "deviation", "low", "high", "bins"});
  Distribution d;
  d.kind = read_choice(node.at("kind", "normal, lognormal or uniform"), "normal|lognormal|uniform");
  const auto bins = node.find("bins");
  d.bins = bins ? static_cast<int>(read_integer(*bins, between(1, 1000))) : 11;
  if (d.kind == "uniform") {
    for (const char* key : {"mean", "deviation"}) {
      if (const auto extra = node.find(key)) extra->fail("does not go with kind: uniform; remove it");
    }
    d.low = read_number(node.at("low", "the smallest diameter"), "m", positive());
    d.high = read_number(node.at("high", "the largest diameter"), "m", positive());
  } else {
    d.mean = read_number(node.at("mean", "the mean diameter, e.g. 5 mm"), "m", positive());
    d.deviation = read_number(node.at("deviation", "the standard deviation of the diameter, e.g. 0.1 mm"), "m", positive());
    const bool normal = d.kind == "normal";
    const double low = normal ? d.mean - kTails * d.deviation : std::exp(d.log_mean() - kTails * d.log_deviation());
    const double high = normal ? d.mean + kTails * d.deviation : std::exp(d.log_mean() + kTails * d.log_deviation());
    d.low = number_or(node, "low", "m", positive(), low);
    d.high = number_or(node, "high", "m", positive(), high);
  }
  if (d.low <= 0) node.fail("reaches diameters below 0 within three deviations; give 'low'");
  if (!(d.low < d.high)) node.fail("has 'low' not below 'high'");
  return d;
}

std::vector<SizeClass> binned(const Distribution& d) {
  std::vector<SizeClass> sizes;
  const double width = (d.high - d.low) / d.bins;
  for (int i = 0; i < d.bins; ++i) {
    const double left = d.low + i * width;
    sizes.push_back({left + 0.5 * width, d.cumulative(left + width) - d.cumulative(left)});
  }
  return sizes;
}

std::vector<SizeClass> listed(const Node& node) {
  std::vector<SizeClass> sizes;
  double sum = 0;
  for (const Node& item : node.items()) {
    item.expect({"diameter", "fraction"});
    SizeClass size;
    size.diameter = read_number(item.at("diameter", "e.g. 5 mm"), "m", positive());
    size.number_fraction = read_number(item.at("fraction", "its part of the class, e.g. 60 %"), "1", between(0, 1));
    sum += size.number_fraction;
    sizes.push_back(size);
  }
  if (sizes.empty()) node.fail("is an empty list; add a size");
  if (std::fabs(sum - 1) > kSumTolerance)
    node.fail(fmt::format("has fractions that add up to {} %; they must make 100 %", number_text(100 * sum)));
  return sizes;
}

void normalise(std::vector<SizeClass>& sizes) {
  double sum = 0;
  for (const SizeClass& s : sizes) sum += s.number_fraction;
  if (std::fabs(sum - 1) <= kExactTolerance) return;
  for (SizeClass& s : sizes) s.number_fraction /= sum;
}

BeadCase read_bead(const Node& node, const std::string& name, const std::vector<MaterialCase>& materials) {
  node.expect({"material", "diameter", "sizes", "distribution", "fractions_by", "density", "share", "tracer"});
  BeadCase bead;
  bead.name = name;
  bead.where = node.where();
  bead.material = read_material_name(node.at("material", "the name of a material"), materials);
  for (const MaterialCase& m : materials) {
    if (m.name == bead.material) bead.density = m.density;
  }
  bead.density = number_or(node, "density", "kg/m^3", positive(), bead.density);
  bead.sizes = read_sizes(node);
  if (const auto tracer = node.find("tracer")) bead.tracer = read_flag(*tracer);
  return bead;
}

void take_shares(const Node& section, std::vector<BeadCase>& beads, bool by_mass) {
  double sum = 0, numbers = 0;
  for (BeadCase& bead : beads) {
    const Node node = section.at(bead.name);
    const auto share = node.find("share");
    if (!share && beads.size() > 1) node.at("share", "the class's part of the charge, e.g. 40 %; needed with several classes");
    bead.number_share = share ? read_number(*share, "1", between(0, 1)) : 1;
    sum += bead.number_share;
    if (by_mass && beads.size() > 1) bead.number_share /= bead.density * bead.mean_volume();
    numbers += bead.number_share;
  }
  if (std::fabs(sum - 1) > kSumTolerance)
    section.fail(fmt::format("has shares that add up to {} %; they must make 100 %", number_text(100 * sum)));
  if (std::fabs(numbers - 1) <= kExactTolerance) return;
  for (BeadCase& bead : beads) bead.number_share /= numbers;
}

std::optional<Vessel> read_vessel(const std::optional<Node>& node) {
  if (!node) return std::nullopt;
  node->expect({"diameter", "length"});
  return Vessel{read_number(node->at("diameter", "of the bare shell"), "m", positive()),
                read_number(node->at("length", "along the axis"), "m", positive())};
}

std::optional<Box> read_region(const std::optional<Node>& node) {
  if (!node) return std::nullopt;
  node->expect({"low", "high"});
  const Box box{read_vector(node->at("low", "[x, y, z]"), "m"), read_vector(node->at("high", "[x, y, z]"), "m")};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(box.low[i] < box.high[i])) node->fail("has a component of 'low' that is not below that of 'high'");
  }
  return box;
}

}  // namespace

std::vector<SizeClass> read_sizes(const Node& bead) {
  const int ways = int{bead.has("diameter")} + int{bead.has("sizes")} + int{bead.has("distribution")};
  if (ways != 1)
    bead.fail(fmt::format("gives {} of 'diameter', 'sizes' and 'distribution'; give exactly one", ways == 0 ? "none" : "several"));
  const auto by = bead.find("fractions_by");
  const bool by_mass = !by || read_choice(*by, "mass|number") == "mass";
  if (const auto diameter = bead.find("diameter")) return {{read_number(*diameter, "m", positive()), 1}};
  const auto list = bead.find("sizes");
  std::vector<SizeClass> sizes = list ? listed(*list) : binned(read_distribution(bead.at("distribution")));
  if (by_mass) {
    normalise(sizes);
    for (SizeClass& s : sizes)
      s.number_fraction /= s.diameter * s.diameter * s.diameter / (sizes[0].diameter * sizes[0].diameter * sizes[0].diameter);
  }
  normalise(sizes);
  return sizes;
}

std::vector<BeadCase> read_beads(const Node& section, const std::vector<MaterialCase>& materials, bool shares_by_mass) {
  std::vector<BeadCase> beads;
  for (const std::string& name : section.keys()) {
    const Node node = section.at(name);
    check_name(name, node.where(), "bead class");
    beads.push_back(read_bead(node, name, materials));
  }
  if (beads.empty()) section.fail("names no bead class; add one");
  take_shares(section, beads, shares_by_mass);
  return beads;
}

bool read_shares_by_mass(const Node& fill) {
  const auto by = fill.find("shares_by");
  return !by || read_choice(*by, "mass|number") == "mass";
}

FillCase read_fill(const Node& section) {
  section.expect({"count", "mass", "filling", "file", "porosity", "vessel", "region", "settle_s", "shares_by"});
  FillCase fill;
  fill.where = section.where();
  const int ways = int{section.has("count")} + int{section.has("mass")} + int{section.has("filling")} + int{section.has("file")};
  if (ways != 1)
    section.fail(fmt::format("gives {} of 'count', 'mass', 'filling' and 'file'; give exactly one", ways == 0 ? "none" : "several"));
  if (const auto node = section.find("file")) {
    fill.file = existing_file(*node);
    fill.settle = 0;  // they are where they are
    if (const auto region = section.find("region"))
      region->fail("bounds a space that is filled, but the beads come from a file; leave it out");
  }
  if (const auto node = section.find("count")) fill.count = static_cast<std::uint64_t>(read_integer(*node, between(1, 4e9)));
  if (const auto node = section.find("mass")) fill.mass = read_number(*node, "kg", positive());
  const Range part{0, 1, true, false, "J is a part of the bare shell's volume; write 31.3 % for a percentage"};
  if (const auto node = section.find("filling")) fill.filling = read_number(*node, "1", part);
  const Range pores{0, 1, false, true, "porosity is the void part of the bed; write 37 % for a percentage"};
  fill.porosity = number_or(section, "porosity", "1", pores, fill.porosity);
  fill.vessel = read_vessel(section.find("vessel"));
  fill.region = read_region(section.find("region"));
  fill.settle = number_or(section, "settle_s", "s", not_negative(), fill.settle);
  return fill;
}

}  // namespace millscope::config
