#include "studies/calibrate/silhouette.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/statistics.hpp"
#include "kernel/config/existing_file.hpp"
#include "kernel/config/units.hpp"
#include "studies/recording/grey_picture.hpp"

#include "millscope/silhouette.hpp"

namespace millscope::calibrate {
namespace {

using config::Node;
using recording::GreyPicture;

constexpr double kDegrees = 180 / std::numbers::pi, kDefaultAngleError = 0.5 / kDegrees;
constexpr double kFewestGreys = 20;    // between what is covered and what is free, of 255
constexpr double kFewestPixels = 100;  // from shell to shell
constexpr double kLeastArc = 0.05;  // part of a recorded ring, covered or free; simulated ones have some way to go to the analyzer's 0.01
constexpr double kOwnPart = 0.25;   // of the blur: by how much each end of an arc may be off by itself
constexpr double kLeastBlur = 2.0 / kSilhouetteCells;  // parts of the radius: no picture is sharper than a cell

/// Where the drum is, in pixels.
struct Drum {
  double x, y, diameter;
};

Drum drum_in(const Node& section, const GreyPicture& picture) {
  const double width = picture.width, height = picture.height;
  Drum drum{0.5 * width, 0.5 * height, std::min(width, height)};
  const auto node = section.find("drum");
  if (!node) return drum;
  node->expect({"centre", "diameter"});
  const auto centre = node->at("centre", "[x, y], pixels from the upper left").items();
  if (centre.size() != 2) node->fail("'centre' wants two numbers, e.g. [203, 203]");
  drum.x = config::read_number(centre[0], "1"), drum.y = config::read_number(centre[1], "1");
  drum.diameter = config::read_number(node->at("diameter", "pixels"), "1", config::positive("it is a width in pixels"));
  const double r = 0.5 * drum.diameter;
  if (drum.x - r < -1 || drum.y - r < -1 || drum.x + r > width + 1 || drum.y + r > height + 1)
    node->fail(
        fmt::format("lies partly outside the picture of {} × {} pixels; the whole drum must be seen", picture.width, picture.height));
  return drum;
}

/// Grey at a place of the square about the drum, −1 … 1, y upwards.
double grey_at(const GreyPicture& picture, const Drum& drum, double x, double y) {
  const auto pixel = [](double at, int size) { return std::clamp(static_cast<int>(std::floor(at)), 0, size - 1); };
  return picture.at(pixel(drum.x + 0.5 * drum.diameter * x, picture.width), pixel(drum.y - 0.5 * drum.diameter * y, picture.height));
}

/// Median grey of the lowest (side −1) or the highest (+1) tenth of the drum, away from its rim.
double grey_of_end(const GreyPicture& picture, const Drum& drum, double side) {
  std::vector<double> greys;
  for (double x = -0.5; x <= 0.5; x += 0.01) {
    for (double y = 0.8; y <= 0.95; y += 0.01) {
      if (std::hypot(x, y) < kSilhouetteOuter) greys.push_back(grey_at(picture, drum, x, side * y));
    }
  }
  return base::quantile(greys, 0.5);
}

/// The share that the mean grey of each cell tells. Noise averages out before shares end at 0 and 1.
std::vector<double> covered_cells(const GreyPicture& picture, const Drum& drum, double covered, double free) {
  constexpr int n = kSilhouetteCells, kSamples = 4;
  std::vector<double> cells(static_cast<std::size_t>(n) * n);
  for (int j = 0; j < n * kSamples; ++j) {
    for (int i = 0; i < n * kSamples; ++i) {
      const auto place = [](int k) { return (k + 0.5) * 2 / (n * kSamples) - 1; };
      cells[static_cast<std::size_t>(j / kSamples) * n + static_cast<std::size_t>(i / kSamples)] +=
          grey_at(picture, drum, place(i), place(j));
    }
  }
  for (double& cell : cells) cell = std::clamp((cell / (kSamples * kSamples) - free) / (covered - free), 0.0, 1.0);
  return cells;
}

/// One number of the outline: its value, the part of its error that is its own, and what it changes by with the common errors.
struct Number {
  Summary summary;
  double value, own, by_edge, by_angle;
};

/// Shares and directions of the rings. The bed leans to the side that goes up, whichever that is in the picture.
std::vector<Number> numbers_of(const Silhouette& s, const SilhouetteShape& shape, double radius) {
  const double sense = shape.lean < 0 ? -1 : 1;
  std::vector<Number> out;
  std::size_t k = 0;
  for (const SilhouetteRing& ring : shape.rings) {
    const double r = 0.5 * radius * (ring.inner + ring.outer), blur = radius * std::max(ring.edge, kLeastBlur);
    const double off = s.edge_error.value_or(0.5 * blur), per_length = 100 / (2 * std::numbers::pi * r);  // %/m of the circle
    // Means over one cell: a simulation whose ring has no direction leaves it undefined.
    const auto number = [&](const char* what, const char* result, const char* unit) {
      const Observable observable{fmt::format("{} of the ring {:.2f}–{:.2f} R", what, ring.inner, ring.outer), unit,
                                  ObservableKind::outline};
      return Summary{observable, Summary::mean, "silhouette", result, "ring_area", {k}, 1};
    };
    out.push_back(
        {number("share", "share", "%"), 100 * ring.share, std::numbers::sqrt2 * kOwnPart * blur * per_length, 2 * off * per_length, 0});
    if (ring.has_middle(kLeastArc))
      out.push_back({number("direction", "direction", "deg"), kDegrees * sense * ring.direction,
                     kDegrees * kOwnPart * blur / (std::numbers::sqrt2 * r), 0, kDegrees * s.angle_error});
    ++k;
  }
  return out;
}

double read_angle(const Node& node) { return config::read_number(node, "rad", config::between(0, 1.5, "it is an angle, e.g. 37.4 deg")); }

double read_error(const Node& node, const char* unit) {
  return config::read_number(node, unit, config::positive("it is a standard error"));
}

/// The analyzer of either figure.
std::string silhouette_line(const FigureOf& of, RecordedCondition& r) {
  if (of.mill.period > 0)
    r.observation.notes.push_back(fmt::format(
        "the case is periodic along z: its silhouette is that of a mill {:.4g} mm deep, without end faces", 1e3 * of.mill.period));
  return fmt::format("  silhouette: {{cells: {}}}\n", kSilhouetteCells);
}

}  // namespace

Silhouette Silhouette::read(const Node& section) {
  section.expect({"file", "drum", "greys", "angle_error", "edge_error"});
  Silhouette s;
  const Node file = section.at("file", "a picture averaged over time, e.g. drum.png");
  s.files = {config::existing_file(file)};
  const std::optional<GreyPicture> picture = recording::read_grey_picture(s.files.front());
  if (!picture) file.fail("is no picture that can be read; wanted is PNG, BMP, JPEG or binary PGM");
  const Drum drum = drum_in(section, *picture);
  if (drum.diameter < kFewestPixels)
    file.fail(fmt::format("shows the drum {:.4g} pixels wide; take a picture of {:.4g} and more", drum.diameter, kFewestPixels));
  s.covered_grey = grey_of_end(*picture, drum, -1);
  s.free_grey = grey_of_end(*picture, drum, 1);
  const auto greys = section.find("greys");
  if (greys) {
    greys->expect({"covered", "free"});
    const auto grey = [&](const char* key) {
      return config::read_number(greys->at(key, "0 … 255"), "1", config::between(0, 255, "it is a grey, 0 black and 255 white"));
    };
    s.covered_grey = grey("covered"), s.free_grey = grey("free");
  }
  if (std::fabs(s.covered_grey - s.free_grey) < kFewestGreys)
    (greys ? *greys : file)
        .fail(
            fmt::format("is as grey where the drum is covered ({:.3g}) as where it is free ({:.3g}); correct 'drum' or 'greys', or take a "
                        "picture with more contrast",
                        s.covered_grey, s.free_grey));
  s.covered = covered_cells(*picture, drum, s.covered_grey, s.free_grey);
  const auto angle = section.find("angle_error"), edge = section.find("edge_error");
  s.angle_error = angle ? read_error(*angle, "rad") : kDefaultAngleError;
  if (edge) s.edge_error = read_error(*edge, "m");
  return s;
}

void Silhouette::measure(const FigureOf& of, RecordedCondition& r) const {
  const SilhouetteShape shape = silhouette_shape(covered.data(), kSilhouetteCells);
  const std::vector<Number> numbers = numbers_of(*this, shape, of.mill.context.mill_radius);
  r.analyzers = silhouette_line(of, r);
  Observation& o = r.observation;
  const auto n = static_cast<Eigen::Index>(numbers.size());
  o.value.resize(n), o.covariance.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    r.summaries.push_back(numbers[i].summary);
    o.value[i] = numbers[i].value;
    for (Eigen::Index j = 0; j < n; ++j)
      o.covariance(i, j) = numbers[i].by_edge * numbers[j].by_edge + numbers[i].by_angle * numbers[j].by_angle;
    o.covariance(i, i) += numbers[i].own * numbers[i].own;
  }
  o.notes.push_back(fmt::format(
      "{}: grey {:.3g} is covered, {:.3g} free; the bed covers {:.1f} % of the drum, its surface slopes by {:.1f}°",
      files.front().filename().string(), covered_grey, free_grey, 100 * shape.area, kDegrees * std::atan(std::fabs(shape.slope))));
}

SurfaceAngle SurfaceAngle::read(const Node& section) {
  section.expect({"value", "error"});
  SurfaceAngle a;
  a.value = read_angle(section.at("value", "from the horizontal, e.g. 37.4 deg"));
  a.error = read_error(section.at("error", "e.g. 0.5 deg"), "rad");
  return a;
}

void SurfaceAngle::measure(const FigureOf& of, RecordedCondition& r) const {
  r.analyzers = silhouette_line(of, r);
  r.summaries.push_back(
      {{"angle of the surface", "deg", ObservableKind::outline}, Summary::number, "silhouette", "surface_angle", "", {}, 1});
  r.observation.value = Eigen::VectorXd::Constant(1, kDegrees * value);
  r.observation.covariance = Eigen::MatrixXd::Constant(1, 1, std::pow(kDegrees * error, 2));
}

}  // namespace millscope::calibrate
