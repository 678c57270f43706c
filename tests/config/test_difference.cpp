// What a file says besides the one that it includes: read with it, it is what was changed.
#include <catch2/catch.hpp>
#include <fstream>

#include "kernel/config/document.hpp"
#include "scratch.hpp"

using namespace millscope::config;
using testing::Scratch;

namespace {

constexpr const char* kBase =
    "mill: {speed: 75 %critical, lining: {kind: steel, thickness: 5 mm}}\n"
    "beads: {glass: {diameter: 5 mm, sizes: [1, 2]}}\n"
    "name: \"75: a mill\"\n";

/// The lines for some settings, after they were read back below the base and found to say what the settings did.
std::string said(const std::vector<std::string>& settings, const std::vector<std::string>& named = {}) {
  const Scratch folder;
  const std::string base = (folder / "base.yaml").string(), with = (folder / "with.yaml").string();
  std::ofstream(base) << kBase;
  const std::string lines = difference(load_document(base), load_document(base, settings), named);
  std::ofstream(with) << "include: [base.yaml]\n" << lines;
  CHECK(difference(load_document(base, settings), load_document(with)).empty());
  return lines;
}

}  // namespace

TEST_CASE("a difference has what changed and nothing else") {
  CHECK(said({}).empty());
  CHECK(said({"mill.speed=60 rpm"}) == "mill:\n  speed: 60 rpm\n");
  CHECK(said({"mill.speed=75 %critical"}).empty());
  CHECK(said({"beads.glass.sizes=[1, 3]"}) == "beads:\n  glass:\n    sizes: [1, 3]\n");
  CHECK(said({"beads.glass.sizes.1=3"}) == "beads:\n  glass:\n    sizes: [1, 3]\n");
}

TEST_CASE("a difference has what is named even where it is as it was") {
  CHECK(said({"mill.speed=75 %critical"}, {"mill.speed"}) == "mill:\n  speed: 75 %critical\n");
}

TEST_CASE("a difference removes what is gone, and replaces maps key by key") {
  CHECK(said({"beads.glass.diameter=~"}) == "beads:\n  glass:\n    diameter: ~\n");
  CHECK(said({"mill.lining={kind: rubber}"}) == "mill:\n  lining:\n    kind: rubber\n    thickness: ~\n");
  CHECK(said({"mill.lining=none"}) == "mill:\n  lining: none\n");
  CHECK(said({"mill.speed={from: 1, to: 2}"}) == "mill:\n  speed:\n    from: 1\n    to: 2\n");
}

TEST_CASE("a map that is new is told with what was set below it") {
  CHECK(said({"beads.glass.distribution={kind: normal, deviation: 1 mm}", "beads.glass.distribution.deviation=2 mm"}) ==
        "beads:\n  glass:\n    distribution:\n      kind: normal\n      deviation: 2 mm\n");
  CHECK(said({"fill={}"}) == "fill: {}\n");
}

TEST_CASE("a difference quotes what YAML would take for something else") {
  CHECK(said({"name=\"a 'b': #c\""}) == "name: \"a 'b': #c\"\n");
  CHECK(said({"name=\"- x\""}) == "name: \"- x\"\n");
  CHECK(said({"name=-1.5e-3"}) == "name: -1.5e-3\n");
}
