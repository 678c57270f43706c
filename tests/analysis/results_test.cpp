#include "studies/analysis/results.hpp"
#include "kernel/base/text.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include <hdf5.h>

#include "analysis/support.hpp"
#include "studies/analysis/tables.hpp"

using namespace analysis_test;
using namespace millscope;
using Catch::Contains;

namespace {

analysis::ResultSet some_results() {
  analysis::ResultSet r;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  r.meta.source = "simulation";
  r.meta.name = "Drum";
  r.meta.description = "µ mill";
  r.meta.context.mill_radius = 0.15;
  r.meta.context.omega = -6;
  r.meta.context.is_recording = 1;
  r.meta.draws = 3;
  r.meta.block_duration = 0.5;
  r.meta.blocks = {{0, 0.5, 0.5, 0}, {0.5, 1, 0.5, 0}, {0, 0.4, 0.4, 1}};
  r.meta.times = {{"x", 0.1, 7, true, 12}, {"z", nan, nan, false, nan}};
  r.meta.inputs = {{"frames.h5", "0123456789abcdef"}};
  r.meta.notes = {"a note"};
  r.meta.left_out = {"slip: no"};
  r.meta.provenance["version"] = "0.1.0";
  analysis::ResultArray edges{"b_grid", "edges", "m", "Edges.", {3}, {""}, true, {0, 0.5, 1}, {}, {}, {}, {}, {}, {}, 0};
  analysis::ResultArray map{"b_grid",
                            "map",
                            "1",
                            "A map, with a \"comma\".",
                            {2, 2},
                            {"edges", "edges"},
                            false,
                            {1, nan, 3, 4},
                            {0.1, nan, 0.3, 0.4},
                            {0.8, nan, 2, 3},
                            {1.2, nan, 4, 5},
                            {12, 1, 13, 14},
                            {0, 9, 2, 0},
                            std::vector<float>(12, 0.25F),
                            millscope::kShare | millscope::kOdd};
  edges.traits = millscope::kAlongX;
  analysis::ResultArray number{"a_power",           "power", "W", "Power.", {}, {}, false, {29.8}, {0.3}, {29.3}, {30.3}, {40}, {2},
                               {0.1F, -0.2F, 0.1F}, 0};
  r.arrays = {edges, map, number};
  r.covariance_entries = {{2, 0}};
  r.covariance = {0.09};
  r.covariance_rank = 1;
  return r;
}

}  // namespace

TEST_CASE("results read back as they were written") {
  const Scratch scratch;
  const analysis::ResultSet r = some_results();
  write_results(scratch / "results.h5", r);
  const analysis::ResultSet back = analysis::read_results(scratch.path);
  CHECK(back.meta.name == r.meta.name);
  CHECK(back.meta.description == r.meta.description);
  CHECK(back.meta.context.mill_radius == 0.15);
  CHECK(back.meta.context.omega == -6);
  CHECK(back.meta.context.is_recording == 1);
  REQUIRE(back.meta.blocks.size() == 3);
  CHECK(back.meta.blocks[2].stretch == 1);
  CHECK(back.meta.times[0].sets_the_block);
  CHECK(back.meta.times[0].independent == 12);
  CHECK(std::isnan(back.meta.times[1].time));
  CHECK(back.meta.inputs[0].hash == "0123456789abcdef");
  CHECK(back.meta.notes == r.meta.notes);
  CHECK(back.meta.left_out == r.meta.left_out);
  CHECK(back.meta.provenance["version"] == "0.1.0");
  REQUIRE(back.arrays.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(back.arrays[i].name == r.arrays[i].name);
    CHECK(back.arrays[i].analyzer == r.arrays[i].analyzer);
    CHECK(back.arrays[i].shape == r.arrays[i].shape);
    CHECK(back.arrays[i].axes == r.arrays[i].axes);
    CHECK(back.arrays[i].flags == r.arrays[i].flags);
    CHECK(back.arrays[i].draws == r.arrays[i].draws);
    CHECK(back.arrays[i].traits == r.arrays[i].traits);
    CHECK(back.arrays[i].doc == r.arrays[i].doc);
  }
  CHECK(back.arrays[1].value[3] == 4);
  CHECK(std::isnan(back.arrays[1].sem[1]));
  CHECK(back.axis(back.arrays[1], 1) == &back.arrays[0]);
  CHECK(back.covariance == r.covariance);
  CHECK(analysis::entry_name(back, back.covariance_entries[0]) == "a_power.power");
  CHECK(analysis::entry_name(back, {1, 2}) == "b_grid.map[2]");
}

TEST_CASE("results are never overwritten unasked, and damaged ones are refused") {
  const Scratch scratch;
  const analysis::ResultSet r = some_results();
  const fs::path file = scratch / "results.h5";
  write_results(file, r);
  CHECK_THAT(refusal([&] { write_results(file, r); }), Contains("exists already"));
  write_results(file, r, true);
  CHECK_FALSE(fs::exists(scratch / "results.h5.tmp"));
  CHECK_THAT(refusal([&] { analysis::read_results(scratch / "nowhere"); }), Contains("there is no such file"));
  const std::string bytes = base::text_of(file);
  spill(scratch / "cut.h5", bytes.substr(0, bytes.size() / 2));
  CHECK_THAT(refusal([&] { analysis::read_results(scratch / "cut.h5"); }), Contains("cut.h5"));
  Drum().write(scratch / "run");
  CHECK_THAT(refusal([&] { analysis::read_results(scratch / "run" / "frames.h5"); }), Contains("'format' is 'millscope frames'"));
}

