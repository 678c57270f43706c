#include <fstream>

#include "studies/calibrate/recordings.hpp"
#include "tests/calibrate/made_up_mill.hpp"

using namespace millscope;
using namespace millscope::calibrate;
using testing::Folder;
using testing::message_of;

namespace {

/// A recording of 40 points on a circle, with a condition.
void write_recording(const Folder& folder, const std::string& condition) {
  std::string rows;
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.05 * i;
    rows += std::to_string(5 * i) + "," + std::to_string(100 * std::cos(angle)) + "," + std::to_string(-100 * std::sin(angle)) + ",10\n";
  }
  folder.write("r.csv", "t,x,y,z\n" + rows);
  folder.write("r.yaml", "files: [r.csv]\ncondition: {" + condition + "}\n");
}

std::string refusal(const std::string& condition, const std::string& parameter) {
  const Folder folder;
  write_recording(folder, condition);
  const auto file = folder.write("s.yaml", std::string("base: ") + MILLSCOPE_SOURCE_DIR + "/configs/chagas2015/slice_75.yaml\n" +
                                               "conditions:\n  dry: {recording: r.yaml, role: fit}\nparameters:\n  " + parameter + "\n");
  const Study study = read_study(file);
  static const host::Registry registry;
  const std::string message = message_of([&] {
    check_study(study, registry);
    check_recordings(study, read_recordings(study), registry);
  });
  const std::string prefix = folder.path.string() + "/";
  return message.rfind(prefix, 0) == 0 ? message.substr(prefix.size()) : message;
}

const std::string kFriction = "pairs.glass~glass.static_friction: {range: [0.1, 0.8]}";
const std::string kMill = "mill_diameter: 300 mm, bead_diameter: 5 mm, filling: 31.3 %, speed: 75 %critical, direction: clockwise";

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a recording of this mill and a parameter of its plugins are taken") { CHECK(refusal(kMill, kFriction) == ""); }

TEST_CASE("recordings of another mill are refused, both are named") {
  const std::string diameter = refusal("mill_diameter: 460 mm, bead_diameter: 5 mm", kFriction);
  CHECK(holds(diameter, "s.yaml:3: condition 'dry':"));
  CHECK(holds(diameter, "r.yaml was made with a mill diameter of 460 mm, but the case"));
  CHECK(holds(diameter, "has 300 mm"));
  CHECK(holds(refusal("mill_diameter: 300 mm, bead_diameter: 10 mm", kFriction), "bead size of 10 mm"));
  CHECK(holds(refusal("mill_diameter: 300 mm, bead_diameter: 5 mm, filling: 40 %", kFriction), "filling of 40 %"));
  CHECK(holds(refusal("mill_diameter: 300 mm, bead_diameter: 5 mm, speed: 60 %critical", kFriction), "turning speed of"));
}

TEST_CASE("parameters that mean nothing are refused at their line") {
  const std::string unknown = refusal(kMill, "pairs.glass~glass.static_fricton: {range: [0.1, 0.8]}");
  CHECK(holds(unknown, "s.yaml:5: parameter 'pairs.glass~glass.static_fricton' at 0.1"));
  CHECK(holds(unknown, "static_friction"));
  CHECK(holds(refusal(kMill, "pairs.glass~glass.restitution: {range: [0.1, 1.8]}"),
              "s.yaml:5: parameter 'pairs.glass~glass.restitution' at 1.8"));
}
