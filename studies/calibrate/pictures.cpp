// Pictures of a calibration.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/statistics.hpp"
#include "studies/calibrate/outputs.hpp"
#include "studies/picture/picture.hpp"

namespace millscope::calibrate {
namespace {

namespace fs = std::filesystem;
using picture::Curve;
using picture::CurvePicture;
using picture::MapPicture;

constexpr int kCells = 40;  // of surface and posterior, along each side
using base::kNormal90;
constexpr std::size_t kMostPairs = 10;

Curve curve_of(const std::string& label, const Histogram& h) {
  Curve c{label, h.edges, h.percent, {}, {}};
  for (std::size_t i = 0; i < h.percent.size(); ++i) {
    c.low.push_back(h.percent[i] - kNormal90 * h.sem[i]);
    c.high.push_back(h.percent[i] + kNormal90 * h.sem[i]);
  }
  return c;
}

std::string file_name(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' ? c : '_';
  return out;
}

struct Drawer {
  fs::path folder;
  std::vector<fs::path> files;

  void curves(const CurvePicture& picture, const std::string& name) {
    picture::draw_curves(picture, folder / name);
    files.push_back(folder / (name + ".svg"));
  }
  void map(const MapPicture& picture, const std::string& name) {
    picture::draw_map(picture, folder / name);
    files.push_back(folder / (name + ".svg"));
  }
};

void distributions(const std::string& name, const Observation& recorded, const Observation& simulated, Drawer& drawer) {
  const auto draw = [&](const Histogram& seen, const Histogram& made, const char* what, const char* unit) {
    CurvePicture p;
    p.title = fmt::format("{}: observed and calibrated", name);
    p.x_label = what, p.x_unit = unit, p.value_label = "time", p.value_unit = "%";
    p.curves = {curve_of("recording", seen), curve_of("simulation", made)};
    drawer.curves(p, fmt::format("{}_{}", file_name(name), what[0] == 'x' ? "x" : "speed"));
  };
  if (!recorded.of_tracks()) return;
  draw(recorded.x, simulated.x, "x", "m");
  draw(recorded.speed, simulated.speed, "speed over shell speed", "1");
}

void profiles(const Study& study, const Inference& inference, Drawer& drawer) {
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    const emulate::Profile& f = inference.profiles[p];
    const auto values = [](const Eigen::VectorXd& v) {
      std::vector<double> out(v.data(), v.data() + v.size());
      for (double& x : out) x = std::max(x, -20.0);  // farther down nothing is left to see
      return out;
    };
    CurvePicture picture;
    picture.title = "How the fit suffers when " + study.parameters[p].name + " is held";
    picture.x_label = study.parameters[p].name, picture.value_label = "log density below the best";
    picture.note = "90 % of what is possible lies above -1.35; values below -20 are shown there";
    const std::vector<double> grid(f.value.data(), f.value.data() + f.value.size());
    picture.curves = {{"others fixed", grid, values(f.alone)}, {"others re-adjusted", grid, values(f.readjusted)}};
    drawer.curves(picture, "profile_" + file_name(study.parameters[p].name));
  }
}

std::vector<double> edges(double low, double high) {
  std::vector<double> e;
  for (int i = 0; i <= kCells; ++i) e.push_back(low + (high - low) * i / kCells);
  return e;
}

void pairs(const Study& study, const emulate::Posterior& posterior, Drawer& drawer) {
  std::size_t drawn = 0;
  for (std::size_t a = 0; a < study.parameters.size(); ++a) {
    for (std::size_t b = a + 1; b < study.parameters.size() && drawn < kMostPairs; ++b, ++drawn) {
      const Parameter &x = study.parameters[a], &y = study.parameters[b];
      MapPicture m;
      m.title = fmt::format("What the data leave of {} and {}", x.name, y.name);
      m.x = {x.name, "", edges(x.low, x.high)}, m.y = {y.name, "", edges(y.low, y.high)};
      m.value = {"share of the posterior", "%", std::vector<double>(kCells * kCells, 0)};
      for (Eigen::Index s = 0; s < posterior.samples.rows(); ++s) {
        const auto cell = [&](std::size_t parameter, const Parameter& of) {
          const double t = (posterior.samples(s, static_cast<Eigen::Index>(parameter)) - of.low) / (of.high - of.low);
          return static_cast<std::size_t>(std::clamp(static_cast<int>(t * kCells), 0, kCells - 1));
        };
        m.value.values[cell(b, y) * kCells + cell(a, x)] += 100.0 / static_cast<double>(posterior.samples.rows());
      }
      m.scale = picture::ColorScale::sequential;
      m.blank = "practically excluded";
      drawer.map(m, fmt::format("posterior_{}_{}", file_name(x.name), file_name(y.name)));
    }
  }
}

void surface(const Composite& c, Drawer& drawer) {
  const doe::Surface& s = c.surface;
  const doe::Factor &x = s.factors[0], &y = s.factors[1];
  const std::vector<double> a = edges(s.lower[0], s.upper[0]), b = edges(s.lower[1], s.upper[1]);
  MapPicture m;
  m.title = fmt::format("Objective over {} and {}", x.name, y.name);
  for (const double e : a) m.x.edges.push_back(x.centre + x.step * e);
  for (const double e : b) m.y.edges.push_back(y.centre + y.step * e);
  m.x.label = x.name, m.y.label = y.name;
  m.value = {"quadratic surface", "", {}};
  for (std::size_t r = 0; r < kCells; ++r) {
    for (std::size_t q = 0; q < kCells; ++q) {
      Eigen::VectorXd at = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(s.factors.size()));
      at[0] = 0.5 * (a[q] + a[q + 1]);
      at[1] = 0.5 * (b[r] + b[r + 1]);
      m.value.values.push_back(doe::value_at(s, at));
    }
  }
  m.scale = picture::ColorScale::sequential;
  if (s.stationary && s.stationary->inside) m.marks = {{"stationary point", s.stationary->natural[0], s.stationary->natural[1]}};
  drawer.map(m, "surface");
}

