// Hashes of what is kept or compared: state of a run, files, texts. Against chance, not against malice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "millscope/abi.hpp"

namespace millscope::base {

/// FNV-1a of 64 bits (Fowler, Noll & Vo 1991).
class Hash {
 public:
  Hash& add(const void* data, std::size_t bytes) {
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) value_ = hash_step(value_, byte[i]);
    return *this;
  }
  Hash& add(std::string_view text) { return add(text.data(), text.size()); }
  /// Eight bytes in one step. Each step is a bijection of the word and of the sum so far.
  Hash& add_word(std::uint64_t word) {
    value_ = hash_step(value_, word);
    return *this;
  }

  std::uint64_t value() const { return value_; }
  /// 16 hexadecimal digits.
  std::string text() const;

 private:
  std::uint64_t value_ = kHashStart;
};

}  // namespace millscope::base
