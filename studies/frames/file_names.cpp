#include "studies/frames/file_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "kernel/base/error.hpp"
#include "studies/frames/input.hpp"

namespace millscope::frames {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDecimalDigits = "0123456789";

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Without its ending.
std::string bare_name(const fs::path& file) {
  fs::path plain = file.filename();
  if (plain.extension() == ".gz") plain = plain.stem();
  const std::string ending = plain.extension().string();
  const bool number = ending.size() > 1 && is_digit(ending[1]) && ending.find_first_not_of("0123456789eE+-", 1) == std::string::npos;
  return ending.empty() || number ? plain.string() : plain.stem().string();
}

/// at_0.05 → 0.05, run2.500 → 500, at_5e-4 → 0.0005.
struct LastNumber {
  double value = 0;
  std::string fraction;  ///< digits behind a decimal point
  bool exponent = false;
};

std::optional<LastNumber> last_number(const fs::path& file) {
  const std::string name = bare_name(file);
  std::size_t end = name.find_last_of(kDecimalDigits);
  if (end == std::string::npos) return std::nullopt;
  const std::size_t all = end;
  const auto start_of = [&](std::size_t last) {
    const std::size_t before = name.find_last_not_of(kDecimalDigits, last);
    return before == std::string::npos ? 0 : before + 1;
  };
  LastNumber number;
  std::size_t begin = start_of(end);
  // An exponent has a sign: "5e-4", but not "case5e4".
  if (begin >= 3 && (name[begin - 1] == '-' || name[begin - 1] == '+') && std::tolower(name[begin - 2]) == 'e' &&
      is_digit(name[begin - 3])) {
    number.exponent = true;
    end = begin - 3;
    begin = start_of(end);
  }
  // With a decimal point only where the digits before it are a number of their own.
  if (begin >= 2 && name[begin - 1] == '.' && is_digit(name[begin - 2])) {
    const std::size_t whole = start_of(begin - 2);
    if (whole == 0 || std::isalnum(static_cast<unsigned char>(name[whole - 1])) == 0) {
      number.fraction = name.substr(begin, end + 1 - begin);
      begin = whole;
    }
  }
  if (!parse_number(std::string_view(name).substr(begin, all + 1 - begin), number.value)) return std::nullopt;
  return number;
}

/// Runs of digits count as whole numbers.
bool naturally_before(const fs::path& a_file, const fs::path& b_file) {
  const std::string a = bare_name(a_file), b = bare_name(b_file);
  std::size_t i = 0, k = 0;
  while (i < a.size() && k < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[k])) {
      if (a[i] != b[k]) return a[i] < b[k];
      ++i, ++k;
      continue;
    }
    const auto run = [](const std::string& text, std::size_t& at) {
      const std::size_t end = std::min(text.find_first_not_of(kDecimalDigits, at), text.size());
      while (at + 1 < end && text[at] == '0') ++at;
      const std::string digits = text.substr(at, end - at);
      at = end;
      return digits;
    };
    const std::string one = run(a, i), other = run(b, k);
    if (one.size() != other.size()) return one.size() < other.size();
    if (one != other) return one < other;
  }
  return a.size() - i < b.size() - k;
}

}  // namespace

std::vector<fs::path> in_order(std::vector<fs::path> files) {
  bool decimal = false, counted = false, exponent = false;
  for (const fs::path& file : files) {
    const auto number = last_number(file);
    if (!number) return files;
    const std::string& fraction = number->fraction;
    exponent = exponent || number->exponent;
    decimal = decimal || (fraction.size() > 1 && fraction.front() == '0');  // 0.05
    counted = counted || fraction.ends_with('0');                           // 1.10 behind 1.9
  }
  std::vector<fs::path> natural = files;
  std::stable_sort(natural.begin(), natural.end(), naturally_before);
  std::stable_sort(files.begin(), files.end(),
                   [](const fs::path& a, const fs::path& b) { return last_number(a)->value < last_number(b)->value; });
  if (exponent) return files;
  const auto point = std::any_of(files.begin(), files.end(), [](const fs::path& file) { return !last_number(file)->fraction.empty(); });
  if (!point || files == natural) return natural;
  if (decimal != counted) return decimal ? files : natural;
  const auto differs = std::mismatch(files.begin(), files.end(), natural.begin());
  throw base::UserError(
      fmt::format("{}: it cannot be told whether this file or '{}' comes first: the point in the names may be a decimal one, or part two "
                  "counts; write equally many digits behind it in all names",
                  differs.first->string(), differs.second->filename().string()));
}

std::optional<std::int64_t> step_in_name(const fs::path& file) {
  const auto number = last_number(file);
  if (!number || number->value != std::floor(number->value) || number->value > 9e15) return std::nullopt;
  return static_cast<std::int64_t>(number->value);
}

}  // namespace millscope::frames
