#include "studies/doe/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>

#include "kernel/base/error.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"
#include "kernel/config/document.hpp"

namespace millscope::doe {
namespace {

using base::UserError;

int factor_called(const std::string& name, const std::vector<Factor>& factors, const std::string& generator) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (factors[i].name == name) return static_cast<int>(i);
    names.push_back(factors[i].name);
  }
  throw UserError(fmt::format("generator '{}': '{}' is no factor; {}", generator, name, base::suggestion(name, names)));
}

Generator parse_generator(const std::string& text, const std::vector<Factor>& factors) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || text.find('=', equals + 1) != std::string::npos) {
    throw UserError(fmt::format("generator '{}': write MADE=PRODUCT, e.g. D=A*B*C or D=-A*B", text));
  }
  Generator generator{factor_called(base::trimmed(text.substr(0, equals)), factors, text), {}};
  std::string product = base::trimmed(text.substr(equals + 1));
  if (!product.empty() && product[0] == '-') {
    generator.of.negative = true;
    product.erase(0, 1);
  }
  for (std::size_t at = 0; at <= product.size();) {
    const std::size_t star = std::min(product.find('*', at), product.size());
    const std::uint32_t bit = 1u << factor_called(base::trimmed(product.substr(at, star - at)), factors, text);
    if (generator.of.factors & bit) throw UserError(fmt::format("generator '{}': a factor stands twice in the product", text));
    generator.of.factors |= bit;
    at = star + 1;
  }
  return generator;
}

/// A run as bits: factors at −1, and one more that is always set, so that a sign is a bit like the others.
using Bits = std::uint64_t;

Bits bits_of(const Eigen::MatrixXd& signs, Eigen::Index run) {
  Bits bits = Bits{1} << signs.cols();
  for (Eigen::Index i = 0; i < signs.cols(); ++i) bits |= signs(run, i) < 0 ? Bits{1} << i : 0;
  return bits;
}

/// Reduced row echelon form over GF(2); `pivots`: the leading bit of each row.
std::vector<Bits> echelon(std::vector<Bits> rows, int width, std::vector<int>& pivots) {
  std::size_t rank = 0;
  for (int bit = 0; bit < width && rank < rows.size(); ++bit) {
    const Bits mask = Bits{1} << bit;
    const auto found =
        std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(rank), rows.end(), [&](Bits row) { return (row & mask) != 0; });
    if (found == rows.end()) continue;
    std::swap(rows[rank], *found);
    for (std::size_t other = 0; other < rows.size(); ++other) {
      if (other != rank && (rows[other] & mask)) rows[other] ^= rows[rank];
    }
    pivots.push_back(bit);
    ++rank;
  }
  rows.resize(rank);
  return rows;
}

}  // namespace

int Word::length() const { return std::popcount(factors); }

std::vector<Generator> parse_generators(const std::vector<std::string>& texts, const std::vector<Factor>& factors) {
  std::vector<Generator> generators;
  std::uint32_t made = 0;
  for (const std::string& text : texts) {
    generators.push_back(parse_generator(text, factors));
    const std::uint32_t bit = 1u << generators.back().made;
    if (made & bit) {
      throw UserError(fmt::format("generator '{}': '{}' is made twice", text, factors[generators.back().made].name));
    }
    made |= bit;
  }
  for (std::size_t g = 0; g < generators.size(); ++g) {
    if (generators[g].of.factors & made) {
      throw UserError(fmt::format("generator '{}': the product holds a factor that a generator makes; use the others", texts[g]));
    }
  }
  return generators;
}

std::vector<Word> closure(const std::vector<Word>& words) {
  std::vector<Word> all{Word{}};
  for (const Word& word : words) {
    const std::size_t before = all.size();
    for (std::size_t i = 0; i < before; ++i) all.push_back(all[i] * word);
  }
  all.erase(all.begin());
  return all;
}

// A word w is constant where w·r = c (mod 2) for every run r: the null space of the runs with a column of ones.
std::vector<Word> constant_words(const Eigen::MatrixXd& signs) {
  const int factors = static_cast<int>(signs.cols()), width = factors + 1;
  std::vector<Bits> rows;
  for (Eigen::Index run = 0; run < signs.rows(); ++run) rows.push_back(bits_of(signs, run));
  std::vector<int> pivots;
  rows = echelon(std::move(rows), width, pivots);
  std::vector<Word> words;
  for (int free = 0; free < width; ++free) {
    if (std::find(pivots.begin(), pivots.end(), free) != pivots.end()) continue;
    Bits null = Bits{1} << free;
    for (std::size_t r = 0; r < rows.size(); ++r) null |= (rows[r] >> free & 1) ? Bits{1} << pivots[r] : 0;
    words.push_back({static_cast<std::uint32_t>(null & ((Bits{1} << factors) - 1)), (null >> factors & 1) != 0});
  }
  return words;
}

bool is_regular(const Eigen::MatrixXd& signs, int words) {
  std::map<Bits, int> count;
  for (Eigen::Index run = 0; run < signs.rows(); ++run) ++count[bits_of(signs, run)];
  const int often = count.begin()->second;
  return count.size() == std::size_t{1} << (signs.cols() - words) &&
         std::all_of(count.begin(), count.end(), [often](const auto& c) { return c.second == often; });
}

std::string resolution_of(const std::vector<Word>& relation) {
  constexpr std::array<const char*, 9> kRoman{"", "I", "II", "III", "IV", "V", "VI", "VII", "VIII"};
  if (relation.empty()) return "full";
  int shortest = kMostFactors;
  for (const Word& word : relation) shortest = std::min(shortest, word.length());
  return static_cast<std::size_t>(shortest) < kRoman.size() ? kRoman[shortest] : std::to_string(shortest);
}

std::vector<std::vector<Word>> chains(int factors, const std::vector<Word>& relation) {
  std::vector<Word> effects;
  for (int i = 0; i < factors; ++i) effects.push_back({1u << i, false});
  for (int i = 0; i < factors; ++i) {
    for (int j = i + 1; j < factors; ++j) effects.push_back({1u << i | 1u << j, false});
  }
  std::vector<std::vector<Word>> found;
  std::vector<std::uint32_t> seen;
  for (const Word& effect : effects) {
    if (std::find(seen.begin(), seen.end(), effect.factors) != seen.end()) continue;
    std::vector<Word> chain{effect};
    for (const Word& word : relation) {
      const Word alias = effect * word;
      if (alias.length() == 1 || alias.length() == 2) chain.push_back(alias);
    }
    std::sort(chain.begin() + 1, chain.end(),
              [](Word a, Word b) { return a.length() != b.length() ? a.length() < b.length() : a.factors < b.factors; });
    for (const Word& member : chain) seen.push_back(member.factors);
    found.push_back(std::move(chain));
  }
  return found;
}

std::string text_of(Word word, const std::vector<Factor>& factors) {
  std::string text(word.negative ? 1 : 0, '-');
  bool first = true;
  for (const int i : members(word)) {
    if (!first) text += '*';
    text += factors[i].name;
    first = false;
  }
  return text;
}

std::string text_of(const std::vector<Word>& chain, const std::vector<Factor>& factors, bool rest) {
  std::string text;
  for (std::size_t i = rest ? 1 : 0; i < chain.size(); ++i) text += (text.empty() ? "" : " = ") + text_of(chain[i], factors);
  return text;
}

std::vector<int> members(Word word) {
  std::vector<int> found;
  for (int i = 0; i < kMostFactors; ++i) {
    if (word.factors >> i & 1) found.push_back(i);
  }
  return found;
}

}  // namespace millscope::doe
