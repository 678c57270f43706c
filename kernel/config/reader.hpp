// Parts of the case reader; for the files of this room only. Each reads one section and throws UserError.
#pragma once

#include <map>
#include <string>

#include "kernel/config/case.hpp"
#include "kernel/config/units.hpp"

namespace millscope::config {

/// Names that become path segments: letters, digits, '_' and '-', beginning with a letter.
void check_name(const std::string& name, const Location& where, const char* what);
/// A text that must be the name of a material.
std::string read_material_name(const Node& node, const std::vector<MaterialCase>& materials);

double number_or(const Node& section, std::string_view key, std::string_view si_unit, const Range& range, double fallback);

/// `elastic`: each has moduli, without which nothing can be computed.
std::vector<MaterialCase> read_materials(const Node& section, bool elastic);
std::map<std::string, std::string> read_groups(const std::optional<Node>& section, const std::vector<MaterialCase>& materials);
/// Adds the values that `like` and `times` of each pair stand for.
void complete_pairs(const Node& section);
PairTable read_pairs(const Node& section, const std::optional<Node>& groups, const std::vector<MaterialCase>& materials);
/// `shares_by_mass`: how `share` of the classes is counted.
std::vector<BeadCase> read_beads(const Node& section, const std::vector<MaterialCase>& materials, bool shares_by_mass);
/// Diameters and fractions of one bead class, by number.
std::vector<SizeClass> read_sizes(const Node& bead);
FillCase read_fill(const Node& section);
bool read_shares_by_mass(const Node& fill);
std::vector<PluginInstance> read_instances(const Node& section, const char* what);
ContactCase read_contact(const Node& section);
MillCase read_mill(const Node& section, double largest_diameter);
MotionCase read_motion(const Node& node, const std::optional<MillCase>& mill);
std::vector<GeometryCase> read_geometry(const Node& section, const Case& c);
DomainCase read_domain(const Node& section);
TimeCase read_time(const Node& section);
StartCase read_start(const Node& section, const TimeCase& time);
OutputCase read_output(const std::optional<Node>& section, const TimeCase& time);
RunCase read_run(const Node& section);

}  // namespace millscope::config
