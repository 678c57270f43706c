// What crosses the boundary between millscope and a plugin: plain data only.
//
// A plugin library exports one data symbol, `millscope_plugins`, a list of descriptors. The host reads magic, size, ABI version and
// layout hash before it calls a function of the plugin (a library's constructors run at dlopen). Layout rule: the first members of
// Descriptor and DescriptorList up to `kind` and `count` never move, so that a host of any age can say what differs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>

namespace millscope {

inline constexpr std::uint64_t kMagic = 0x504F43534C4C494DULL;  // "MILLSCOP", little endian

/// Raised when Descriptor or DescriptorList changes, or when a member keeps its place and means something else. What else changes in a
/// struct changes the layout hash of the kinds that use it (layout.hpp), and refuses plugins of those kinds alone.
inline constexpr std::uint32_t kAbiVersion = 3;

/// What a plugin is. The layout check is per kind, so that adding a kind breaks no plugin of another.
enum class Kind : std::uint32_t {
  contact_law = 1,
  interaction = 2,
  pair_parameter = 3,
  body_force = 4,
  geometry = 5,
  observation = 6,
  analyzer = 7,
  wear_law = 8,
};

/// How a parameter is written in YAML.
enum class ValueType : std::uint32_t { number, integer, boolean, choice, text, file, vector };

/// Where a parameter stands: once per instance of the plugin, or once per unordered pair of materials.
enum class Scope : std::uint32_t { instance, pair };

/// Value of `Parameter::fallback` that means "the user must give it".
inline constexpr double kRequired = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// One parameter of a plugin: the YAML check, `describe`, the JSON Schema and the manual are made from it.
struct Parameter {
  const char* name;           ///< key in YAML, lower_case_words
  const char* unit;           ///< SI unit: "1", "m", "s", "kg", "Pa", "N/m", "m/s", "rad", "J/m^2", …; "" for text
  const char* doc;            ///< one sentence
  const char* citation;       ///< source, or ""
  const char* choices;        ///< for `choice`: "a|b|c"; the first is the default unless `fallback_text` says otherwise
  const char* fallback_text;  ///< default of choice, text and file; nullptr: required
  double fallback;            ///< default of number, integer, boolean (0/1), and of each component of a vector; NaN: required
  double minimum;             ///< smallest allowed value (numbers and vector components)
  double maximum;             ///< largest allowed value
  ValueType type;
  Scope scope;
  std::uint32_t optional;  ///< 1: may be absent without a default; the plugin asks `given`
  std::uint32_t reserved;
};

/// One resolved value handed to a plugin. Numbers are SI.
struct Value {
  const char* name;
  const char* text;     ///< choice, text, file (an absolute path); "" otherwise
  double number[3];     ///< number, integer, boolean in [0]; vector in all three
  std::uint32_t given;  ///< 1 when the user wrote it or it has a default
  std::uint32_t reserved;
};

struct Values {
  const Value* items;
  std::uint64_t count;
};

/// Filled by a plugin that refuses: one line, the value, the reason, the remedy.
struct Failure {
  char message[1024];
};

/// 0: done. Anything else: `Failure::message` says why.
using Status = std::int32_t;

/// A physics that a model may have left out; `diagnose` enumerates the loaded ones.
struct Hypothesis {
  const char* name;
  const char* sentence;  ///< what to say when it is found
  const char* equation;
  const char* citation;
  const char* parameter;  ///< name of the parameter of this plugin
  double null_value;      ///< value at which the effect vanishes
  double prior_low, prior_high;
  const char* excludes = "";    ///< hypotheses that cannot hold together with it, "a|b", or ""
  std::uint32_t two_sided = 0;  ///< 1: the effect may go either way from `null_value`
  std::uint32_t reserved = 0;
};

struct Descriptor {
  std::uint64_t magic;
  std::uint32_t size;  ///< sizeof(Descriptor) as the plugin was built
  std::uint32_t abi_version;
  std::uint32_t reserved;
  std::uint32_t kind;
  std::uint64_t layout;    ///< hash of the kind's struct layouts
  std::uint64_t features;  ///< bits of `Feature`
  const char* name;
  const char* version;
  const char* compiler;
  const char* doc;
  const char* equation;
  const char* citation;
  const Parameter* parameters;
  std::uint64_t parameter_count;
  const Hypothesis* hypotheses;
  std::uint64_t hypothesis_count;
  const void* table;  ///< ContactLawTable, InteractionTable, …
  std::uint64_t table_size;
};

/// Feature bits.
enum Feature : std::uint64_t {
  kPreInteraction = 1,    ///< interaction that acts before the contact law
  kPostInteraction = 2,   ///< interaction that acts after it
  kGivesRestitution = 4,  ///< pair_parameter that replaces e
  kGivesFriction = 8,     ///< pair_parameter that replaces the static friction
};

struct DescriptorList {
  std::uint64_t magic;
  std::uint32_t size;         ///< sizeof(DescriptorList)
  std::uint32_t abi_version;  ///< of the headers that the library was built with
  std::uint64_t count;
  const Descriptor* const* items;
};

/// FNV-1a of 64 bits (Fowler, Noll & Vo 1991): where it starts, and one step.
inline constexpr std::uint64_t kHashStart = 0xcbf29ce484222325ULL;
constexpr std::uint64_t hash_step(std::uint64_t hash, std::uint64_t next) { return (hash ^ next) * 0x100000001b3ULL; }

/// One number more, byte by byte.
constexpr std::uint64_t hash_number(std::uint64_t hash, std::uint64_t number) {
  for (int byte = 0; byte < 8; ++byte) hash = hash_step(hash, (number >> (8 * byte)) & 0xffU);
  return hash;
}

/// Over a few numbers.
constexpr std::uint64_t hash_numbers(std::initializer_list<std::uint64_t> numbers) {
  std::uint64_t hash = kHashStart;
  for (const std::uint64_t number : numbers) hash = hash_number(hash, number);
  return hash;
}

#if defined(__clang__)
inline constexpr const char* kCompiler = "clang " __clang_version__;
#else
inline constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

}  // namespace millscope

/// The one symbol of a plugin library.
#define MILLSCOPE_EXPORT extern "C" __attribute__((visibility("default")))

/// Defines that symbol from pointers to constant-initialised descriptors: MILLSCOPE_PLUGINS(&first, &second)
#define MILLSCOPE_PLUGINS(...)                                                                       \
  namespace {                                                                                        \
  constinit const ::millscope::Descriptor* const millscope_plugin_items[] = {__VA_ARGS__};           \
  }                                                                                                  \
  extern "C" {                                                                                       \
  extern __attribute__((visibility("default"))) const ::millscope::DescriptorList millscope_plugins; \
  constinit const ::millscope::DescriptorList millscope_plugins = {                                  \
      ::millscope::kMagic, sizeof(::millscope::DescriptorList), ::millscope::kAbiVersion,            \
      sizeof millscope_plugin_items / sizeof millscope_plugin_items[0], millscope_plugin_items};     \
  }
