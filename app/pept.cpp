// `millscope pept`: what a camera saw. Each action is a function with options of its own.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "app/actions.hpp"
#include "app/commands.hpp"
#include "kernel/output/file.hpp"
#include "studies/inspect/report.hpp"

namespace millscope::app {
namespace {

int inspect(const Arguments& arguments) {
  Options options("pept inspect RECORDING [--json]",
                  "Says how good a recording is and what it can support, from its points alone: time covered, noise, losses, circulations, "
                  "the mill's axis, sense, "
                  "speed and radius, the vertical direction from free flight, coverage along the axis; for a tracer on a rotor its radius "
                  "and plateaus of speed. "
                  "Every figure has a 90 % interval or the reason why it cannot be said.",
                  "millscope pept inspect run1.a");
  options.positional("RECORDING", "a recording (.a, .csv, .tsv, .txt, .gz of one) or a recording.yaml with several");
  options.add()("json", "print JSON; units are in the names of the keys");
  if (!options.parse(arguments)) return kDone;
  const inspect::Inspection inspection = inspect::inspect(recording::read_recording(options.text("RECORDING")));
  fmt::print("{}", options.has("json") ? inspect::inspection_json(inspection).dump(2) + "\n" : inspect::inspection_text(inspection));
  return kDone;
}

int convert(const Arguments& arguments) {
  Options options(
      "pept convert RECORDING -o tracks.h5",
      "Writes the points of a recording that are used, in the layout of a simulation's tracks: a group per run, in the frame of the "
      "file after 'axes'. What that layout has no place for is left: spreads, events, the condition.",
      "millscope pept convert run1.a -o run1.h5");
  options.positional("RECORDING", "a recording (.a, .csv, .tsv, .txt, .gz of one) or a recording.yaml with several");
  options.add()("output,o", boost::program_options::value<std::string>()->value_name("tracks.h5"), "file to write");
  options.add()("force", "overwrite the file");
  if (!options.parse(arguments)) return kDone;
  const std::string file = options.text("output");
  if (!options.has("force")) output::refuse_existing(file);
  const recording::Recording recording = recording::read_recording(options.text("RECORDING"));
  recording::write_tracks(recording, file);
  std::size_t points = 0;
  for (const recording::Run& run : recording.runs) points += run.size();
  fmt::print("wrote {} ({} points of {} run{})\n", file, points, recording.runs.size(), recording.runs.size() == 1 ? "" : "s");
  return kDone;
}

constexpr Action kPeptActions[] = {
    {"inspect", "how good a recording is and what it can support", inspect},
    {"convert", "the points of a recording in the layout of a simulation's tracks", convert},
    {"camera", "estimate the camera of a recording", pept_camera},
    {"synthesize", "what a camera would have recorded of simulated beads", pept_synthesize},
};

}  // namespace

int pept(const Arguments& arguments) {
  return call_action(
      {"pept", "Recordings of a tracer in a mill (positron emission particle tracking).", kPeptActions, "millscope pept inspect run1.a"},
      arguments);
}

}  // namespace millscope::app
