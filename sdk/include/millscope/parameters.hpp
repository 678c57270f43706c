// How a plugin's class reads its values and refuses bad ones; shared by all adapters.
#pragma once

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include "millscope/abi.hpp"

namespace millscope {

/// Thrown by a plugin's constructor: one line with the value, the reason and the remedy.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The resolved values of one plugin object. Asking for a name that is not in the schema is a programming error of the plugin.
class Parameters {
 public:
  explicit Parameters(const Values& values) : values_(values) {}

  double number(std::string_view name) const { return find(name).number[0]; }
  bool flag(std::string_view name) const { return find(name).number[0] != 0.0; }
  std::int64_t integer(std::string_view name) const { return static_cast<std::int64_t>(find(name).number[0]); }
  std::string text(std::string_view name) const { return find(name).text; }
  const double* vector(std::string_view name) const { return find(name).number; }
  bool given(std::string_view name) const { return find(name).given != 0; }

 private:
  const Value& find(std::string_view name) const {
    for (std::uint64_t i = 0; i < values_.count; ++i) {
      if (name == values_.items[i].name) return values_.items[i];
    }
    throw Refusal("the plugin asks for the parameter '" + std::string(name) + "' that is not in its own list");
  }
  Values values_;
};

/// Runs `body`; an exception becomes a status and a message.
template <class Body>
Status guarded(Failure* failure, Body&& body) noexcept {
  const auto say = [failure](const char* what) {
    std::snprintf(failure->message, sizeof failure->message, "%s", what);
    return Status{1};
  };
  try {
    body();
    return 0;
  } catch (const std::exception& e) {
    return say(e.what());
  } catch (...) {
    return say("the plugin threw something that is not a std::exception");
  }
}

/// Shorthands for parameter lists.
constexpr Parameter number_parameter(const char* name, const char* unit, double fallback, double low, double high, const char* doc,
                                     const char* citation = "") {
  return {name, unit, doc, citation, "", nullptr, fallback, low, high, ValueType::number, Scope::instance, 0, 0};
}
constexpr Parameter pair_parameter(const char* name, const char* unit, double fallback, double low, double high, const char* doc,
                                   const char* citation = "") {
  return {name, unit, doc, citation, "", nullptr, fallback, low, high, ValueType::number, Scope::pair, 0, 0};
}
constexpr Parameter integer_parameter(const char* name, double fallback, double low, double high, const char* doc) {
  return {name, "1", doc, "", "", nullptr, fallback, low, high, ValueType::integer, Scope::instance, 0, 0};
}
constexpr Parameter flag_parameter(const char* name, bool fallback, const char* doc) {
  return {name, "", doc, "", "", nullptr, fallback ? 1.0 : 0.0, 0, 1, ValueType::boolean, Scope::instance, 0, 0};
}
constexpr Parameter choice_parameter(const char* name, const char* choices, const char* fallback, const char* doc) {
  return {name, "", doc, "", choices, fallback, 0, 0, 0, ValueType::choice, Scope::instance, 0, 0};
}
constexpr Parameter text_parameter(const char* name, const char* fallback, const char* doc) {
  return {name, "", doc, "", "", fallback, 0, 0, 0, ValueType::text, Scope::instance, 0, 0};
}
/// `extensions`: those that the plugin reads, "stl|obj"; a geometry whose parameter `file` says them is found by the name of a file alone.
constexpr Parameter file_parameter(const char* name, const char* doc, const char* extensions = "") {
  return {name, "", doc, "", extensions, nullptr, 0, 0, 0, ValueType::file, Scope::instance, 0, 0};
}
constexpr Parameter vector_parameter(const char* name, const char* unit, double fallback, const char* doc) {
  return {name, unit, doc, "", "", nullptr, fallback, -kUnbounded, kUnbounded, ValueType::vector, Scope::instance, 0, 0};
}
constexpr Parameter optional(Parameter p) {
  p.optional = 1;
  return p;
}

}  // namespace millscope
