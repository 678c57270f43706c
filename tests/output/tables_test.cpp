#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kernel/base/text.hpp"
#include "kernel/output/csv.hpp"
#include "kernel/output/series.hpp"
#include "kernel/output/summary.hpp"
#include "output/support.hpp"

using millscope::base::text_of;
using namespace millscope::output;
using namespace output_test;
using Catch::Contains;

namespace {

const std::vector<std::string> kColumns{"time_s", "kinetic_energy_J"};

void write(SeriesWriter& writer, int from, int to) {
  for (int k = from; k < to; ++k) writer.append(std::vector<double>{0.01 * k, std::sqrt(k)});
}

}  // namespace

TEST_CASE("a resumed series equals that of an uninterrupted run, byte for byte") {
  const Scratch scratch;
  SeriesWriter whole = SeriesWriter::create(scratch / "whole.csv", kColumns);
  write(whole, 0, 9000);
  whole.close();
  {
    SeriesWriter first = SeriesWriter::create(scratch / "series.csv", kColumns);
    write(first, 0, 7000);
  }
  spill(scratch / "series.csv", text_of(scratch / "series.csv") + "70.0");  // a row cut short by a kill
  {
    SeriesWriter second = SeriesWriter::resume(scratch / "series.csv", kColumns, 0.01 * 5000);
    write(second, 5001, 8000);
  }
  spill(scratch / "series.csv", text_of(scratch / "series.csv") + "1");
  {
    SeriesWriter third = SeriesWriter::resume(scratch / "series.csv", kColumns, 1e9);
    write(third, 8000, 9000);
    third.close();
  }
  CHECK(text_of(scratch / "series.csv") == text_of(scratch / "whole.csv"));
  CHECK(text_of(scratch / "whole.csv").rfind("time_s,kinetic_energy_J\n0,0\n0.01,1\n", 0) == 0);
}

TEST_CASE("a series refuses what does not belong to it") {
  const Scratch scratch;
  SeriesWriter::create(scratch / "series.csv", kColumns).close();
  CHECK_THAT(refusal([&] { SeriesWriter::create(scratch / "series.csv", kColumns); }), Contains("exists already"));
  CHECK_THAT(refusal([&] { SeriesWriter::resume(scratch / "none.csv", kColumns, 0); }), Contains("is missing"));
  const std::vector<std::string> other{"time_s", "power_W"};
  CHECK_THAT(refusal([&] { SeriesWriter::resume(scratch / "series.csv", other, 0); }), Contains("its columns"));
}

TEST_CASE("a series is read back as it was written, without the row that is being written") {
  const Scratch scratch;
  SeriesWriter writer = SeriesWriter::create(scratch / "series.csv", kColumns);
  write(writer, 0, 50);
  writer.close();
  const std::string whole = text_of(scratch / "series.csv");
  spill(scratch / "series.csv", whole + "0.5,1.5abc\n0.51,7.1");
  const Series series = read_series(scratch / "series.csv");
  CHECK(series.names == kColumns);
  const std::vector<double>& energy = series.column("kinetic_energy_J");
  REQUIRE(energy.size() == 51);
  for (int k = 0; k < 50; ++k) CHECK(energy[k] == std::sqrt(k));
  CHECK(std::isnan(energy[50]));
  CHECK(series.column("time_s")[50] == 0.5);
  CHECK_THAT(refusal([&] { static_cast<void>(series.column("power_W")); }), Contains("no column 'power_W'"));
  spill(scratch / "series.csv", whole + "1\n");
  CHECK_THAT(refusal([&] { read_series(scratch / "series.csv"); }), Contains("a row of 1 numbers where the first line has 2 names"));
  CHECK_THAT(refusal([&] { read_series(scratch / "none.csv"); }), Contains("cannot be read"));
}

TEST_CASE("a cell is quoted where a table would break, and only there") {
  CHECK(csv_cell("") == "");
  CHECK(csv_cell("dry 75 %") == "dry 75 %");
  CHECK(csv_cell("a,b") == "\"a,b\"");
  CHECK(csv_cell("two\nlines") == "\"two\nlines\"");
  CHECK(csv_cell("half a\rline") == "\"half a\rline\"");
  CHECK(csv_cell("the \"mill\"") == "\"the \"\"mill\"\"\"");
}

TEST_CASE("JSON keeps its order and is written whole") {
  const Scratch scratch;
  nlohmann::ordered_json json;
  json["z"] = 0.1;
  json["a"] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::string> command{"millscope", "run", "case\xff.yaml"};
  const std::vector<PluginRecord> plugins{{"hertz_mindlin", "1.0", "laws.so", "ab12", "cd34"}};
  json["provenance"] = provenance(command, plugins);
  write_json(scratch / "summary.json", json);
  const std::string text = text_of(scratch / "summary.json");
  CHECK(text.rfind("{\n  \"z\": 0.1,\n  \"a\": null,", 0) == 0);
  const auto back = nlohmann::json::parse(text);
  for (const char* key : {"version", "compiler", "host", "processor", "cores", "date_utc"}) CHECK(back["provenance"].contains(key));
  CHECK(back["provenance"]["plugins"][0]["name"] == "hertz_mindlin");
  CHECK_THAT(refusal([&] { write_json(scratch / "none/summary.json", json); }), Contains("cannot be written"));
  CHECK_FALSE(std::filesystem::exists(scratch / "summary.json.tmp"));
}
