#include "kernel/base/code_digest/tokens.hpp"

#include <algorithm>
#include <cctype>

namespace millscope::base {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Whether two characters that stand apart would be another operator if they stood together.
bool would_join(char before, char after) {
  constexpr std::string_view kOperators = "+-*/%&|^<>=!:.#";
  if (kOperators.find(before) == std::string_view::npos || kOperators.find(after) == std::string_view::npos) return false;
  return before == after || after == '=' || (before == '-' && after == '>') || (before == '/' && after == '*');
}

class Reader {
 public:
  explicit Reader(std::string_view source) : source_(source) {}

  std::string read() {
    while (at_ < source_.size()) step();
    return std::move(out_);
  }

 private:
  char here(std::size_t ahead = 0) const { return at_ + ahead < source_.size() ? source_[at_ + ahead] : '\0'; }
  bool starts(std::string_view what) const { return source_.substr(at_).starts_with(what); }
  void skip_to(std::size_t end) { at_ = std::min(end, source_.size()); }

  void step() {
    if (starts("\\\n")) {
      at_ += 2, apart_ = true;
    } else if (starts("//")) {
      skip_line();
    } else if (starts("/*")) {
      const std::size_t end = source_.find("*/", at_ + 2);
      skip_to(end == std::string_view::npos ? end : end + 2);
      apart_ = true;
    } else if (std::isspace(static_cast<unsigned char>(here())) != 0) {
      if (here() == '\n') end_line();
      ++at_, apart_ = true;
    } else if (here() == '"') {
      quoted_text();
    } else if (here() == '\'' && !within_number()) {
      copy(end_of_quote('\''));
    } else {
      if (here() == '#' && line_begins_) directive_ = true, out_ += '\n';
      copy(at_ + 1);
    }
  }

  /// A comment goes on in the next line where a backslash ends its own.
  void skip_line() {
    do {
      skip_to(source_.find('\n', at_ + 1));
    } while (at_ < source_.size() && source_[at_ - 1] == '\\');
  }

  void end_line() {
    if (directive_) out_ += '\n';
    directive_ = false;
    line_begins_ = true;
  }

  void copy(std::size_t end) {
    const char before = out_.empty() ? '\n' : out_.back();
    if (apart_ && ((is_word(before) && is_word(here())) || would_join(before, here()))) out_ += ' ';
    if (!is_word(here())) word_ = out_.size() + 1;
    if (is_word(here()) && (apart_ || !is_word(before))) word_ = out_.size();
    out_ += source_.substr(at_, end - at_);
    skip_to(end);
    apart_ = false;
    line_begins_ = false;
  }

  /// The word that has just been copied, with nothing between it and here.
  std::string_view word_before() const {
    return apart_ || word_ >= out_.size() ? std::string_view{} : std::string_view(out_).substr(word_);
  }
  bool within_number() const {
    const std::string_view word = word_before();
    return !word.empty() && std::isdigit(static_cast<unsigned char>(word.front())) != 0;
  }

  std::size_t end_of_quote(char quote) const {
    std::size_t end = at_ + 1;
    while (end < source_.size() && source_[end] != quote) end += source_[end] == '\\' ? 2 : 1;
    return std::min(end + 1, source_.size());
  }

  void quoted_text() {
    const std::string_view word = word_before();
    if (word != "R" && word != "LR" && word != "uR" && word != "UR" && word != "u8R") return copy(end_of_quote('"'));
    const std::size_t open = source_.find('(', at_);
    const std::string close = ")" + std::string(source_.substr(at_ + 1, open - at_ - 1)) + "\"";
    const std::size_t end = open == std::string_view::npos ? open : source_.find(close, open);
    copy(end == std::string_view::npos ? source_.size() : end + close.size());
  }

  std::string_view source_;
  std::size_t at_ = 0;
  std::string out_;
  std::size_t word_ = 0;    ///< where the last word begins in out_
  bool apart_ = false;      ///< something was left out before here
  bool directive_ = false;  ///< in a preprocessor line, whose end means something
  bool line_begins_ = true;
};

}  // namespace

std::string tokens_of(std::string_view source) { return Reader(source).read(); }

}  // namespace millscope::base
