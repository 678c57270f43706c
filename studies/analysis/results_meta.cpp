#include <cmath>

#include "studies/analysis/results_file.hpp"

namespace millscope::analysis {

using Json = nlohmann::ordered_json;

Json meta_json(const ResultMeta& meta) {
  Json j;
  j["source"] = meta.source;
  j["name"] = meta.name;
  j["description"] = meta.description;
  j["case_file"] = meta.case_file;
  j["seed"] = meta.seed;
  j["draws"] = meta.draws;
  j["confidence"] = meta.confidence;
  j["blocks"] = meta.blocks.size();
  j["block_duration_s"] = meta.block_duration;
  j["context"]["is_recording"] = meta.context.is_recording != 0;
  j["context"]["is_periodic"] = meta.context.is_periodic != 0;
  j["context"]["largest_id"] = meta.context.largest_id;
  j["context"]["has"] = meta.context.has;
  for (const ContextField& field : kContextFields) j["context"][field.name] = meta.context.*field.number;
  j["autocorrelation"] = Json::array();
  for (const ObservableTime& t : meta.times) {
    j["autocorrelation"].push_back(
        {{"name", t.name}, {"time_s", t.time}, {"effective", t.effective}, {"sets_the_block", t.sets_the_block}, {"n_eff", t.independent}});
  }
  if (!meta.runs.is_null()) j["runs"] = meta.runs;
  j["inputs"] = Json::array();
  for (const ResultFile& f : meta.inputs) j["inputs"].push_back({{"file", f.file}, {"hash", f.hash}});
  j["left_out"] = meta.left_out;
  j["notes"] = meta.notes;
  j["provenance"] = meta.provenance;
  return j;
}

void read_meta_json(const Json& j, ResultMeta& meta) {
  const auto number = [](const Json& value) { return value.is_null() ? std::nan("") : value.get<double>(); };
  meta.source = j.at("source").get<std::string>();
  meta.name = j.at("name").get<std::string>();
  meta.description = j.at("description").get<std::string>();
  meta.case_file = j.at("case_file").get<std::string>();
  meta.seed = j.at("seed").get<std::uint64_t>();
  meta.draws = j.at("draws").get<std::uint32_t>();
  meta.confidence = j.at("confidence").get<double>();
  meta.block_duration = number(j.at("block_duration_s"));
  meta.context.is_recording = j.at("context").at("is_recording").get<bool>() ? 1 : 0;
  meta.context.is_periodic = j.at("context").at("is_periodic").get<bool>() ? 1 : 0;
  meta.context.largest_id = j.at("context").at("largest_id").get<std::int64_t>();
  meta.context.has = j.at("context").at("has").get<std::uint64_t>();
  for (const ContextField& field : kContextFields) meta.context.*field.number = number(j.at("context").at(field.name));
  for (const Json& t : j.at("autocorrelation")) {
    meta.times.push_back({t.at("name").get<std::string>(), number(t.at("time_s")), number(t.at("effective")),
                          t.at("sets_the_block").get<bool>(), number(t.at("n_eff"))});
  }
  for (const Json& f : j.at("inputs")) meta.inputs.push_back({f.at("file").get<std::string>(), f.at("hash").get<std::string>()});
  if (j.contains("runs")) meta.runs = j.at("runs");
  meta.left_out = j.at("left_out").get<std::vector<std::string>>();
  meta.notes = j.at("notes").get<std::vector<std::string>>();
  meta.provenance = j.at("provenance");
}

}  // namespace millscope::analysis