/// How the search came along.
void progress(const Evaluator& evaluator, Drawer& drawer) {
  const Study& study = evaluator.study();
  CurvePicture p;
  p.title = "Best objective so far";
  p.x_label = "parameter sets simulated", p.value_label = name_of(study.objective.kind);
  Curve curve{"best so far", {}, {}, {}, {}};
  double best = 0;
  for (const Trial& t : evaluator.trials()) {
    if (t.failed) continue;
    best = curve.value.empty() ? evaluator.objective(t) : std::min(best, evaluator.objective(t));
    curve.x.push_back(static_cast<double>(curve.x.size() + 1));
    curve.value.push_back(best);
  }
  p.curves = {curve};
  if (curve.value.size() > 1) drawer.curves(p, "progress");
}

}  // namespace

std::vector<fs::path> draw_distributions(const std::string& name, const Observation& recorded, const Observation& simulated,
                                         const fs::path& folder) {
  Drawer drawer{folder, {}};
  distributions(name, recorded, simulated, drawer);
  return drawer.files;
}

std::vector<fs::path> draw(const Evaluator& evaluator, const Calibration& c, const fs::path& folder) {
  Drawer drawer{folder, {}};
  const Trial* best = nullptr;
  for (const Trial& t : evaluator.trials()) {
    if (!t.failed && (best == nullptr || evaluator.objective(t) < evaluator.objective(*best))) best = &t;
  }
  if (c.at_best && !c.at_best->failed) best = &*c.at_best;
  for (std::size_t k = 0; best != nullptr && k < best->conditions.size(); ++k) {
    const std::size_t condition = best->conditions[k];
    distributions(evaluator.study().conditions[condition].name, evaluator.recorded(condition), best->observed[k], drawer);
  }
  if (c.composite) surface(*c.composite, drawer);
  if (c.inference) {
    profiles(evaluator.study(), *c.inference, drawer);
    pairs(evaluator.study(), c.inference->posterior, drawer);
  }
  progress(evaluator, drawer);
  return drawer.files;
}

}  // namespace millscope::calibrate
