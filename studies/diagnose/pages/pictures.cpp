// Pictures of a diagnosis.
#include <fmt/format.h>

#include <cmath>

#include "studies/calibrate/power.hpp"
#include "studies/diagnose/pages/outputs.hpp"
#include "studies/picture/picture.hpp"

namespace millscope::diagnose {
namespace {

namespace fs = std::filesystem;
using picture::Curve;
using picture::CurvePicture;

struct Drawer {
  fs::path folder;
  std::vector<fs::path> files;

  void curves(const CurvePicture& picture, const std::string& name) {
    picture::draw_curves(picture, folder / name);
    files.push_back(folder / (name + ".svg"));
  }
};

/// Standardised differences of every observable, the retuned base and the best candidate.
void mismatch(const Told& t, Drawer& drawer) {
  const Diagnosis& d = t.diagnosis;
  const naming::Surrogate s(d.problem.data);
  const auto curve = [&](const char* label, const VectorXd& model) {
    Curve c{label, {}, {}, {}, {}};
    for (Index i = 0; i < model.size(); ++i) {
      c.x.push_back(static_cast<double>(i + 1));
      c.value.push_back((d.problem.observed[i] - model[i]) / std::sqrt(d.naming.covariance(i, i)));
    }
    return c;
  };
  CurvePicture p;
  p.title = "Recording against model", p.x_label = "observable", p.value_label = "difference over its standard deviation";
  p.zero_line = true, p.points = true;
  p.note = "'number' of a mismatch in diagnosis.json; beyond 3 is rare by chance";
  p.curves.push_back(curve("retuned base", s.at(d.naming.base.coded)));
  if (d.naming.best) {
    const naming::Judged& best = d.naming.judged[*d.naming.best];
    const naming::Alternative& alternative = d.problem.alternatives[*d.naming.best];
    p.curves.push_back(curve(("with " + alternative.name).c_str(), s.at(best.fit.coded, naming::active_of(alternative, best.fit))));
  }
  drawer.curves(p, "mismatch");
}

/// A fitted parameter over the conditions' speeds, before and after.
void drift(const Told& t, Drawer& drawer) {
  for (std::size_t i = 0; i < t.question.study.parameters.size(); ++i) {
    CurvePicture p;
    p.title = t.question.study.parameters[i].name + " fitted to each condition alone";
    p.x_label = "speed of the mill", p.x_unit = "rad/s", p.value_label = t.question.study.parameters[i].name;
    p.points = true;
    Curve before{"base", {}, {}, {}, {}}, after{"with what is named", {}, {}, {}, {}};
    const auto add = [](Curve& c, double x, const base::Interval90& v) {
      c.x.push_back(x), c.value.push_back(v.value), c.low.push_back(v.low), c.high.push_back(v.high);
    };
    for (const Alone& a : t.diagnosis.alone) {
      add(before, t.question.speed[a.condition], a.before[i]);
      if (!a.after.empty()) add(after, t.question.speed[a.condition], a.after[i]);
    }
    p.curves.push_back(before);
    if (!after.x.empty()) p.curves.push_back(after);
    drawer.curves(p, "alone_" + std::to_string(i + 1));
  }
}

/// Observables of a held-out condition before and after.
void held_out(const Told& t, Drawer& drawer) {
  for (const HeldOut& h : t.diagnosis.held_out) {
    CurvePicture p;
    p.title = "Held out: " + t.question.study.conditions[h.condition].name;
    p.x_label = "observable", p.value_label = "difference over its standard deviation";
    p.zero_line = true, p.points = true;
    for (const Score& s : h.scores) {
      if (s.prediction.name != "corrected" && s.prediction.name != kToPower && s.prediction.name != "retuned to all observables") continue;
      Curve c{s.prediction.name, {}, {}, {}, {}};
      const VectorXd z = deviations(t, h, s);
      for (Index i = 0; i < z.size(); ++i) {
        if (!std::isfinite(z[i])) continue;
        c.x.push_back(static_cast<double>(i + 1)), c.value.push_back(z[i]);
      }
      p.curves.push_back(std::move(c));
    }
    drawer.curves(p, "held_out_" + std::to_string(h.condition + 1));
  }
}

/// Missing acceleration along the motion by speed.
void missing(const Told& t, Drawer& drawer) {
  CurvePicture p;
  p.title = "Missing mean acceleration along the motion", p.x_label = "speed over the shell's", p.x_unit = "1";
  p.value_label = "recording less retuned base", p.value_unit = "m/s²", p.zero_line = true;
  for (const MissingForce& m : t.diagnosis.missing) {
    Curve c{t.question.study.conditions[m.condition].name, {}, {}, {}, {}};
    for (const ForceBySpeed& s : m.by_speed) {
      c.x.push_back(0.5 * (s.low + s.high)), c.value.push_back(s.along.value);
      c.low.push_back(s.along.low), c.high.push_back(s.along.high);
    }
    if (c.x.size() > 1) p.curves.push_back(std::move(c));
  }
  if (!p.curves.empty()) drawer.curves(p, "missing_acceleration");
}

}  // namespace

VectorXd deviations(const Told& t, const HeldOut& held, const Score& score) {
  const calibrate::Observation& recorded = t.diagnosis.evidence.recorded[held.condition];
  return (recorded.value - score.prediction.value).array() / (held.variance + score.prediction.covariance.diagonal()).array().sqrt();
}

std::vector<fs::path> draw(const Told& told, const fs::path& folder) {
  fs::create_directories(folder);
  Drawer drawer{folder, {}};
  mismatch(told, drawer);
  drift(told, drawer);
  held_out(told, drawer);
  missing(told, drawer);
  return drawer.files;
}

}  // namespace millscope::diagnose
