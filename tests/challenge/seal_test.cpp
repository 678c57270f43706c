// Sealed answers: what was changed, or is missing, is not scored.
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>

#include "kernel/base/text.hpp"
#include "studies/challenge/page.hpp"
#include "tests/scratch.hpp"

using namespace millscope::challenge;

namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

std::vector<Answer> two_answers() {
  Answer none{"set_001", Kind::none, "", {}, {{"friction", 0.3}}, {}};
  Answer worn{"set_002", Kind::effect, "", {{"wear", 0.5, "height", 0.004, 0.005, 0.003}}, {{"friction", 0.2}}, {}};
  return {none, worn};
}

const std::string kDiagnosis = R"({"schema_version": 2, "verdict": "named", "named": ["wear"],
  "hypotheses": [{"name": "wear", "class": "best", "lambda_at": [{"strength": 0, "lambda": 0}, {"strength": 1, "lambda": 49}],
                  "parameters": {"height": {"value": 0.0041, "low90": 0.0039, "high90": 0.0043, "unit": "m", "vanishes_at": 0.005}}}],
  "contact_parameters": {"retuned": {"friction": {"value": 0.4, "low90": 0.3, "high90": 0.5}},
                         "unmasked": {"friction": {"value": 0.2, "low90": 0.1, "high90": null}}},
  "held_out": [{"condition": "slow", "models": [{"model": "corrected"},
    {"model": "retuned base", "improvement_of_corrected": {"value": 1, "low90": -1, "high90": 3}}]}]})";

}  // namespace

TEST_CASE("sealed answers come back as they were") {
  const testing::Scratch folder;
  write(folder / "study.yaml", "base: x");
  seal(folder.path, two_answers(), folder / "study.yaml");
  const std::vector<Answer> back = open_answers(folder.path);
  REQUIRE(back.size() == 2);
  CHECK(back[1].kind == Kind::effect);
  CHECK(back[1].effects[0].far == 0.003);
  CHECK(back[1].theta == two_answers()[1].theta);
  const std::string hash = manifest_hash(folder.path);
  seal(folder.path, two_answers(), folder / "study.yaml");
  CHECK(manifest_hash(folder.path) != hash);  // another salt
}

TEST_CASE("an answer that was sealed when a strength was called a share is read as it is") {
  nlohmann::ordered_json old = to_json(two_answers()[1], "salt");
  CHECK(old["effects"][0]["strength"] == 0.5);
  old["effects"][0]["share"] = 0.25;
  CHECK(answer_from(old).effects[0].strength == 0.5);
  old["effects"][0].erase("strength");
  CHECK_THROWS(answer_from(old));
  old["schema_version"] = 1;
  CHECK(answer_from(old).effects[0].strength == 0.25);
}

TEST_CASE("a diagnosis of before the strength had its name is refused with it") {
  const testing::Scratch folder;
  std::string old = kDiagnosis;
  old.replace(old.find("2, \"verdict\""), 1, "1");
  write(folder.path / "diagnosis" / "diagnosis.json", old);
  const std::string message = testing::refusal([&] { read_found(folder.path); });
  CHECK(message.find("diagnosis.json: is of another schema_version than 2, in which 'share' is called 'strength'") != std::string::npos);
  write(folder.path / "diagnosis" / "diagnosis.json", kDiagnosis);
  CHECK(read_found(folder.path)->verdict == "named");
}

TEST_CASE("an answer that was changed afterwards is refused") {
  const testing::Scratch folder;
  write(folder / "study.yaml", "base: x");
  seal(folder.path, two_answers(), folder / "study.yaml");
  const fs::path file = folder.path / "answers" / "set_002.json";
  std::string text = millscope::base::text_of(file);
  text.replace(text.find("0.004"), 5, "0.003");
  write(file, text);
  const std::string message = testing::refusal([&] { read_sets(folder.path); });
  CHECK(message.find("set_002.json: is not the answer that manifest.json has the hash of") != std::string::npos);
  fs::remove(file);
  CHECK(testing::refusal([&] { read_sets(folder.path); }).find("is missing") != std::string::npos);
}

TEST_CASE("diagnoses are read as they were written, failures with their reason") {
  const testing::Scratch folder;
  write(folder / "study.yaml", "base: x");
  seal(folder.path, two_answers(), folder / "study.yaml");
  write(folder.path / "set_001" / "diagnosis" / "failed.txt", "the disk was on fire\n");
  write(folder.path / "set_002" / "diagnosis" / "diagnosis.json", kDiagnosis);
  const std::vector<Marked> sets = read_sets(folder.path);
  CHECK(sets[0].found->failure == "the disk was on fire");
  const Found& f = *sets[1].found;
  CHECK(f.best()->strength->low == 0.0039);
  CHECK_FALSE(f.unmasked.at("friction").known());  // its end is not a number
  CHECK(f.gains.size() == 1);
  CHECK(f.best()->lambda(0.5) == Approx(12.25));
  const Score s = score(sets);
  CHECK(s.best_right.hits == 1);
  CHECK(s.coverage.at(0).inside.hits == 1);
  CHECK(s.estimates[0].estimate == Approx(0.45));
  CHECK(s.gains[0].surely.hits == 0);
  write(folder.path / "set_002" / "diagnosis" / "diagnosis.json", "{}");
  CHECK(testing::refusal([&] { read_sets(folder.path); }).find("is no diagnosis that can be scored") != std::string::npos);
}

TEST_CASE("a folder without a manifest is none of sets") {
  const testing::Scratch folder;
  CHECK(testing::refusal([&] { read_sets(folder.path); }).find("has no manifest.json") != std::string::npos);
}

TEST_CASE("folders of sets are counted together, each set by the name of its folder") {
  const testing::Scratch folder;
  write(folder / "study.yaml", "conditions: {}\n");
  for (const char* name : {"first", "second"}) {
    seal(folder / name, two_answers(), folder / "study.yaml");
    write(folder / name / "set_002" / "diagnosis" / "diagnosis.json", kDiagnosis);
  }
  write(folder / "second" / "frozen.json", "{\"commit\": \"e7092d5559674a219ab96602527ca179e6bf9a02\"}\n");
  const std::vector<Marked> all = read_all_sets({folder / "first", folder / "second/"});
  REQUIRE(all.size() == 4);
  CHECK(all[1].program.empty());
  CHECK(all[3].program == "e7092d5");
  CHECK(groups_of(all).size() == 2);
  CHECK(all[3].answer.set == "second/set_002");
  CHECK(score(all).named_alone.hits == 2);
  CHECK(read_all_sets({folder / "first"})[1].answer.set == "set_002");
  const std::string text = page_text({all, score(all), "", {{"first", "cafe"}, {"second", "beef"}}});
  CHECK(text.find("the manifests' own are `cafe` (first), `beef` (second).") != std::string::npos);
  CHECK_THROWS_WITH(read_all_sets({folder / "first", folder / "first"}), Catch::Matchers::Contains("the same sets as a folder before it"));
  write(folder / "second" / "frozen.json", "{}\n");
  CHECK_THROWS_WITH(read_sets(folder / "second"), Catch::Matchers::Contains("frozen.json: tells no 'commit'"));
  seal(folder / "other/first", two_answers(), folder / "study.yaml");
  CHECK_THROWS_WITH(read_all_sets({folder / "first", folder / "other/first"}), Catch::Matchers::Contains("two folders are called 'first'"));
}
