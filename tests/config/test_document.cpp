#include <filesystem>
#include <fstream>

#include "kernel/config/existing_file.hpp"
#include "tests/config/helpers.hpp"

using namespace millscope::config;
using testing::message_of;

namespace {

std::string refusal_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return message_of([&] { parse_document(text, "a.yaml", overrides); });
}

/// A folder of files, removed at the end.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("millscope_config_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path / "sub"); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return (path / name).string();
  }
};

}  // namespace

TEST_CASE("a tree keeps order, places and paths") {
  const Node root = parse_document("b: 1\na:\n  - x\n  - {c: 'no'}\n", "a.yaml");
  CHECK(root.keys() == std::vector<std::string>{"b", "a"});
  CHECK(root.at("b").where().text() == "a.yaml:1");
  const std::vector<Node> items = root.at("a").items();
  CHECK(items[0].where().text() == "a.yaml:3");
  CHECK(items[1].at("c").path() == "a.1.c");
  CHECK(items[1].at("c").text() == "no");
  CHECK(items[1].at("c").name() == "c");
}

TEST_CASE("YAML that would be misunderstood is refused with its place") {
  CHECK(refusal_of("a: 1\nb: 2\na: 3\n") == "a.yaml:3: key 'a' is given twice; first at line 1; remove one");
  CHECK(refusal_of("g~l: 1\nl~g: 3\n") ==
        "a.yaml:2: key 'l~g' is given twice; first at line 1 as 'g~l' (the order of a pair does not matter); remove one");
  CHECK(refusal_of("a: 010\n") ==
        "a.yaml:1: '010' begins with 0 and might mean octal; write it without the leading 0, or in quotes if it is a text");
  CHECK(refusal_of("a: 010 mm\n").find("a.yaml:1: '010 mm' begins with 0") == 0);
  CHECK(refusal_of("a: 0x1F\n") == "a.yaml:1: '0x1F' is not decimal; write it in decimal");
  CHECK(refusal_of("a: .nan\n") == "a.yaml:1: '.nan' is not a finite number");
  CHECK(refusal_of("a: -.inf\n") == "a.yaml:1: '-.inf' is not a finite number");
  CHECK(refusal_of("a: &x 1\nb: *x\n") == "a.yaml:1: anchors (&name) are not supported; share a file with 'include:'");
  CHECK(refusal_of("a: {<<: 1}\n") == "a.yaml:1: merge keys (<<) are not supported; share a file with 'include:'");
  CHECK(refusal_of("a: !!str 1\n").find("a.yaml:1: the tag '") == 0);
  CHECK(refusal_of("a:\n\t- 1\n") == "a.yaml:2: a tab in the indentation; YAML wants spaces");
  CHECK(refusal_of("a.b: 1\n") == "a.yaml:1: key 'a.b' contains '.' or '=', which --set could not name; use '_'");
  CHECK(refusal_of("a: 1\n---\nb: 1\n") == "a.yaml:3: a second document ('---') in the file; one file holds one case");
  CHECK(refusal_of("? [a]\n: 1\n") == "a.yaml:1: a key must be a name, not a list or a map");
  CHECK(refusal_of(": 1\n") == "a.yaml:1: a key is empty; write a name before the colon");
  CHECK(refusal_of("- 1\n") == "a.yaml:1: the file is no map; write 'key: value' lines");
  CHECK(refusal_of("a: [1\nb: 2\n").find("a.yaml:2: not valid YAML at column") == 0);
  CHECK(refusal_of("a: 0.5\nb: 0\nc: '010'\nd: 2015-01-02\ne: 0\n") == "");
  CHECK(refusal_of("a: " + std::string(2000, '[')).find("a.yaml:1: ") == 0);
  CHECK(refusal_of("a: \"cut sho") == "a.yaml:2: a quoted text above is never closed; add the closing quote");
  CHECK(refusal_of("a: {b: 1, c").find("not valid YAML at column") != std::string::npos);
}

