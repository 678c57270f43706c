// The tokens of C++ sources: what is left when comments and formatting are taken away.
#pragma once

#include <string>
#include <string_view>

namespace millscope::base {

/// Two sources have the same tokens if they differ in comments, white space and line ends alone. Text in quotes and the ends of
/// preprocessor lines stay; `> >` and `>>` count as different.
std::string tokens_of(std::string_view source);

}  // namespace millscope::base
