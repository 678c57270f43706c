// Arrays of numbers as the page takes them: zlib-compressed little-endian numbers in base64.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

namespace millscope::report {

/// {"deflate": "…"} of these bytes.
nlohmann::ordered_json packed_bytes(std::span<const std::byte> bytes);

template <class T>
nlohmann::ordered_json packed(std::span<const T> values) {
  return packed_bytes(std::as_bytes(values));
}

/// RFC 4648, with padding.
std::string base64(std::span<const unsigned char> bytes);

/// The document as the text of a <script> element: no '<' in it, so that no text can end the element.
std::string for_script(const nlohmann::ordered_json& document);

}  // namespace millscope::report
