// From a plain C++ class to the descriptor of a plugin.
//
//   constexpr Parameter kParameters[] = {…};
//   constexpr Descriptor kDescriptor = describe<MyLaw>({
//       .name = "my_law",
//       .version = "1.0",
//       .doc = "What it is, in one sentence.",
//       .equation = "F = …",
//       .citation = "Author year, doi:…",
//       .parameters = kParameters,
//   });
//   MILLSCOPE_PLUGINS(&kDescriptor)
//
// Kind, table, layout hash, sizes and features follow from the class, by the adapter of its kind.
#pragma once

#include "millscope/abi.hpp"

namespace millscope {

/// A constant array as it crosses: pointer and count.
template <class T>
struct ConstantList {
  const T* items = nullptr;
  std::uint64_t count = 0;

  constexpr ConstantList() = default;
  template <std::size_t N>
  constexpr ConstantList(const T (&array)[N]) : items(array), count(N) {}
};

/// What only the author can say. Texts that are left out stay empty.
struct Description {
  const char* name;          ///< lower_case_words, as it is written in YAML
  const char* version = "";  ///< of the plugin
  const char* doc = "";      ///< one sentence
  const char* equation = "";
  const char* citation = "";
  ConstantList<Parameter> parameters = {};
  ConstantList<Hypothesis> hypotheses = {};
};

/// Which kind of plugin a class is. Each adapter header specialises it for the classes of its kind: `kind`, `layout`, `features`, and
/// `table`, an object of static storage.
template <class Class>
struct Adapter {
  static_assert(sizeof(Class) == 0,
                "the class is of no known kind: include millscope/KIND_adapter.hpp and give it the members listed on top of that header");
};

template <class Class>
constexpr Descriptor describe(const Description& said) {
  using Of = Adapter<Class>;
  return {.magic = kMagic,
          .size = sizeof(Descriptor),
          .abi_version = kAbiVersion,
          .reserved = 0,
          .kind = static_cast<std::uint32_t>(Of::kind),
          .layout = Of::layout,
          .features = Of::features,
          .name = said.name,
          .version = said.version,
          .compiler = kCompiler,
          .doc = said.doc,
          .equation = said.equation,
          .citation = said.citation,
          .parameters = said.parameters.items,
          .parameter_count = said.parameters.count,
          .hypotheses = said.hypotheses.items,
          .hypothesis_count = said.hypotheses.count,
          .table = &Of::table,
          .table_size = sizeof Of::table};
}

}  // namespace millscope
