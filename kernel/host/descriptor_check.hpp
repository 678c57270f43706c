// Whether what a library exports can be used by this host; reads data only, calls nothing.
#pragma once

#include <string>

#include "millscope/abi.hpp"

namespace millscope::host {

/// What is wrong with the list, "" when it is fine: magic, size, ABI, count.
std::string complaint(const DescriptorList& list);

/// What is wrong with a descriptor, "" when it is fine: magic, ABI, size, kind, layout, table, strings, parameters.
std::string complaint(const Descriptor& descriptor);

/// What is wrong with a descriptor's table, "" when it is fine: missing functions, features, histories and channels. Its size and layout
/// have been checked.
std::string table_complaint(const Descriptor& descriptor);

/// True when `size` bytes at `address` lie in an object file that is loaded.
bool is_mapped(const void* address, std::uint64_t size);

}  // namespace millscope::host
