// What a wear study leaves: wear.json, tables, pictures, and the liner of each stage for ParaView.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/columns.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/output/vtk.hpp"
#include "studies/picture/picture.hpp"
#include "studies/wear/wear.hpp"
#include "studies/wear/wear_away.hpp"

namespace millscope::wear {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::size_t kMostCurves = 6;  // in one picture

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : ""; }

/// Standard error of the radius, mean over rows.
std::vector<double> error_of_mean(const Stage& s) {
  std::vector<double> all(s.profile.columns, 0.0);
  for (std::size_t i = 0; i < s.error.size(); ++i) all[i % s.profile.columns] += s.error[i] * s.error[i];
  const auto rows = static_cast<double>(s.profile.rows);
  for (double& e : all) e = std::sqrt(e) / rows;
  return all;
}

/// The direction to begin with, so that the lifter stands in the middle: opposite to the middle of what stands out of the new shell.
std::size_t beginning_of(const Profile& p) {
  const std::vector<double> mean = p.mean_row();
  const double shell = *std::max_element(mean.begin(), mean.end()), turn = kTurn / static_cast<double>(p.columns);
  double x = 0, y = 0;
  for (std::size_t c = 0; c < p.columns; ++c) {
    x += (shell - mean[c]) * std::cos(turn * static_cast<double>(c));
    y += (shell - mean[c]) * std::sin(turn * static_cast<double>(c));
  }
  const double middle = std::atan2(y, x) / turn + 0.5 * static_cast<double>(p.columns);
  return static_cast<std::size_t>(std::lround(middle) + static_cast<long>(p.columns)) % p.columns;
}

std::vector<double> from(std::size_t beginning, std::vector<double> values) {
  std::rotate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(beginning), values.end());
  return values;
}

Json stage_json(const Stage& s, std::size_t beginning) {
  Json runs = Json::array();
  for (const fs::path& run : s.runs) runs.push_back(run.string());
  return {{"hours", s.hours},
          {"lifter_height_m", s.relief},
          {"lifter_left_m", s.lifter_left},
          {"plate_lost_m", s.plate_lost},
          {"volume_lost_m3", s.volume},
          {"volume_lost_error_m3", s.volume_error},
          {"volume_of_the_laws_m3", s.law_volume},
          {"volume_lost_by_faces_m3", s.face_volume},
          {"mass_lost_kg", s.mass},
          {"power_W", s.power},
          {"power_error_W", s.power_error},
          {"shoulder_deg", s.shoulder},
          {"toe_deg", s.toe},
          {"radius_m", from(beginning, s.profile.mean_row())},
          {"radius_error_m", from(beginning, error_of_mean(s))},
          {"runs", runs}};
}

Json json_of(const Found& found, const Request& r) {
  const Profile& p = found.stages.front().profile;
  const std::size_t beginning = beginning_of(p);
  std::vector<double> angles;
  for (std::size_t c = 0; c < p.columns; ++c) angles.push_back(kDegrees * p.step() * static_cast<double>(c + beginning));
  Json j{{"schema_version", 1},
         {"name", found.name},
         {"body", found.body},
         {"case", r.case_file.string()},
         {"settings", r.settings},
         {"seeds", r.seeds},
         {"steps", r.steps},
         {"pitches", p.pitches},
         {"rows", p.rows},
         {"z_m", {p.low, p.high}},
         {"smoothed_over_m", found.smooth},
         {"angle_deg", angles},
         {"stopped", found.stopped},
         {"doubts", found.doubts},
         {"stages", Json::array()}};
  for (const Stage& s : found.stages) j["stages"].push_back(stage_json(s, beginning));
  return j;
}

std::string csv_of(const Found& found) {
  std::string csv =
      "hours,lifter_height_m,lifter_left_m,plate_lost_m,volume_lost_m3,volume_lost_error_m3,mass_lost_kg,volume_lost_by_faces_m3,power_W,"
      "power_error_W,shoulder_deg,toe_deg\n";
  for (const Stage& s : found.stages) {
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", cell(s.hours), cell(s.relief), cell(s.lifter_left), cell(s.plate_lost),
                       cell(s.volume), cell(s.volume_error), cell(s.mass), cell(s.face_volume), cell(s.power), cell(s.power_error),
                       cell(s.shoulder), cell(s.toe));
  }
  return csv;
}

