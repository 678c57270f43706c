// What can be done with every array of a state: write it, read it back, count its bytes. Which arrays there are stands in state.cpp, once.
//
//   whole(name, values)                    one item per bead
//   lengths(name, owners, length)          how long something is in each slab; gives the lengths
//   parts(name, lengths, owners, array)    an array that is kept slab by slab, one after the other
//   scalars(name, pointers)                single numbers
//   idle(values)                           memory that holds nothing between two steps
#pragma once

#include <array>
#include <bit>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

#include "kernel/base/error.hpp"
#include "kernel/dem/lines.hpp"

namespace millscope::dem {

/// A checkpoint is a file: whatever it says is held against what it can be before it is used as a length or an index.
inline void demand(bool sound) {
  if (!sound)
    throw base::UserError("the checkpoint is damaged: its numbers do not belong together; resume with the previous one, or start again");
}

// Items are records of numbers of one type: doubles, singles or integers. Files have doubles and 64-bit integers, which hold them exactly.
template <class Item>
struct NumbersOf {
  using Number = Item;
};
template <>
struct NumbersOf<PositionLine> {
  using Number = double;
};
template <>
struct NumbersOf<MotionLine> {
  using Number = double;
};
template <>
struct NumbersOf<AccelerationLine> {
  using Number = float;
};
template <>
struct NumbersOf<ReferenceLine> {
  using Number = float;
};
template <>
struct NumbersOf<std::array<double, 3>> {
  using Number = double;
};
template <class Item>
using Number = typename NumbersOf<Item>::Number;
template <class Item>
using Stored = std::conditional_t<std::is_floating_point_v<Number<Item>>, double, std::int64_t>;
template <class Item>
using Record = std::array<Number<Item>, sizeof(Item) / sizeof(Number<Item>)>;

class StateWriter {
 public:
  using DoubleSink = std::function<void(const std::string&, const double*, std::size_t)>;
  using IntegerSink = std::function<void(const std::string&, const std::int64_t*, std::size_t)>;
  StateWriter(const DoubleSink& doubles, const IntegerSink& integers) : doubles_(doubles), integers_(integers) {}

  template <class Values>
  void whole(const std::string& name, const Values& values) {
    using Item = typename Values::value_type;
    std::vector<Stored<Item>> all;
    append(values, std::ssize(values), all);
    put(name, all);
  }
  template <class Owners, class Length>
  std::vector<std::int64_t> lengths(const std::string& name, const Owners& owners, const Length& length) {
    std::vector<std::int64_t> all;
    for (const auto* owner : owners) all.push_back(std::invoke(length, *owner));
    put(name, all);
    return all;
  }
  template <class Owners, class Access>
  void parts(const std::string& name, const std::vector<std::int64_t>& lengths, const Owners& owners, const Access& access) {
    using Item = typename std::remove_cvref_t<std::invoke_result_t<Access, decltype(*owners[0])>>::value_type;
    std::vector<Stored<Item>> all;
    for (std::size_t k = 0; k < owners.size(); ++k) append(std::invoke(access, *owners[k]), lengths[k], all);
    put(name, all);
  }
  template <class T>
  void scalars(const std::string& name, const std::vector<T*>& pointers) {
    std::vector<Stored<std::remove_const_t<T>>> all;
    for (const T* p : pointers) all.push_back(*p);
    put(name, all);
  }
  template <class Values>
  void idle(const Values&) {}

 private:
  template <class Values, class Numbers>
  static void append(const Values& values, std::int64_t count, Numbers& all) {
    using Item = typename Values::value_type;
    all.reserve(all.size() + count * std::tuple_size_v<Record<Item>>);
    for (std::int64_t k = 0; k < count; ++k) {
      const auto record = std::bit_cast<Record<Item>>(values[k]);
      all.insert(all.end(), record.begin(), record.end());
    }
  }
  void put(const std::string& name, const std::vector<double>& all) { doubles_(name, all.data(), all.size()); }
  void put(const std::string& name, const std::vector<std::int64_t>& all) { integers_(name, all.data(), all.size()); }

