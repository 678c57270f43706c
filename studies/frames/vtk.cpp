#include "studies/frames/vtk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "kernel/base/error.hpp"
#include "kernel/base/text.hpp"
#include "studies/frames/columns.hpp"

namespace millscope::frames {
namespace {

using base::UserError;

template <class T>
void convert(const char* from, std::size_t count, bool reversed, std::vector<double>& to) {
  to.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, from + i * sizeof(T), sizeof(T));
    if (reversed) std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    to[i] = static_cast<double>(value);
  }
}

template <class One, class Two, class Four, class Eight>
void convert_of_size(std::size_t bytes, const char* from, std::size_t count, bool reversed, std::vector<double>& to) {
  if (bytes == 1) return convert<One>(from, count, reversed, to);
  if (bytes == 2) return convert<Two>(from, count, reversed, to);
  if (bytes == 4) return convert<Four>(from, count, reversed, to);
  convert<Eight>(from, count, reversed, to);
}

/// A place or a speed in any unit; zero is one.
bool is_sane(double value) {
  const double size = std::fabs(value);
  return value == 0 || (size > 1e-15 && size < 1e9);
}

void add_array(const VtkArray& array, const ReadOptions& options, Frame& frame) {
  const bool vector = array.components == 3;
  const Column column = vector ? vector_column_of(array.name, options) : array.components == 1 ? column_of(array.name, options) : Column{};
  if (!column.quantity || *column.quantity == kTime || (*column.quantity >= kX && *column.quantity <= kZ)) {
    frame.passed_over.push_back(array.name);
    return;
  }
  for (std::size_t k = 0; k < array.components; ++k) {
    std::vector<double>& to = frame.value[*column.quantity + k];
    if (!to.empty())
      throw std::invalid_argument(fmt::format("array '{}' holds a quantity that another array holds; write one of them", array.name));
    to.resize(frame.count);
    for (std::size_t i = 0; i < frame.count; ++i) to[i] = array.values[array.components * i + k] * column.to_si;
  }
}

}  // namespace

NumberType number_type_of(std::string_view written) {
  const std::string name = base::lower(written);
  struct Known {
    const char* name;
    NumberType type;
  };
  using enum NumberType::Kind;
  // In legacy files VTK writes its vtkIdType as an int, whatever its size is.
  static constexpr Known kKnown[] = {{"float", {real, 4}},
                                     {"double", {real, 8}},
                                     {"float32", {real, 4}},
                                     {"float64", {real, 8}},
                                     {"char", {whole, 1}},
                                     {"signed_char", {whole, 1}},
                                     {"short", {whole, 2}},
                                     {"int", {whole, 4}},
                                     {"long", {whole, 8}},
                                     {"vtkidtype", {whole, 4}},
                                     {"vtktypeint64", {whole, 8}},
                                     {"vtktypeint32", {whole, 4}},
                                     {"int8", {whole, 1}},
                                     {"int16", {whole, 2}},
                                     {"int32", {whole, 4}},
                                     {"int64", {whole, 8}},
                                     {"unsigned_char", {natural, 1}},
                                     {"unsigned_short", {natural, 2}},
                                     {"unsigned_int", {natural, 4}},
                                     {"unsigned_long", {natural, 8}},
                                     {"uint8", {natural, 1}},
                                     {"uint16", {natural, 2}},
                                     {"uint32", {natural, 4}},
                                     {"uint64", {natural, 8}},
                                     {"vtktypeuint64", {natural, 8}},
                                     {"vtktypeuint32", {natural, 4}}};
  for (const Known& known : kKnown) {
    if (name == known.name) return known.type;
  }
  return {};
}

std::vector<double> numbers_from(const char* bytes, std::size_t count, NumberType type, bool reversed) {
  std::vector<double> values;
  using enum NumberType::Kind;
  if (type.kind == real) {
    type.bytes == 4 ? convert<float>(bytes, count, reversed, values) : convert<double>(bytes, count, reversed, values);
  } else if (type.kind == whole) {
    convert_of_size<std::int8_t, std::int16_t, std::int32_t, std::int64_t>(type.bytes, bytes, count, reversed, values);
  } else {
    convert_of_size<std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>(type.bytes, bytes, count, reversed, values);
  }
  return values;
}

bool looks_reversed(const char* bytes, std::size_t count, NumberType type, bool reversed) {
  if (type.bytes < 2 || type.kind != NumberType::real) return false;
  constexpr std::size_t kLooked = 3000;
  const auto share = [&](bool turned) {
    const std::vector<double> values = numbers_from(bytes, std::min(count, kLooked), type, turned);
    return static_cast<double>(std::count_if(values.begin(), values.end(), is_sane)) /
           static_cast<double>(std::max<std::size_t>(values.size(), 1));
  };
  return share(reversed) < 0.9 && share(!reversed) > 0.99;
}

void VtkPicture::pass_over_cells(const std::string& name) {
  const std::string text = fmt::format("{} (of cells)", name);
  if (std::find(passed_over.begin(), passed_over.end(), text) == passed_over.end()) passed_over.push_back(text);
}

bool is_time_field(std::string_view written) {
  const std::string name = base::lower(written);
  return name == "timevalue" || name == "time";
}

void take_field(VtkPicture& picture, const VtkArray& array) {
  if (array.values.size() == 1 && is_time_field(array.name)) picture.time = array.values[0];
}

void to_frame(const VtkPicture& picture, const std::filesystem::path& file, const ReadOptions& options, Frame& frame) {
  frame.begin(file);
  frame.time = picture.time;
  frame.time_of_picture = picture.time.has_value();
  frame.count = picture.points.size() / 3;
  frame.passed_over = picture.passed_over;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    frame.value[kX + axis].resize(frame.count);
    for (std::size_t i = 0; i < frame.count; ++i) frame.value[kX + axis][i] = options.length * picture.points[3 * i + axis];
  }
  for (const VtkArray& array : picture.arrays) {
    if (array.values.size() != frame.count * array.components)
      throw UserError(fmt::format("{}: array '{}' holds {} numbers for {} points; the file is damaged", file.string(), array.name,
                                  array.values.size(), frame.count));
    try {
      add_array(array, options, frame);
    } catch (const std::invalid_argument& e) {
      throw UserError(fmt::format("{}: {}", file.string(), e.what()));
    }
  }
}

}  // namespace millscope::frames
