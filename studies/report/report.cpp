#include "studies/report/report.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <stdexcept>
#include <string_view>

#include "kernel/base/program.hpp"
#include "kernel/output/file.hpp"
#include "studies/report/packed.hpp"

// The page that is built from page/, put into the program by page.S.
extern "C" const char millscope_page_begin[];
extern "C" const char millscope_page_end[];

namespace millscope::report {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// Appends `page` up to the mark and returns what follows it.
std::string_view before(std::string_view page, std::string_view mark, std::string& out) {
  const std::size_t at = page.find(mark);
  if (at == std::string_view::npos) throw std::logic_error("the page has no " + std::string(mark));
  out += page.substr(0, at);
  return page.substr(at + mark.size());
}

/// Kinds of sections in the order of an answer, what it rests on, and how it looks.
constexpr std::array kAnswerOrder{"diagnosis",  "challenge", "calibration", "validation", "comparison",
                                  "crosscheck", "wear",      "analysis",    "campaign",   "run"};

std::size_t place_of(const nlohmann::ordered_json& section) {
  const auto kind = section.value("kind", std::string());
  return static_cast<std::size_t>(std::find(kAnswerOrder.begin(), kAnswerOrder.end(), kind) - kAnswerOrder.begin());
}

void answer_first(std::vector<nlohmann::ordered_json>& sections) {
  if (std::none_of(sections.begin(), sections.end(), [](const auto& s) { return place_of(s) == 0; })) return;
  std::stable_sort(sections.begin(), sections.end(), [](const auto& a, const auto& b) { return place_of(a) < place_of(b); });
}

}  // namespace

nlohmann::ordered_json document_of(const std::string& title, std::vector<nlohmann::ordered_json> sections, bool live) {
  answer_first(sections);
  return {{"schema_version", 1},
          {"title", title},
          {"made_utc", fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(std::time(nullptr)))},
          {"version", base::version_and_commit()},
          {"live", live},
          {"sections", sections}};
}

std::string page_of(const nlohmann::ordered_json& document) {
  std::string_view rest(millscope_page_begin, millscope_page_end - millscope_page_begin);
  std::string out;
  // The data's place is looked for after the title's, and what was put in is not looked at again.
  rest = before(rest, "@TITLE@", out);
  out += escaped(document.at("title").get<std::string>());
  rest = before(rest, "@DATA@", out);
  out += for_script(document);
  return out.append(rest);
}

void write_page(const std::filesystem::path& file, const nlohmann::ordered_json& document) { output::write_file(file, page_of(document)); }

}  // namespace millscope::report
