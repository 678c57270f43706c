// Turns a plain C++ class into an analyzer plugin.
//
//   struct MyAnalyzer {
//     static constexpr std::uint64_t kNeeds = kHasVelocity;                 // fields without which it cannot work, or 0
//     MyAnalyzer(const Parameters&, const AnalyzerContext&);                // throws Refusal with the remedy
//     std::vector<ArrayInfo> arrays() const;                                // see `additive`
//     void accumulate(const FrameBlock&, double* const* sums) const;        // adds one block
//     void finish(const double* const* sums, Results&) const;               // pure
//   };
//   constexpr Descriptor kDescriptor = describe<MyAnalyzer>({.name = "my_analyzer", .doc = "…", .parameters = kParameters});
#pragma once

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "millscope/analyzer.hpp"
#include "millscope/describe.hpp"
#include "millscope/parameters.hpp"

namespace millscope {

/// Describes one additive array: additive("time", "s", {nx, ny}); without shape: one number.
inline ArrayInfo additive(const char* name, const char* unit, std::initializer_list<std::uint64_t> shape = {}) {
  if (shape.size() > kMaxRank) throw Refusal(std::string("the additive array '") + name + "' has more than three dimensions");
  ArrayInfo info{name, unit, static_cast<std::uint32_t>(shape.size()), 0, {1, 1, 1}};
  std::size_t axis = 0;
  for (const std::uint64_t n : shape) info.shape[axis++] = n;
  return info;
}

/// Numbers of an array.
inline std::uint64_t size_of(const ArrayInfo& info) {
  std::uint64_t size = 1;
  for (std::uint32_t axis = 0; axis < info.rank; ++axis) size *= info.shape[axis];
  return size;
}

/// Where `finish` puts what it found.
class Results {
 public:
  explicit Results(const ResultSink& sink) : sink_(sink) {}

  /// One number; `traits`: bits of ResultTrait.
  void add(const char* name, const char* unit, double value, const char* doc, std::uint32_t traits = 0) {
    add(name, unit, &value, {}, doc, {}, traits);
  }
  /// An array, row-major; `axes` names the results that hold the edges or centres of its dimensions.
  void add(const char* name, const char* unit, const double* values, std::initializer_list<std::uint64_t> shape, const char* doc,
           std::initializer_list<const char*> axes = {}, std::uint32_t traits = 0) {
    const ArrayInfo info = additive(name, unit, shape);
    Result result{name, unit, doc, info.rank, traits, {info.shape[0], info.shape[1], info.shape[2]}, values, {}};
    std::copy_n(axes.begin(), std::min<std::size_t>(axes.size(), kMaxRank), result.axis);
    sink_.add(sink_.host, &result);
  }

 private:
  ResultSink sink_;
};

namespace detail {

template <class A>
struct AnalyzerSelf {
  A analyzer;
  std::vector<ArrayInfo> arrays;
  AnalyzerSelf(const Parameters& parameters, const AnalyzerContext& context) : analyzer(parameters, context), arrays(analyzer.arrays()) {}
};

}  // namespace detail

template <class A>
constexpr AnalyzerTable make_analyzer_table() {
  using Self = detail::AnalyzerSelf<A>;
  AnalyzerTable t{};
  t.needs = A::kNeeds;
  t.create = [](const Values* values, const AnalyzerContext* context, void** self, Failure* failure) -> Status {
    return guarded(failure, [&] { *self = new Self(Parameters(*values), *context); });
  };
  t.destroy = [](void* self) { delete static_cast<Self*>(self); };
  t.arrays = [](const void* self, const ArrayInfo** items, std::uint64_t* count) {
    *items = static_cast<const Self*>(self)->arrays.data();
    *count = static_cast<const Self*>(self)->arrays.size();
  };
  t.accumulate = [](const void* self, const FrameBlock* block, double* const* sums, Failure* failure) -> Status {
    return guarded(failure, [&] { static_cast<const Self*>(self)->analyzer.accumulate(*block, sums); });
  };
  t.finish = [](const void* self, const double* const* sums, const ResultSink* sink, Failure* failure) -> Status {
    return guarded(failure, [&] {
      Results results(*sink);
      static_cast<const Self*>(self)->analyzer.finish(sums, results);
    });
  };
  return t;
}

/// What tells an analyzer from the other kinds.
template <class C>
concept AnalyzerClass = requires {
  C::kNeeds;
};

template <AnalyzerClass C>
struct [[gnu::visibility("hidden")]] Adapter<C> {
  static constexpr Kind kind = Kind::analyzer;
  static constexpr std::uint64_t layout = kAnalyzerLayout;
  static constexpr std::uint64_t features = 0;
  static constexpr AnalyzerTable table = make_analyzer_table<C>();
};

}  // namespace millscope
