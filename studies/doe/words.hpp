// Products of two-level factors: generators, defining relation, aliases. For the files of this room.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "studies/doe/doe.hpp"

namespace millscope::doe {

inline constexpr int kMostFactors = 30;

/// A product of factors, bit i for factor i, and its sign.
struct Word {
  std::uint32_t factors = 0;
  bool negative = false;
  int length() const;
};
inline Word operator*(Word a, Word b) { return {a.factors ^ b.factors, a.negative != b.negative}; }

/// "CFPG=-CRPP*CFPP": which factor is made, of which product.
struct Generator {
  int made = 0;
  Word of;
};

/// Throws base::UserError for what does not parse, unknown factors, a factor made twice or of made ones.
std::vector<Generator> parse_generators(const std::vector<std::string>& texts, const std::vector<Factor>& factors);

/// All products of the words except the empty one: what is constant over the runs.
std::vector<Word> closure(const std::vector<Word>& words);

/// Independent words that are constant over the runs, found from the runs themselves. `signs`: [runs, factors] of ±1.
std::vector<Word> constant_words(const Eigen::MatrixXd& signs);

/// Whether the runs are a full factorial of the factors that `words` independent words leave free, every point equally often.
bool is_regular(const Eigen::MatrixXd& signs, int words);

/// "full", "III", "IV", …: the length of the shortest word.
std::string resolution_of(const std::vector<Word>& relation);

/// Effects of one and two factors that the runs cannot tell apart, the first one positive; main effects come first.
std::vector<std::vector<Word>> chains(int factors, const std::vector<Word>& relation);

std::string text_of(Word word, const std::vector<Factor>& factors);
/// "A = -B*C"; from the second member on where `rest`.
std::string text_of(const std::vector<Word>& chain, const std::vector<Factor>& factors, bool rest = false);
std::vector<int> members(Word word);

}  // namespace millscope::doe
