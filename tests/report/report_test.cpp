// What the page is given: numbers that come back as they went in, a movie that is true to the frames, texts that cannot leave their
// element.
#include <zlib.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "kernel/host/registry.hpp"
#include "kernel/output/frames.hpp"
#include "scratch.hpp"
#include "studies/report/movie.hpp"
#include "studies/report/packed.hpp"
#include "studies/report/report.hpp"
#include "studies/report/watch.hpp"

using namespace millscope;
using Json = nlohmann::ordered_json;

namespace {

int digit_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : 63;
}

std::string from_base64(const std::string& text) {
  std::string bytes;
  unsigned word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<unsigned>(digit_of(c));
    bits += 6;
    if (bits >= 8) bytes += static_cast<char>(word >> (bits -= 8) & 255);
  }
  return bytes;
}

template <class T>
std::vector<T> unpacked(const Json& json, std::size_t count) {
  const std::string packed = from_base64(json.at("deflate").get<std::string>());
  std::vector<T> values(count + 1);
  uLongf size = static_cast<uLongf>((count + 1) * sizeof(T));
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(values.data()), &size, reinterpret_cast<const Bytef*>(packed.data()), packed.size()) == Z_OK);
  REQUIRE(size == count * sizeof(T));
  values.pop_back();
  return values;
}

/// Beads that go round at different radii, so that every position and speed is known.
double place(std::size_t frame, std::size_t bead, std::size_t k) {
  const double radius = 0.01 * (1.0 + static_cast<double>(bead)), angle = 0.1 * static_cast<double>(frame) + static_cast<double>(bead);
  return k == 0 ? radius * std::cos(angle) : k == 1 ? radius * std::sin(angle) : 0.002 * static_cast<double>(bead);
}

void write_frames(const std::filesystem::path& file, std::size_t frames, std::size_t beads) {
  std::vector<std::uint32_t> id(beads), material(beads, 0);
  std::vector<double> radius(beads), mass(beads, 1e-3);
  for (std::size_t b = 0; b < beads; ++b) id[b] = static_cast<std::uint32_t>(b), radius[b] = 1e-3 * static_cast<double>(b + 1);
  auto writer = output::FrameWriter::create(file, {.id = id,
                                                   .radius = radius,
                                                   .mass = mass,
                                                   .material = material,
                                                   .material_names = {"glass"},
                                                   .wall_names = {},
                                                   .dissipation_names = {}});
  for (std::size_t f = 0; f < frames; ++f) {
    std::vector<double> position, velocity, spin(3 * beads, 0.0);
    for (std::size_t b = 0; b < beads; ++b) {
      for (std::size_t k = 0; k < 3; ++k) position.push_back(place(f, b, k));
      for (std::size_t k = 0; k < 3; ++k) velocity.push_back(k == 1 ? static_cast<double>(b) : 0.0);
    }
    writer.append({.time = 0.01 * static_cast<double>(f),
                   .wall_angle = 0.05 * static_cast<double>(f),
                   .angular_velocity = 5,
                   .wall_work = {},
                   .dissipation = {},
                   .position = position,
                   .velocity = velocity,
                   .spin = spin});
  }
  writer.close();
}

}  // namespace

TEST_CASE("with a diagnosis the page begins with its answer, and the runs come last") {
  const auto kinds = [](const std::vector<const char*>& given) {
    std::vector<Json> sections;
    for (const char* kind : given) sections.push_back({{"kind", kind}});
    const Json document = report::document_of("", sections);
    std::vector<std::string> out;
    for (const Json& section : document.at("sections")) out.push_back(section.at("kind"));
    return out;
  };
  CHECK(kinds({"run", "analysis", "comparison", "calibration", "validation", "calibration", "diagnosis"}) ==
        std::vector<std::string>{"diagnosis", "calibration", "calibration", "validation", "comparison", "analysis", "run"});
  CHECK(kinds({"run", "comparison", "calibration"}) == std::vector<std::string>{"run", "comparison", "calibration"});
}

TEST_CASE("base64 as in RFC 4648, section 10") {
  const auto coded = [](const std::string& text) {
    return report::base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  };
  CHECK(coded("").empty());
  CHECK(coded("f") == "Zg==");
  CHECK(coded("fo") == "Zm8=");
  CHECK(coded("foo") == "Zm9v");
  CHECK(coded("foobar") == "Zm9vYmFy");
  CHECK(coded("\xff\xfe\xfb") == "//77");
}