TEST_CASE("accessors say what is wrong") {
  const Node root = parse_document("time:\n  end: 4\n  list: [1]\n  none:\n", "a.yaml");
  const Node time = root.at("time");
  CHECK(message_of([&] { time.at("end_s", "the end, e.g. 4 s"); }) ==
        "a.yaml:1: missing key 'end_s' in 'time'; expected: the end, e.g. 4 s; is 'end' meant for it?");
  CHECK(message_of([&] { root.at("run"); }) == "a.yaml:1: missing key 'run'");
  CHECK(message_of([&] { time.text(); }) == "a.yaml:1: 'time' is a map; a single value is expected");
  CHECK(message_of([&] { time.at("end").keys(); }) ==
        "a.yaml:2: 'time.end' is a single value; a map (indented 'key: value' lines) is expected");
  CHECK(message_of([&] { time.at("end").items(); }) == "a.yaml:2: 'time.end' is a single value; a list [a, b, …] is expected");
  CHECK(message_of([&] { time.find("none"); }) == "a.yaml:4: 'time.none' has no value; write one or remove the key");
}

TEST_CASE("keys that nobody reads are found, with the nearest known one") {
  const Node root = parse_document("time:\n  ned_s: 4\n  other: 1\n", "a.yaml");
  CHECK(message_of([&] { root.finish(); }) == "a.yaml:1: unknown key 'time'; no key is known here");
  const Node time = root.at("time");
  time.find("end_s");
  CHECK(message_of([&] { root.finish(); }) == "a.yaml:2: unknown key 'ned_s' in 'time'; did you mean 'end_s'?");
  CHECK(message_of([&] { time.expect({"ned_s", "end_s"}); }) == "a.yaml:3: unknown key 'other' in 'time'; known: end_s, ned_s");
  time.find("ned_s"), time.find("other");
  CHECK_NOTHROW(root.finish());
}

TEST_CASE("one spelling of a pair") {
  CHECK(normal_pair("liner ~ glass") == "glass~liner");
  CHECK(normal_pair("glass") == "glass");
}

TEST_CASE("overrides") {
  const std::string text = "time: {end_s: 4}\npairs: {glass~liner: {e: 0.5}}\nlist: [{a: 1}, {a: 2}]\n";
  const auto with = [&](const std::string& set) { return parse_document(text, "a.yaml", {set}); };
  CHECK(with("time.end_s=5 s").at("time").at("end_s").text() == "5 s");
  CHECK(with("time.end_s=5 s").at("time").at("end_s").where().text() == "--set time.end_s=5 s");
  CHECK(with("pairs.liner~glass.e=0.7").at("pairs").at("glass~liner").at("e").text() == "0.7");
  CHECK(with("list.1.a=7").at("list").items()[1].at("a").text() == "7");
  CHECK(with("run.threads=2").at("run").at("threads").text() == "2");
  CHECK(with("time.x=[1, 2]").at("time").at("x").items().size() == 2);
  CHECK(with("time.end_s=~").at("time").keys().empty());
  CHECK(with("kind=box").at("kind").text() == "box");
  CHECK(with("time=off").at("time").text() == "off");
}

TEST_CASE("an override puts a plugin beside one with a name much like its own") {
  const std::string text = "contact: {pair_parameters: {friction_by_speed: {kind: friction_by_speed}}}\n";
  const std::string path = "contact.pair_parameters.restitution_by_speed.";
  const Node root = parse_document(text, "a.yaml", {path + "kind=restitution_by_speed", path + "form=plastic"});
  const Node uses = root.at("contact").at("pair_parameters");
  CHECK(uses.keys() == std::vector<std::string>{"friction_by_speed", "restitution_by_speed"});
  CHECK(uses.at("restitution_by_speed").at("form").text() == "plastic");
  CHECK(
      refusal_of(text, {"contact.pair_parameters.friction_by_sped.kind=friction_by_speed"}).ends_with("did you mean 'friction_by_speed'?"));
  CHECK(refusal_of(text, {path + "form=plastic"}).ends_with("did you mean 'friction_by_speed'?"));
}

TEST_CASE("overrides that cannot be meant") {
  const std::string text = "materials: {glass: {density: 1}}\nlist: [1]\n";
  CHECK(refusal_of(text, {"end_s"}) == "--set end_s: is no override; write path.to.key=value");
  CHECK(refusal_of(text, {"a..b=1"}) == "--set a..b=1: the path has an empty segment; write path.to.key=value");
  CHECK(refusal_of(text, {"materials.glas.density=1"}) == "--set materials.glas.density=1: unknown key 'glas'; did you mean 'glass'?");
  CHECK(refusal_of(text, {"materials.glass.density.x=1"}) ==
        "--set materials.glass.density.x=1: 'x' lies below a single value, which has no keys");
  CHECK(refusal_of(text, {"list.3=1"}) == "--set list.3=1: '3' is no item of the list; its items are 0 to 0");
  CHECK(refusal_of(text, {"a=b: c"}).find("--set a=b: c: not valid YAML at column") == 0);
  CHECK(refusal_of(text, {"a=.nan"}) == "--set a=.nan: '.nan' is not a finite number");
}

