// diagnosis.json.
#include <algorithm>
#include <cmath>

#include "studies/diagnose/pages/outputs.hpp"

namespace millscope::diagnose {
namespace {

using Json = nlohmann::ordered_json;

Json interval(const base::Interval90& i) { return {{"value", i.value}, {"low90", i.low}, {"high90", i.high}}; }

Json parameters(const Told& t, const std::vector<base::Interval90>& theta) {
  Json out = Json::object();
  for (std::size_t i = 0; i < theta.size(); ++i) out[t.diagnosis.problem.data.theta[i].name] = interval(theta[i]);
  return out;
}

Json by_name(const Told& t, const VectorXd& theta) {
  Json out = Json::object();
  for (Index i = 0; i < theta.size(); ++i) out[t.diagnosis.problem.data.theta[i].name] = theta[i];
  return out;
}

/// Of the surrogate, in the strength of each candidate.
Json degrees(const Told& t) {
  Json out = Json::object();
  for (std::size_t j = 0; j < t.question.candidates.size(); ++j) out[t.question.candidates[j].name] = t.diagnosis.problem.data.degree[j];
  return out;
}

Json logarithmic(const naming::BankData& data) {
  Json out = Json::array();
  for (const naming::Coordinate& c : data.theta) {
    if (c.logarithmic) out.push_back(c.name);
  }
  return out;
}

/// The fitted value of the candidate's own parameter.
Json own_parameter(const Told& t, Index j) {
  const naming::Alternative& alternative = t.diagnosis.problem.alternatives[j];
  const naming::Judged& judged = t.diagnosis.naming.judged[j];
  if (alternative.freed) {
    const naming::Coordinate& c = t.diagnosis.problem.data.theta[*alternative.freed];
    return {{c.name, interval(judged.theta[*alternative.freed])}};
  }
  const Candidate& c = t.question.candidates[*alternative.candidate];
  if (c.on_or_off()) return {{"strength", interval(naming::without_interval(judged.strength.value))}};  // there is nothing between
  Json out = interval(parameter_at(c, judged.strength));
  out["unit"] = c.unit;
  out["vanishes_at"] = c.null_value;
  return {{c.parameter, out}};
}

std::string class_of(const Diagnosis& d, Index j) {
  if (d.naming.best == j) return "best";
  if (std::find(d.naming.kept.begin(), d.naming.kept.end(), j) != d.naming.kept.end()) return "not rejected";
  return d.naming.judged[j].undetectable ? "undetectable" : d.naming.best ? "rejected" : "not needed";
}

/// Part of the mill that an observable of a fitted condition looks at: names of regional ones are "speed toe".
std::string region_of(const Told& t, std::size_t condition, Index observable) {
  Index first = 0;
  for (const std::size_t c : t.diagnosis.fit) {
    if (c == condition) break;
    first += t.diagnosis.evidence.recorded[c].value.size();
  }
  const calibrate::Observable& o = t.diagnosis.evidence.recorded[condition].observables[observable - first];
  const bool regional = o.kind == calibrate::ObservableKind::occupancy || o.kind == calibrate::ObservableKind::region_speed;
  return regional ? o.name.substr(o.name.find(' ') + 1) : "whole mill";
}

/// λ of a candidate against its strength; nothing for a nuisance.
Json lambda_curve(const Told& t, Index alternative) {
  Json out = Json::array();
  for (const auto& [strength, lambda] : t.diagnosis.naming.judged[alternative].lambda_curve)
    out.push_back({{"strength", strength}, {"lambda", lambda}});
  return out;
}

Json hypotheses(const Told& t) {
  Json out = Json::array();
  const Diagnosis& d = t.diagnosis;
  for (Index j = 0; j < std::ssize(d.naming.judged); ++j) {
    const naming::Judged& g = d.naming.judged[j];
    const bool compared = d.naming.best && d.naming.best != j;
    out.push_back({{"name", d.problem.alternatives[j].name},
                   {"kind", d.problem.alternatives[j].freed ? "nuisance" : "physics"},
                   {"class", class_of(d, j)},
                   {"p_value", g.p_family},
                   {"p_value_alone", g.p},
                   {"delta_q", g.delta_q},
                   {"kappa", g.kappa},
                   {"lambda", g.lambda},
                   {"lambda_found", g.lambda_found},
                   {"lambda_at", lambda_curve(t, j)},
                   {"lambda_beside", g.lambda_beside},
                   {"undetectable", g.undetectable},
                   {"tested", g.tested},
                   {"p_against_best", compared ? Json(g.against_best_p) : Json()},
                   {"p_goodness", g.goodness_p},
                   {"parameters", own_parameter(t, j)},
                   {"contact_parameters", parameters(t, g.theta)}});
  }
  return out;
}

Json held_out(const Told& t) {
  Json out = Json::array();
  for (const HeldOut& h : t.diagnosis.held_out) {
    Json scores = Json::array();
    for (const Score& s : h.scores) {
      Json one = {{"model", s.prediction.name},
                  {"is", s.prediction.sentence},
                  {"simulated", s.prediction.simulated && !s.prediction.computed},
                  {"from", s.prediction.simulated ? "simulations" : "surrogate"},
                  {"parameters", by_name(t, s.prediction.theta)},
                  {"misfit", s.misfit},
                  {"power_W", s.prediction.power},
                  {"power_percent", s.power_percent}};
      if (s.prediction.name != "corrected") {
        one["judged_difference"] = s.reliance.difference, one["left_out_error"] = s.reliance.error;
        if (t.diagnosis.naming.best) one["improvement_of_corrected"] = interval(s.improvement);
      }
      scores.push_back(std::move(one));
    }
    Json names = Json::array();
    const calibrate::Observation& recorded = t.diagnosis.evidence.recorded[h.condition];
    for (std::size_t i = 0; i < recorded.observables.size(); ++i) {
      Json row = {{"observable", recorded.observables[i].name}, {"unit", recorded.observables[i].unit}, {"recorded", recorded.value[i]}};
      for (const Score& s : h.scores) row[s.prediction.name] = s.prediction.value[i];
      names.push_back(std::move(row));
    }
    for (const Score& s : h.scores) {
      const VectorXd z = deviations(t, h, s);
      for (std::size_t i = 0; i < names.size(); ++i) names[i]["z"][s.prediction.name] = z[i];
    }
    out.push_back({{"condition", t.question.study.conditions[h.condition].name},
                   {"recorded_power_W", recorded.power.value},
                   {"simulations", h.simulations},
                   {"p_base", h.base_p},
                   {"improves_on_every_rival", h.improves},
                   {"models", scores},
                   {"observables", names}});
  }
  return out;
}

Json per_speed(const Told& t) {
  Json out = Json::array();
  for (const Alone& a : t.diagnosis.alone) {
    out.push_back({{"condition", t.question.study.conditions[a.condition].name},
                   {"speed_rad_per_s", t.question.speed[a.condition]},
                   {"before", parameters(t, a.before)},
                   {"after", parameters(t, a.after)}});
  }
  return out;
}

Json missing(const Told& t) {
  Json out = Json::array();
  for (const MissingForce& m : t.diagnosis.missing) {
    Json cells = Json::array(), speeds = Json::array();
    for (const ForceCell& c : m.cells) {
      cells.push_back({{"r_m", {c.r_low, c.r_high}},
                       {"angle_deg", {c.angle_low, c.angle_high}},
                       {"x_m_per_s2", interval(c.x)},
                       {"y_m_per_s2", interval(c.y)},
                       {"p_value", c.p}});
    }
    for (const ForceBySpeed& s : m.by_speed)
      speeds.push_back({{"speed_over_shell", {s.low, s.high}}, {"along_motion_m_per_s2", interval(s.along)}});
    out.push_back({{"condition", t.question.study.conditions[m.condition].name}, {"cells", cells}, {"by_speed", speeds}});
  }
  return out;
}

Json offered(const TermOffer& offer) {
  Json terms = Json::array();
  for (const OfferedTerm& t : offer.terms) {
    terms.push_back({{"name", t.name},
                     {"equation", t.equation},
                     {"unit", t.unit},
                     {"coefficient", interval(t.coefficient)},
                     {"share_of_halves", t.share}});
  }
  return {{"sentence", sentence_of(offer)}, {"cells", offer.cells}, {"explained", offer.explained}, {"terms", terms}};
}

}  // namespace

Json diagnosis_json(const Told& t) {
  const Diagnosis& d = t.diagnosis;
  Json mismatch = Json::array();
  for (const naming::Mismatch& m : d.naming.mismatch) {
    const Index c = d.problem.data.condition[m.observable];
    mismatch.push_back({{"observable", observable_name(t, m.observable)},
                        {"region", region_of(t, c, m.observable)},
                        {"number", m.observable + 1},
                        {"condition", t.question.study.conditions[c].name},
                        {"z", m.z},
                        {"p_value", m.p},
                        {"sentence", mismatch_sentence(t, m)}});
  }
  Json contact = {{"retuned", parameters(t, d.naming.base_theta)}};
  if (d.naming.best) {
    const naming::Judged& best = d.naming.judged[*d.naming.best];
    const std::vector<naming::ActiveCandidate> active = naming::active_of(d.problem.alternatives[*d.naming.best], best.fit);
    if (naming::ends_of(d.problem, best.fit.coded, active).empty()) contact["unmasked"] = parameters(t, best.theta);
  }
  Json pairs = Json::array();
  for (const naming::Pair& p : d.naming.pairs) {
    pairs.push_back({{"first", d.problem.alternatives[p.first].name},
                     {"second", d.problem.alternatives[p.second].name},
                     {"p_second", p.p},
                     {"p_first", p.p_first},
                     {"p_goodness", p.goodness_p}});
  }
  return {{"schema_version", 2},
          {"verdict", name_of(d.verdict)},
          {"sentence", d.sentence},
          {"named", d.named},
          {"named_together", d.two_effects},
          {"next_experiment", d.next_experiment},
          {"level", d.question.level},
          {"base", {{"p_value", d.naming.base_p}, {"q", d.naming.base.q}, {"observables", d.problem.observed.size()}}},
          {"hypotheses", hypotheses(t)},
          {"two_effects", pairs},
          {"mismatch", mismatch},
          {"contact_parameters", contact},
          {"moved_by_practice", moved_by_practice(t)},
          {"per_speed_friction", per_speed(t)},
          {"held_out", held_out(t)},
          {"missing_acceleration", missing(t)},
          {"offered_terms", d.missing.empty() ? Json() : offered(d.terms)},
          {"bank",
           {{"parameter_sets", d.bank.points.size()},
            {"used", d.problem.data.rows.size()},
            {"chance", d.naming.chance},
            {"degree", degrees(t)},
            {"logarithmic", logarithmic(t.diagnosis.problem.data)},
            {"failures", d.bank.failures}}},
          {"doubts", campaign::doubts_json(d.doubts)},
          {"notes", d.notes},
          {"study", t.question.study.file.string()}};
}

}  // namespace millscope::diagnose
