// Pictures for VTK and ParaView, whose points are beads: legacy files (.vtk) and XML (.vtp, .vtu). One frame each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "studies/frames/frame.hpp"
#include "studies/frames/input.hpp"

namespace millscope::frames {

std::unique_ptr<FrameStream> open_legacy_vtk(const std::filesystem::path& file, const ReadOptions& options);
std::unique_ptr<FrameStream> open_xml_vtk(const std::filesystem::path& file, const ReadOptions& options);

/// A number type of VTK by its name in either format: "float", "vtktypeint64", "Float32", "Int64".
struct NumberType {
  enum Kind { real, whole, natural } kind = real;
  std::size_t bytes = 0;
};
/// bytes 0: not known.
NumberType number_type_of(std::string_view written);

/// `count` numbers of a type as they lie in memory, or with each number's bytes reversed.
std::vector<double> numbers_from(const char* bytes, std::size_t count, NumberType type, bool reversed);

/// One array of a picture.
struct VtkArray {
  std::string name;
  std::size_t components = 1;
  std::vector<double> values;
};

/// The points of one file, as it holds them.
struct VtkPicture {
  std::vector<double> points;            ///< [count, 3]
  std::vector<VtkArray> arrays;          ///< of the points
  std::vector<std::string> passed_over;  ///< arrays of the cells
  std::optional<double> time;            ///< of the field data, s

  /// Beads are points: arrays of the cells are named, no more.
  void pass_over_cells(const std::string& name);
};

/// TimeValue (VTK, ParaView), TIME, time.
bool is_time_field(std::string_view written);
/// Adds an array of the field data.
void take_field(VtkPicture& picture, const VtkArray& array);

/// Throws base::UserError: no point, arrays of other lengths.
void to_frame(const VtkPicture& picture, const std::filesystem::path& file, const ReadOptions& options, Frame& frame);

/// Whether numbers make sense only with their bytes reversed.
bool looks_reversed(const char* bytes, std::size_t count, NumberType type, bool reversed);

}  // namespace millscope::frames