TEST_CASE("packed numbers come back") {
  const std::vector<float> values{0.F, -1.5F, 3e8F, 1e-20F};
  CHECK(unpacked<float>(report::packed<float>(values), values.size()) == values);
}

TEST_CASE("no text can leave the element that the data stand in") {
  const Json document = report::document_of("</title><script>alert(1)</script>", {{{"title", "</script><b>"}}});
  const std::string page = report::page_of(document);
  CHECK(page.find("<script>alert(1)") == std::string::npos);
  CHECK(page.find("&lt;/title&gt;&lt;script&gt;alert(1)") != std::string::npos);
  CHECK(page.find("\\u003c/script>\\u003cb>") != std::string::npos);
  CHECK(page.find("@DATA@") == std::string::npos);
  const std::string data = report::for_script(document);
  CHECK(data.find('<') == std::string::npos);
  CHECK(Json::parse(data) == document);
}

TEST_CASE("a title that is a mark of the page stays a title") {
  const std::string page = report::page_of(report::document_of("@DATA@ @TITLE@", {}));
  CHECK(page.find("@DATA@ @TITLE@") != std::string::npos);
}

TEST_CASE("a movie has the frames' positions to a part of the box and the speeds to a part of the fastest") {
  const testing::Scratch scratch;
  const std::size_t frames = 7, beads = 5;
  write_frames(scratch / "frames.h5", frames, beads);
  const output::FrameReader reader(scratch / "frames.h5");
  const Json movie = report::movie_of(reader, report::kMovieBytes);
  CHECK(movie.at("frames") == frames);
  CHECK(movie.at("beads") == beads);
  CHECK(movie.at("beads_left_out") == 0);
  CHECK(movie.at("time_s").at(6).get<double>() == Approx(0.06));
  CHECK(movie.at("wall_angle_rad").at(6).get<double>() == Approx(0.3));
  const auto position = unpacked<std::uint16_t>(movie.at("position"), 3 * frames * beads);
  const auto speed = unpacked<std::uint8_t>(movie.at("speed"), frames * beads);
  CHECK(unpacked<float>(movie.at("radius_m"), beads)[4] == Approx(5e-3));
  for (std::size_t f = 0; f < frames; ++f) {
    for (std::size_t b = 0; b < beads; ++b) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double low = movie.at("low_m").at(k), high = movie.at("high_m").at(k);
        CHECK(std::fabs(low + (high - low) * position[3 * (f * beads + b) + k] / 65535 - place(f, b, k)) < 1e-5 * (high - low));
      }
      const double shown = movie.at("speed_high_m_per_s").get<double>() * speed[f * beads + b] / 255;
      CHECK(std::fabs(shown - static_cast<double>(b)) < 0.01);
    }
  }
}

TEST_CASE("a movie keeps to its room: fewer frames first, then fewer beads, and says so") {
  const testing::Scratch scratch;
  write_frames(scratch / "frames.h5", 20, 10);
  const output::FrameReader reader(scratch / "frames.h5");
  const Json few = report::movie_of(reader, 7 * 10 * 3);
  CHECK(few.at("frames") == 3);
  CHECK(few.at("beads") == 10);
  CHECK(few.at("time_s").at(0).get<double>() == 0);
  CHECK(few.at("time_s").at(2).get<double>() == Approx(0.19));
  const Json fewer = report::movie_of(reader, 7 * 4);
  CHECK(fewer.at("frames") == 1);
  CHECK(fewer.at("beads") == 4);
  CHECK(fewer.at("beads_left_out") == 6);
  const auto position = unpacked<std::uint16_t>(fewer.at("position"), 12);
  const double low = fewer.at("low_m").at(2), high = fewer.at("high_m").at(2);
  CHECK(low + (high - low) * position[5] / 65535 == Approx(place(19, 3, 2)).margin(1e-6));  // the second shown is the fourth of all
}

TEST_CASE("tokens are long and never the same") {
  const std::string a = report::random_token(), b = report::random_token();
  CHECK(a.size() == 32);
  CHECK(a != b);
}