  const DoubleSink& doubles_;
  const IntegerSink& integers_;
};

class StateReader {
 public:
  using DoubleSource = std::function<std::vector<double>(const std::string&)>;
  using IntegerSource = std::function<std::vector<std::int64_t>(const std::string&)>;
  StateReader(const DoubleSource& doubles, const IntegerSource& integers) : doubles_(doubles), integers_(integers) {}

  template <class Values>
  void whole(const std::string& name, Values& values) {
    using Item = typename Values::value_type;
    const std::vector<Stored<Item>> all = get<Stored<Item>>(name);
    demand(all.size() % std::tuple_size_v<Record<Item>> == 0);
    std::size_t at = 0;
    take(all, at, all.size() / std::tuple_size_v<Record<Item>>, values);
  }
  template <class Owners, class Length>
  std::vector<std::int64_t> lengths(const std::string& name, const Owners& owners, const Length&) {
    std::vector<std::int64_t> all = get<std::int64_t>(name);
    demand(all.size() == owners.size());
    return all;
  }
  template <class Owners, class Access>
  void parts(const std::string& name, const std::vector<std::int64_t>& lengths, const Owners& owners, const Access& access) {
    using Item = typename std::remove_cvref_t<std::invoke_result_t<Access, decltype(*owners[0])>>::value_type;
    const std::vector<Stored<Item>> all = get<Stored<Item>>(name);
    std::size_t at = 0;
    for (std::size_t k = 0; k < owners.size(); ++k) {
      const std::size_t left = (all.size() - at) / std::tuple_size_v<Record<Item>>;
      demand(lengths[k] >= 0 && static_cast<std::size_t>(lengths[k]) <= left);
      take(all, at, lengths[k], std::invoke(access, *owners[k]));
    }
    demand(at == all.size());
  }
  template <class T>
  void scalars(const std::string& name, const std::vector<T*>& pointers) {
    const std::vector<Stored<T>> all = get<Stored<T>>(name);
    demand(all.size() == pointers.size());
    for (std::size_t k = 0; k < all.size(); ++k) *pointers[k] = all[k];
  }
  template <class Values>
  void idle(const Values&) {}

 private:
  template <class Numbers, class Values>
  static void take(const Numbers& all, std::size_t& at, std::size_t count, Values& values) {
    using Item = typename Values::value_type;
    values.resize(count);
    for (Item& item : values) {
      Record<Item> record;
      for (Number<Item>& number : record) {
        if constexpr (std::is_integral_v<Number<Item>>) demand(std::in_range<Number<Item>>(all[at]));
        number = static_cast<Number<Item>>(all[at++]);
      }
      item = std::bit_cast<Item>(record);
    }
  }
  template <class T>
  std::vector<T> get(const std::string& name) const {
    if constexpr (std::is_same_v<T, double>) {
      return doubles_(name);
    } else {
      return integers_(name);
    }
  }

  const DoubleSource& doubles_;
  const IntegerSource& integers_;
};

/// Bytes that the arrays take.
class StateBytes {
 public:
  std::size_t count() const { return count_; }

  template <class Values>
  void whole(const std::string&, const Values& values) {
    idle(values);
  }
  template <class Owners, class Length>
  std::vector<std::int64_t> lengths(const std::string&, const Owners&, const Length&) {
    return {};
  }
  template <class Owners, class Access>
  void parts(const std::string&, const std::vector<std::int64_t>&, const Owners& owners, const Access& access) {
    for (const auto& owner : owners) idle(std::invoke(access, *owner));
  }
  template <class T>
  void scalars(const std::string&, const std::vector<T*>& pointers) {
    count_ += pointers.size() * sizeof(T);
  }
  template <class Values>
  void idle(const Values& values) {
    count_ += values.capacity() * sizeof(typename Values::value_type);
  }

 private:
  std::size_t count_ = 0;
};

}  // namespace millscope::dem
