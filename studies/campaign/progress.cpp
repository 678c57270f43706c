#include "studies/campaign/progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace millscope::campaign {

ProgressLine::ProgressLine(bool quiet, std::size_t total) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) != 0), total_(total) {}

double ProgressLine::elapsed() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

void ProgressLine::count(bool done, bool cached, double work, double wall) {
  ++(done ? done_ : failed_);
  if (done && cached) ++cached_;
  if (!done || wall <= 0) return;
  known_work_ += work;
  known_wall_ += wall;
}

bool ProgressLine::due() const { return !quiet_ && elapsed() >= next_; }

std::string ProgressLine::counts() const {
  std::string text = fmt::format("{} of {} done", done_, total_);
  if (cached_ > 0) text += fmt::format(" ({} from the cache)", cached_);
  if (failed_ > 0) text += fmt::format(", {} failed", failed_);
  return text;
}

std::optional<double> ProgressLine::time_left(const std::vector<Underway>& underway, double waiting, int slots) const {
  double work = known_work_, wall = known_wall_;
  if (wall <= 0) {
    for (const Underway& u : underway) {
      if (u.fraction <= 0) continue;
      work += u.fraction * u.work;
      wall += u.elapsed;
    }
  }
  if (work <= 0 || wall <= 0) return {};
  const double rate = wall / work;
  double all = waiting * rate, longest = 0;
  for (const Underway& u : underway) {
    const double by_clock = u.work * rate - u.elapsed, by_series = (1 - u.fraction) * u.work * rate;
    const double left = std::max(0.0, std::min(by_clock, by_series));
    all += left;
    longest = std::max(longest, left);
  }
  return std::max(longest, all / std::max(1, slots));
}

void ProgressLine::update(const std::vector<Underway>& underway, double waiting, int slots) {
  if (!due()) return;
  const std::optional<double> left = time_left(underway, waiting, slots);
  const std::string text = fmt::format("campaign: {}, {} running, {}", counts(), underway.size(),
                                       left ? "ETA " + output::duration_text(*left) : "ETA not known yet");
  if (terminal_) {
    line_.draw(text);
    next_ = elapsed() + 0.5;
  } else {
    fmt::print(stderr, "{}\n", text);
    next_ = elapsed() + interval_;
    interval_ = std::min(300.0, interval_ * 1.5);
  }
}

double simulated_time(const std::filesystem::path& run) {
  constexpr std::streamoff kTail = 4096;
  std::ifstream in(run / "series.csv", std::ios::binary | std::ios::ate);
  if (!in) return 0;
  const std::streamoff size = in.tellg(), from = std::max<std::streamoff>(0, size - kTail);
  std::string tail(size - from, '\0');
  in.seekg(from);
  in.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  const std::size_t end = tail.rfind('\n');  // what follows is a row in the making
  if (end == std::string::npos || end == 0) return 0;
  const std::size_t begin = tail.rfind('\n', end - 1);
  return begin == std::string::npos ? 0 : std::max(0.0, std::strtod(tail.c_str() + begin + 1, nullptr));
}

}  // namespace millscope::campaign