TEST_CASE("results that do not fit together are refused") {
  const Scratch scratch;
  const fs::path file = scratch / "results.h5";
  const auto read = [&](auto&& spoil) {
    analysis::ResultSet r = some_results();
    spoil(r);
    write_results(file, r, true);
    return refusal([&] { analysis::read_results(file); });
  };
  // Draws of another number than the file says: the writer takes the number from `draws`, so a lie is made there.
  CHECK_THAT(read([](analysis::ResultSet& r) {
               r.meta.draws = 4;
               r.arrays[1].draws.resize(16);
               r.arrays[2].draws.clear();
               r.arrays[1].axes = {"edges", "nowhere"};
             }),
             Contains("b_grid.map") && Contains("axis 'nowhere'") && Contains("damaged"));
  CHECK_THAT(read([](analysis::ResultSet& r) {
               r.arrays[0].value = {0, 0.25, 0.5, 1};
               r.arrays[0].shape = {4};
             }),
             Contains("axis 'edges'"));
  CHECK_THAT(read([](analysis::ResultSet& r) {
               r.meta.draws = 1;
               r.arrays[1].draws.resize(4);
               r.arrays[2].draws.resize(1);
             }),
             Contains("draws"));
  // A dataset of draws with another number of rows or another shape, put in with HDF5 itself.
  write_results(file, some_results(), true);
  for (const std::vector<hsize_t>& extent : {std::vector<hsize_t>{2, 2, 2}, std::vector<hsize_t>{3, 4, 1}, std::vector<hsize_t>{0, 2, 2}}) {
    const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    H5Ldelete(opened, "analyzers/b_grid/map/draws", H5P_DEFAULT);
    const hid_t space = H5Screate_simple(3, extent.data(), nullptr);
    const hid_t set = H5Dcreate2(opened, "analyzers/b_grid/map/draws", H5T_NATIVE_FLOAT, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dclose(set), H5Sclose(space), H5Fclose(opened);
    CHECK_THAT(refusal([&] { analysis::read_results(file); }), Contains("b_grid.map") && Contains("draws"));
  }
}

TEST_CASE("tables hold every value with the bounds of its cell") {
  const Scratch scratch;
  const auto files = analysis::write_tables(scratch.path, some_results());
  REQUIRE(files.size() == 2);
  const std::string numbers = base::text_of(scratch / "numbers.csv");
  CHECK_THAT(numbers, Contains("a_power,power,W,29.8,0.3,29.3,30.3,40,correlated blocks,Power.\n"));
  const std::string map = base::text_of(scratch / "b_grid.edges.edges.csv");
  CHECK_THAT(map, Contains("edges_from [m],edges_to [m],edges_from [m],edges_to [m],map [1],map_sem,map_low,map_high\n"));
  CHECK_THAT(map, Contains("\n0.5,1,0,0.5,3,0.3,2,4\n"));
  CHECK_THAT(map, Contains("\n0,0.5,0.5,1,,,,\n"));  // undefined
  const auto json = analysis::summary_json(some_results());
  CHECK(json["numbers"]["a_power"]["power"]["value"] == 29.8);
  CHECK(json["blocks"] == 3);
  CHECK_THAT(analysis::number_table(some_results(), 5), Contains("+- 0.3") && Contains("[29.3, 30.3]"));
}

TEST_CASE("what lies between edges and what lies on them stand in two tables") {
  const Scratch scratch;
  analysis::ResultSet r = some_results();
  const auto curve = [](const char* name, std::vector<double> value) {
    const std::size_t n = value.size();
    const std::vector<double> some(n, 0.5);
    return analysis::ResultArray{
        "b_grid", name, "1", "", {n}, {"edges"}, false, std::move(value), some, some, some, some, std::vector<std::uint8_t>(n), {}, 0};
  };
  r.arrays.push_back(curve("survival", {3, 2, 1}));
  r.arrays.push_back(curve("density", {7, 8}));
  r.arrays.push_back(curve("hazard", {5, 6}));
  REQUIRE(analysis::write_tables(scratch.path, r).size() == 4);
  CHECK(base::text_of(scratch / "b_grid.edges.csv") ==
        "edges [m],survival [1],survival_sem,survival_low,survival_high\n"
        "0,3,0.5,0.5,0.5\n0.5,2,0.5,0.5,0.5\n1,1,0.5,0.5,0.5\n");
  CHECK(base::text_of(scratch / "b_grid.edges.density.csv") ==
        "edges_from [m],edges_to [m],density [1],density_sem,density_low,density_high,hazard [1],hazard_sem,hazard_low,hazard_high\n"
        "0,0.5,7,0.5,0.5,0.5,5,0.5,0.5,0.5\n0.5,1,8,0.5,0.5,0.5,6,0.5,0.5,0.5\n");
}