/// One line for each place of the profile; a column for each time.
std::string profiles_of(const Found& found) {
  const Profile& p = found.stages.front().profile;
  std::string csv = "z_m,angle_deg";
  for (const Stage& s : found.stages) csv += fmt::format(",radius_m_after_{:g}_h", s.hours);
  csv += ",error_m\n";
  for (std::size_t row = 0; row < p.rows; ++row) {
    for (std::size_t c = 0; c < p.columns; ++c) {
      csv += fmt::format("{:.9g},{:.9g}", p.low + (static_cast<double>(row) + 0.5) * p.row_length(),
                         kDegrees * p.step() * static_cast<double>(c));
      for (const Stage& s : found.stages) csv += fmt::format(",{:.9g}", s.profile.at(row, c));
      csv += fmt::format(",{:.3g}\n", found.stages.back().error[row * p.columns + c]);
    }
  }
  return csv;
}

/// Heights above the new shell along it, so that lifters stand upright.
void draw_profiles(const Found& found, const fs::path& folder) {
  const Profile& first = found.stages.front().profile;
  const double shell = *std::max_element(first.radius.begin(), first.radius.end());
  picture::CurvePicture picture;
  picture.title = "The liner wears away";
  picture.subtitle =
      fmt::format("{} · one of {} pitches, mean over {}", found.name, first.pitches, first.rows == 1 ? "the slice" : "the length");
  picture.x_label = "along the shell", picture.x_unit = "m";
  picture.value_label = "height above the new shell", picture.value_unit = "m";
  picture.band = "standard error";
  const std::size_t beginning = beginning_of(first), last = found.stages.size() - 1, count = std::min(last + 1, kMostCurves);
  for (std::size_t n = 0; n < count; ++n) {
    const Stage& s = found.stages[count == 1 ? 0 : n * last / (count - 1)];
    picture::Curve curve{fmt::format("{:.0f} h", s.hours), {}, {}, {}, {}};
    const std::vector<double> mean = from(beginning, s.profile.mean_row()), error = from(beginning, error_of_mean(s));
    for (std::size_t c = 0; c <= s.profile.columns; ++c) {
      const std::size_t k = c % s.profile.columns;
      curve.x.push_back(shell * s.profile.step() * static_cast<double>(c));
      curve.value.push_back(shell - mean[k]);
      curve.low.push_back(shell - mean[k] - error[k]);
      curve.high.push_back(shell - mean[k] + error[k]);
    }
    picture.curves.push_back(curve);
  }
  picture::draw_curves(picture, folder / "liner");
}

/// One number of the stages against hours.
struct Course {
  const char* file;
  const char* label;
  const char* unit;
  double Stage::*value;
  double Stage::*error;
};

void draw_course(const Found& found, const Course& course, const fs::path& folder) {
  picture::Curve curve{found.body, {}, {}, {}, {}};
  for (const Stage& s : found.stages) {
    if (!std::isfinite(s.*course.value)) continue;
    curve.x.push_back(s.hours);
    curve.value.push_back(s.*course.value);
    const double error = course.error != nullptr && std::isfinite(s.*course.error) ? s.*course.error : 0;
    curve.low.push_back(s.*course.value - error), curve.high.push_back(s.*course.value + error);
  }
  if (curve.x.size() < 2) return;
  picture::CurvePicture picture;
  picture.title = std::string(course.label) + " against hours";
  picture.subtitle = found.name;
  picture.x_label = "time", picture.x_unit = "h";
  picture.value_label = course.label, picture.value_unit = course.unit;
  picture.band = "standard error";
  picture.curves = {curve};
  picture::draw_curves(picture, folder / course.file);
}

