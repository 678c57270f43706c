// How a liner wears away: simulate, take from its profile what the wear laws say for some hundred hours, go on with what is left.
//
// OUT/stages/NN/     the case of each stage: liner as mesh (STL), worn so far
// OUT/cache/         its simulations (studies/campaign): each computed once, also after a stop
// OUT/wear.json, wear.csv, profiles.csv, pictures, liner_NN.vtp      what came out
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kernel/host/registry.hpp"
#include "studies/campaign/campaign.hpp"
#include "studies/wear/profile.hpp"

namespace millscope::wear {

struct Request {
  std::filesystem::path case_file;
  std::vector<std::string> settings;  ///< "path.to.key=value", as `--set`
  std::filesystem::path output;
  double hours = 0;       ///< of running
  int steps = 8;          ///< in which they pass
  int seeds = 2;          ///< simulations of each stage, from other starts
  std::string body = {};  ///< the geometry that wears; "": the one that turns
  int pitches = 0;        ///< 0: found out
  int rows = 0;           ///< along the mill; 0: one for a slice, else about two beads long
  double plate = 0;       ///< m of metal behind the shell; when it is through the study stops; 0: not known
  double smooth = 0;      ///< m; 0: the largest bead's radius
  campaign::Options campaign;
  std::function<void(const std::string&)> say = {};  ///< one line as each stage is done
};

/// The liner at one time.
struct Stage {
  double hours = 0;
  Profile profile;
  std::vector<double> error;          ///< [rows, columns] standard error of the radius, m, from pitches and seeds
  double volume = 0, mass = 0;        ///< lost so far, m³, kg
  double volume_error = 0;            ///< its standard error, m³
  double law_volume = 0;              ///< what the laws said so far, m³, end faces left out
  double face_volume = 0;             ///< m³ from the end faces so far; they stay where they are
  double relief = 0;                  ///< from the lowest to the highest place, which lifts the charge, m
  double lifter_left = 0;             ///< how far the lifters stand above the new shell, m
  double plate_lost = 0;              ///< how far its deepest place is beyond the deepest of the new liner, m
  double power = 0, power_error = 0;  ///< W, of the liner as it is
  double shoulder = 0, toe = 0;       ///< deg; NaN: there is none
  std::vector<std::filesystem::path> runs;
};

struct Found {
  std::string name, body;
  std::vector<Stage> stages;
  double smooth = 0;    ///< m
  std::string stopped;  ///< why before the last hour; "" where it was not
  std::vector<std::string> doubts;
};

/// Throws UserError where the case has no wear laws or no liner that can wear; campaign::Interrupted.
Found wear(const Request& request, const host::Registry& registry);

/// Writes the results of `wear` into its output.
void write(const Found& found, const Request& request);
/// What people read on the terminal.
std::string table(const Found& found);

}  // namespace millscope::wear