TEST_CASE("includes merge maps and the including file wins") {
  const Folder folder;
  folder.write("sub/glass.yaml", "materials:\n  glass: {density: 2500, mesh: here.stl}\n");
  folder.write("steel.yaml", "materials:\n  steel: {density: 7800}\n  glass: {density: 2500}\n");
  const std::string file =
      folder.write("case.yaml", "include: [sub/glass.yaml, steel.yaml]\nmaterials:\n  glass: {density: 2600}\n  steel: ~\n");
  const Node materials = load_document(file).at("materials");
  CHECK(materials.keys() == std::vector<std::string>{"glass"});
  CHECK(materials.at("glass").at("density").text() == "2600");
  CHECK(materials.at("glass").at("density").where().text() == file + ":3");
  CHECK(resolve_file(materials.at("glass").at("mesh")) == (folder.path / "sub/here.stl").string());
  const Node set = load_document(file, {"materials.glass.mesh=there.stl"});
  CHECK(resolve_file(set.at("materials").at("glass").at("mesh")) == (std::filesystem::current_path() / "there.stl").string());
}

TEST_CASE("includes that cannot work") {
  const Folder folder;
  const std::string one = folder.write("one.yaml", "a: {b: 1}\n");
  const std::string two = folder.write("two.yaml", "a:\n  b: 2\n");
  const std::string both = folder.write("both.yaml", "include: [one.yaml, two.yaml]\n");
  CHECK(message_of([&] { load_document(both); }) ==
        two + ":2: key 'b' differs from the one at " + one +
            ":1; two included files may not disagree; override it in the including file or remove one");
  const std::string circle = folder.write("circle.yaml", "x: 1\ninclude: [circle.yaml]\n");
  CHECK(message_of([&] { load_document(circle); }) == circle + ":2: 'circle.yaml' includes itself; remove the circle");
  const std::string missing = folder.write("missing.yaml", "include: [none.yaml]\n");
  CHECK(message_of([&] { load_document(missing); }) ==
        missing + ":1: " + (folder.path / "none.yaml").string() + ": no such file; check the path");
  const std::string type = folder.write("type.yaml", "include: one.yaml\na: off\n");
  CHECK(load_document(type).at("a").text() == "off");
  CHECK(message_of([&] { load_document(folder.path.string()); }) == folder.path.string() + ": is a directory; name a YAML file");
}

TEST_CASE("a file with paths for keys reads as the maps that they stand for") {
  const Folder folder;
  const auto read = [&](const std::string& text) { return load_document_with_paths(folder.write("paths.yaml", text)); };
  const Node root = read("p:\n  pairs.liner~glass.friction: {range: [0, 1]}\n  pairs.glass~liner.rolling: 2\n");
  const Node pair = root.at("p").at("pairs").at("glass~liner");
  CHECK(pair.keys() == std::vector<std::string>{"friction", "rolling"});
  CHECK(pair.at("rolling").path() == "p.pairs.glass~liner.rolling");
  CHECK(pair.at("friction").where().line == 2);
  const std::string file = (folder.path / "paths.yaml").string();
  CHECK(message_of([&] { read("a.b: 1\na.b: 2\n"); }) == file + ":2: key 'a.b' is given twice; first at line 1; remove one");
  CHECK(message_of([&] { read("a: 1\na.b: 2\n"); }) == file + ":2: 'a.b' lies below 'a', which is a single value at line 1; remove one");
  CHECK(message_of([&] { read("a..b: 1\n"); }) == file + ":1: a key is empty; write a name before the colon");
}

TEST_CASE("a file that is read later has to be there when it is named") {
  const Folder folder;
  folder.write("points.csv", "1\n");
  const Node root = load_document(folder.write("s.yaml", "good: points.csv\ngone: gone.csv\nfolder: sub\n"));
  CHECK(existing_file(root.at("good")) == (folder.path / "points.csv").string());
  const auto refused = [&](const char* key) { return message_of([&] { existing_file(root.at(key), "make it first"); }); };
  CHECK(refused("gone") == (folder.path / "s.yaml:2: 'gone' is 'gone.csv': no such file; make it first").string());
  CHECK(refused("folder") == (folder.path / "s.yaml:3: 'folder' is 'sub': it is a folder; make it first").string());
}
