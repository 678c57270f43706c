#include "studies/diagnose/bank/bank_status.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "studies/campaign/cache.hpp"
#include "studies/campaign/reuse.hpp"
#include "studies/diagnose/bank/bank.hpp"

namespace millscope::diagnose {
namespace {

/// Work (beads × simulated time) of a cell's runs.
struct Work {
  double done = 0, rest = 0;
};

void count(const campaign::TaskRecord& record, double work, BankCell& cell, Work& of) {
  ++cell.planned;
  if (record.stage == campaign::Stage::done) {
    ++cell.done;
    cell.wall_s += record.wall_s;
    of.done += work;
  } else if (record.stage == campaign::Stage::failed) {
    ++cell.failed;
  } else {
    cell.running += record.stage == campaign::Stage::running ? 1 : 0;
    of.rest += work;
  }
}

/// rest = wall of what is done · work of the rest / work of what is done
void estimate(const std::vector<Work>& work, BankStatus& status) {
  double all = 0;
  for (const Work& w : work) all += w.done;
  status.estimated = all > 0;
  for (std::size_t k = 0; k < work.size(); ++k) {
    BankCell& cell = status.cells[k];
    if (work[k].done > 0)
      cell.rest_s = cell.wall_s * work[k].rest / work[k].done;
    else if (all > 0)
      cell.rest_s = status.total.wall_s * work[k].rest / all;
    status.total.rest_s += cell.rest_s;
  }
}

}  // namespace

std::vector<PlannedRun> planned_runs(const Question& q) {
  std::vector<PlannedRun> runs;
  const std::vector<BankPoint> points = plan_bank(q);
  const auto add = [&](const std::vector<BankPoint>& planned, const std::vector<std::size_t>& conditions) {
    const std::vector<campaign::Simulation> simulations = simulations_of(q, planned, conditions);
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      for (std::size_t p = 0; p < planned.size(); ++p)
        runs.push_back({planned[p].group, conditions[c], simulations[p * conditions.size() + c]});
    }
  };
  add(points, q.study.with_role(calibrate::Role::fit));
  add(held_out_points(q, points, {}), q.study.with_role(calibrate::Role::held_out));
  return runs;
}

BankStatus bank_status(const Question& q, const campaign::Options& options) {
  const campaign::Identifier identifier(options);
  BankStatus status;
  std::vector<Work> work;
  std::vector<campaign::Identity> missing;
  for (const PlannedRun& run : planned_runs(q)) {
    const auto same = [&](const BankCell& c) { return c.group == run.group && c.condition == run.condition; };
    auto cell = std::find_if(status.cells.begin(), status.cells.end(), same);
    if (cell == status.cells.end()) {
      status.cells.push_back({run.group, run.condition, 0, 0, 0, 0, 0, 0});
      work.emplace_back();
      cell = status.cells.end() - 1;
    }
    const campaign::Identity identity = identifier.identify(run.simulation);
    const campaign::TaskRecord record = campaign::Entry(options.cache, identity.key).read();
    count(record, identity.work, *cell, work[cell - status.cells.begin()]);
    if (record.stage != campaign::Stage::done) missing.push_back(identity);
    if (record.stage == campaign::Stage::failed) status.failures.push_back(fmt::format("{}: {}", run.simulation.label, record.message));
  }
  for (const BankCell& c : status.cells) {
    status.total.planned += c.planned, status.total.done += c.done, status.total.failed += c.failed;
    status.total.running += c.running, status.total.wall_s += c.wall_s;
  }
  estimate(work, status);
  status.other_programs = campaign::other_programs_sentence(options.cache, missing);
  return status;
}

std::string duration_text(double seconds) {
  constexpr double kMinute = 60, kHour = 3600;
  if (seconds < 1.5 * kMinute) return fmt::format("{:.0f} s", seconds);
  return seconds < 1.5 * kHour ? fmt::format("{:.0f} min", seconds / kMinute) : fmt::format("{:.1f} h", seconds / kHour);
}

std::string status_text(const Question& q, const BankStatus& s, int slots) {
  std::size_t wide = 28;
  for (const BankCell& c : s.cells) wide = std::max(wide, c.group.size());
  std::string out = fmt::format("{:<{}} {:<14} {:>7} {:>5} {:>6} {:>7} {:>7} {:>10}\n", "group", wide, "condition", "planned", "done",
                                "failed", "running", "waiting", "rest");
  const auto row = [&](const std::string& group, const std::string& condition, const BankCell& c) {
    const bool open = c.waiting() + c.running > 0;
    fmt::format_to(std::back_inserter(out), "{:<{}} {:<14} {:>7} {:>5} {:>6} {:>7} {:>7} {:>10}\n", group, wide, condition, c.planned,
                   c.done, c.failed, c.running, c.waiting(),
                   !open         ? "-"
                   : s.estimated ? duration_text(c.rest_s)
                                 : "?");
  };
  for (const BankCell& c : s.cells) row(c.group, q.study.conditions[c.condition].name, c);
  row("all", "", s.total);
  for (const std::string& line : s.failures) fmt::format_to(std::back_inserter(out), "failed: {}\n", line);
  if (!s.other_programs.empty()) out += s.other_programs + "\n";
  if (s.total.waiting() + s.total.running == 0)
    out += "the bank is whole\n";
  else if (s.estimated)
    fmt::format_to(std::back_inserter(out),
                   "the rest takes about {} on one core, {} with {} at once, by the times of the {} that are done\n",
                   duration_text(s.total.rest_s), duration_text(s.total.rest_s / slots), slots, s.total.done);
  else
    out += "none is done yet that would tell how long they take\n";
  return out;
}

}  // namespace millscope::diagnose
