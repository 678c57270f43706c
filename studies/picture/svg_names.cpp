#include "studies/picture/svg_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string_view>

namespace millscope::picture {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else {
      out += c;
    }
  }
  return out;
}

/// Where names begin: behind id=", url(# or href="#. Each mark is searched for once along the text.
class Names {
 public:
  explicit Names(const std::string& svg) : svg_(svg) {}

  /// The first at or behind `from`, which never goes back; npos at the end.
  std::size_t next(std::size_t from) {
    std::size_t first = std::string::npos;
    for (Mark& mark : marks_) {
      if (mark.begin != std::string::npos && mark.begin < from) {
        const std::size_t found = svg_.find(mark.text, from);
        mark.begin = found == std::string::npos ? found : found + mark.text.size();
      }
      first = std::min(first, mark.begin);
    }
    return first;
  }

 private:
  struct Mark {
    std::string_view text;
    std::size_t begin = 0;
  };
  const std::string& svg_;
  std::array<Mark, 3> marks_{{{" id=\""}, {"url(#"}, {"href=\"#"}}};
};

}  // namespace

std::string stable_svg_names(const std::string& svg) {
  std::map<std::string, std::string> renamed;
  std::string out;
  std::size_t done = 0;
  Names names(svg);
  for (std::size_t begin = names.next(1); begin != std::string::npos; begin = names.next(done)) {
    const std::size_t end = svg.find_first_of("\")", begin);
    const std::string name = svg.substr(begin, end - begin);
    std::size_t letters = 0;
    while (letters < name.size() && std::isalpha(static_cast<unsigned char>(name[letters]))) ++letters;
    const auto [place, is_new] = renamed.try_emplace(name, "");
    if (is_new) place->second = name.substr(0, letters) + std::to_string(renamed.size());
    out.append(svg, done, begin - done).append(place->second);
    done = end;
  }
  return out.append(svg, done);
}

std::string describe_svg(const std::string& svg, const std::string& title, const std::string& description) {
  const std::size_t root = svg.find("<svg");
  const std::size_t end = root == std::string::npos ? root : svg.find('>', root);
  if (end == std::string::npos) return svg;
  std::string words = "\n<title>" + escaped(title) + "</title>";
  if (!description.empty()) words += "\n<desc>" + escaped(description) + "</desc>";
  return svg.substr(0, end + 1) + words + svg.substr(end + 1);
}

}  // namespace millscope::picture