/// Area of a triangle as it is seen from the axis, m².
double seen_from_axis(const std::vector<double>& vertices, const std::uint32_t* corners) {
  const double *v = &vertices[std::size_t{3} * corners[0]], *u = &vertices[std::size_t{3} * corners[1]],
               *w = &vertices[std::size_t{3} * corners[2]];
  const double x = v[0] + u[0] + w[0], y = v[1] + u[1] + w[1];
  const double a[3] = {u[0] - v[0], u[1] - v[1], u[2] - v[2]}, b[3] = {w[0] - v[0], w[1] - v[1], w[2] - v[2]};
  return 0.5 * std::fabs((a[1] * b[2] - a[2] * b[1]) * x + (a[2] * b[0] - a[0] * b[2]) * y) / std::hypot(x, y);
}

/// The liner with its loss so far: worn_volume_per_area is the depth along the normal, m.
void write_liner(const Stage& s, const Profile& first, const fs::path& file) {
  const Mesh mesh = mesh_of(s.profile, stretches_of(s.profile));
  std::vector<double> lost;
  for (std::size_t t = 0; t < mesh.materials.size(); ++t) {
    const std::uint32_t* corners = &mesh.triangles[3 * t];
    const Spot at = spot_of(mesh.vertices, corners, s.profile);
    const auto radius = [&](const Profile& p) { return 0.5 * (p.at(at.row, at.column) + p.at(at.row, at.column + 1)); };
    lost.push_back(at.on_face ? 0 : seen_from_axis(mesh.vertices, corners) * (radius(s.profile) - radius(first)));
  }
  output::write_mesh_vtp(file, {mesh.vertices, mesh.triangles, mesh.materials, {}, {}, lost});
}

}  // namespace

std::string table(const Found& found) {
  std::vector<base::Row> rows{
      {"hours", "lifter mm", "left mm", "plate lost mm", "lost cm3", "±", "lost kg", "power W", "±", "shoulder deg", "toe deg"}};
  const auto angle = [](double value) { return std::isfinite(value) ? fmt::format("{:.1f}", value) : std::string("none"); };
  for (const Stage& s : found.stages) {
    rows.push_back({fmt::format("{:.0f}", s.hours), fmt::format("{:.3g}", 1e3 * s.relief), fmt::format("{:.3g}", 1e3 * s.lifter_left),
                    fmt::format("{:.3g}", 1e3 * s.plate_lost), fmt::format("{:.4g}", 1e6 * s.volume),
                    fmt::format("{:.2g}", 1e6 * s.volume_error), fmt::format("{:.4g}", s.mass), fmt::format("{:.4g}", s.power),
                    fmt::format("{:.2g}", s.power_error), angle(s.shoulder), angle(s.toe)});
  }
  std::string said = base::columns_to_left(rows);
  if (!found.stopped.empty()) said += "\nstopped: " + found.stopped + "\n";
  for (const std::string& doubt : found.doubts) said += "\ndoubt: " + doubt + "\n";
  return said;
}

void write(const Found& found, const Request& request) {
  const fs::path& folder = request.output;
  output::write_file(folder / "wear.csv", csv_of(found));
  output::write_file(folder / "profiles.csv", profiles_of(found));
  const fs::path pictures = folder / "pictures";
  fs::create_directories(pictures);
  draw_profiles(found, pictures);
  for (const Course& course :
       {Course{"power", "power", "W", &Stage::power, &Stage::power_error}, Course{"mass", "mass lost", "kg", &Stage::mass, nullptr},
        Course{"lifter", "height of the lifters", "m", &Stage::relief, nullptr},
        Course{"shoulder", "shoulder", "deg", &Stage::shoulder, nullptr}, Course{"toe", "toe", "deg", &Stage::toe, nullptr}})
    draw_course(found, course, pictures);
  for (std::size_t k = found.stages.size(); fs::remove(folder / fmt::format("liner_{:02d}.vtp", k)); ++k) {  // of an earlier, longer study
  }
  for (std::size_t k = 0; k < found.stages.size(); ++k)
    write_liner(found.stages[k], found.stages.front().profile, folder / fmt::format("liner_{:02d}.vtp", k));
  output::write_json(folder / "wear.json", json_of(found, request));
}

}  // namespace millscope::wear
