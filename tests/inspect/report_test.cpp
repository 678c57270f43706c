// What is printed says what was found.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "inspect/synthetic.hpp"
#include "studies/inspect/report.hpp"

using namespace millscope;

TEST_CASE("JSON holds the figures, units in the keys, and null where there is none") {
  const inspect::Inspection i = inspect::inspect(make_recording(test::SyntheticMill{}));
  const auto j = nlohmann::json::parse(inspection_json(i).dump());
  CHECK(j["mill"]["sense"] == "clockwise");
  CHECK(j["mill"]["axis_x_m"]["value"] == i.motion.axis[0].estimate->value);
  CHECK(j["mill"]["angular_speed_rad_per_s"]["low"] < 6.0);
  CHECK(j["recording"]["points"] == i.coverage.points);
  CHECK(j["circulations"]["count"] == i.circulations.count);
  CHECK(j["losses"]["by_speed"].back()["high_m_per_s"].is_null());
  CHECK(j["rotor"].is_null());
  CHECK(j["verdicts"].size() == i.verdicts.size());
  test::SyntheticMill brief;
  brief.seconds = 0.3;
  const auto nothing = nlohmann::json::parse(inspection_json(inspect::inspect(make_recording(brief))).dump());
  CHECK(nothing["mill"]["path_radius_m"]["value"].is_null());
  CHECK_FALSE(nothing["mill"]["path_radius_m"]["note"].get<std::string>().empty());
}

TEST_CASE("the text names sense, speed and verdicts") {
  const std::string text = inspection_text(inspect::inspect(make_recording(test::SyntheticMill{})));
  for (const char* part : {"clockwise, z towards the viewer (Omega < 0)", "57.", "rpm", "What it supports", "occupancy maps", "power"}) {
    INFO(part);
    CHECK(text.find(part) != std::string::npos);
  }
}

TEST_CASE("a speed that is stated is held against the one found") {
  recording::Recording recording = make_recording(test::SyntheticMill{});
  const auto line = [&](double stated) {
    recording.condition.angular_velocity = stated;
    recording.condition.speed = std::fabs(stated);
    const std::string text = inspection_text(inspect::inspect(recording));
    const std::size_t at = text.find("speed that is stated");
    return at == std::string::npos ? std::string() : text.substr(at, text.find('\n', at) - at);
  };
  CHECK(line(-6).find("within the interval") != std::string::npos);
  CHECK(line(-6.6).find("outside the interval") != std::string::npos);
  CHECK(line(6).find("the other way round") != std::string::npos);
  CHECK(line(-600).find("far outside the interval") != std::string::npos);
  recording.condition = {};
  recording.condition.speed = 6.6;  // without a sense
  const std::string text = inspection_text(inspect::inspect(recording));
  CHECK(text.find("63.03 rpm, outside the interval") != std::string::npos);
}

TEST_CASE("how the files were read is told once for each way") {
  recording::Recording recording = make_recording(test::SyntheticMill{});
  recording.runs[0].format = "table, comma: t s (column 2)";
  recording.runs.push_back(recording.runs[0]);
  const inspect::Inspection i = inspect::inspect(recording);
  CHECK(inspection_text(i).find("\nread as table, comma: t s (column 2)\n(intervals") != std::string::npos);
  CHECK(inspection_json(i)["formats"].size() == 1);
}

TEST_CASE("a rotor's text has its plateaus in rpm") {
  const std::string text = inspection_text(inspect::inspect(make_recording(test::SyntheticRotor{})));
  CHECK(text.find("30.0") != std::string::npos);
  CHECK(text.find("57.") != std::string::npos);
  CHECK(text.find("114.") != std::string::npos);
  CHECK(text.find("Circulations") == std::string::npos);
}
