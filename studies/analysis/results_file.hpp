// Names that the writer and the reader of results.h5 share.
#pragma once

#include <array>
#include <string>

#include <nlohmann/json.hpp>

#include "studies/analysis/results.hpp"

namespace millscope::analysis {

inline constexpr const char* kResultsFormat = "millscope results";

/// The numbers of AnalyzerContext as attributes of the group `context`.
struct ContextField {
  const char* name;
  const char* unit;
  double AnalyzerContext::*number;
};
inline constexpr std::array<ContextField, 14> kContextFields{{{"mill_radius", "m", &AnalyzerContext::mill_radius},
                                                              {"mill_low", "m", &AnalyzerContext::mill_low},
                                                              {"mill_high", "m", &AnalyzerContext::mill_high},
                                                              {"mill_length", "m", &AnalyzerContext::mill_length},
                                                              {"omega", "rad/s", &AnalyzerContext::omega},
                                                              {"gravity", "m/s^2", &AnalyzerContext::gravity},
                                                              {"charge_mass", "kg", &AnalyzerContext::charge_mass},
                                                              {"charge_count", "1", &AnalyzerContext::charge_count},
                                                              {"bead_radius", "m", &AnalyzerContext::bead_radius},
                                                              {"bead_density", "kg/m^3", &AnalyzerContext::bead_density},
                                                              {"filling", "1", &AnalyzerContext::filling},
                                                              {"porosity", "1", &AnalyzerContext::porosity},
                                                              {"start", "s", &AnalyzerContext::start},
                                                              {"end", "s", &AnalyzerContext::end}}};

/// What of ResultMeta is text: as one JSON document, for results.h5 and results.json alike.
nlohmann::ordered_json meta_json(const ResultMeta& meta);
void read_meta_json(const nlohmann::ordered_json& json, ResultMeta& meta);

}  // namespace millscope::analysis
