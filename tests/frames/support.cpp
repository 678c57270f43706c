#include "frames/support.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

namespace frames_test {
namespace {

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63U];
  }
  return out;
}

template <class T>
std::string bytes_of(const std::vector<double>& values, bool reversed) {
  std::string out;
  for (const double v : values) {
    const T value = static_cast<T>(v);
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof value);
    if (reversed) std::reverse(raw, raw + sizeof raw);
    out.append(raw, sizeof raw);
  }
  return out;
}

std::string length_of(std::uint64_t value, bool wide, bool big) {
  return wide ? bytes_of<std::uint64_t>({static_cast<double>(value)}, big) : bytes_of<std::uint32_t>({static_cast<double>(value)}, big);
}

std::string packed_by_zlib(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  out.resize(size);
  return out;
}

std::vector<double> flat(const std::vector<std::array<double, 3>>& vectors) {
  std::vector<double> out;
  for (const auto& v : vectors) out.insert(out.end(), v.begin(), v.end());
  return out;
}

template <class T>
std::vector<double> doubles(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

std::string words(const std::vector<double>& values) {
  std::string out;
  for (std::size_t i = 0; i < values.size(); ++i) out += fmt::format("{:.9g}{}", values[i], i % 9 == 8 ? "\n" : " ");
  return out + "\n";
}

/// Blocks of 200 bytes, so that there are several.
std::pair<std::string, std::string> head_and_body(const std::string& bytes, bool packed, bool wide, bool big) {
  if (!packed) return {length_of(bytes.size(), wide, big), bytes};
  constexpr std::size_t kBlock = 200;
  const std::size_t blocks = (bytes.size() + kBlock - 1) / kBlock;
  std::string head = length_of(blocks, wide, big) + length_of(kBlock, wide, big) + length_of(bytes.size() % kBlock, wide, big), body;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::string block = packed_by_zlib(bytes.substr(b * kBlock, kBlock));
    head += length_of(block.size(), wide, big);
    body += block;
  }
  return {head, body};
}

}  // namespace

Charge charge(std::size_t count, double omega, double angle) {
  Charge c;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(count), radius = i % 3 == 0 ? 0.004 : 0.005;
    // Two layers: at the shell, and 12 mm farther in.
    const double r = kShell - radius - (i % 2 == 0 ? 0 : 0.012), at = -2.2 + 1.9 * share + angle;
    const double x = r * std::cos(at), y = r * std::sin(at);
    c.id.push_back(static_cast<long long>(i) + 1);
    c.type.push_back(i % 3 == 0 ? 2 : 1);
    c.place.push_back({x, y, kLength * (0.1 + 0.8 * std::fmod(7.3 * share, 1.0))});
    c.velocity.push_back({-omega * y, omega * x, 0.01 * share});
    c.spin.push_back({0, 0.5, omega});
    c.radius.push_back(radius);
  }
  return c;
}

std::string write(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file.string();
}

std::string write_gzip(const fs::path& file, const std::string& text) {
  const gzFile out = gzopen(file.c_str(), "wb");
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
  return file.string();
}

std::string dump(const Charge& c, long long step, const std::string& columns) {
  std::string text =
      fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff pp\n-0.2 0.2\n-0.2 0.2\n0 {}\nITEM: ATOMS {} \n",
                  step, c.size(), kLength, columns);
  for (std::size_t i = 0; i < c.size(); ++i) {
    for (std::size_t at = 0; at < columns.size();) {
      const std::size_t end = std::min(columns.find(' ', at), columns.size());
      const std::string name = columns.substr(at, end - at);
      const auto axis = static_cast<std::size_t>(name.back() - 'x');
      double value = 0;
      if (name == "id") value = static_cast<double>(c.id[i]);
      if (name == "type") value = static_cast<double>(c.type[i]);
      if (name == "radius") value = c.radius[i];
      if (name.size() == 1) value = c.place[i][axis];
      if (name[0] == 'v' && name.size() == 2) value = c.velocity[i][axis];
      if (name.starts_with("omega")) value = c.spin[i][axis];
      if (name == "xs" || name == "ys") value = (c.place[i][name == "xs" ? 0 : 1] + 0.2) / 0.4;
      if (name == "zs") value = c.place[i][2] / kLength;
      text += fmt::format("{:.10g} ", value);
      at = end + 1;
    }
    text += "\n";
  }
  return text;
}

std::string table(const Charge& c, const std::string& time, char separator) {
  std::string text = time.empty() ? "" : fmt::format("TIME:{}{}\n", separator, time);
  const char* const heads[] = {"Particle ID",
                               "Particle Type",
                               "Position X (mm)",
                               "Position Y (mm)",
                               "Position Z (mm)",
                               "Velocity X (m/s)",
                               "Velocity Y (m/s)",
                               "Velocity Z (m/s)",
                               "Angular Velocity X (rad/s)",
                               "Angular Velocity Y (rad/s)",
                               "Angular Velocity Z (rad/s)",
                               "Diameter (mm)",
                               "Kinetic Energy (J)"};
  for (const char* head : heads) text += fmt::format("{}{}", head, head == heads[12] ? '\n' : separator);
  for (std::size_t i = 0; i < c.size(); ++i) {
    std::string row = fmt::format("{}|{}", c.id[i], c.type[i]);
    for (const double x : c.place[i]) row += fmt::format("|{:.10g}", 1e3 * x);
    for (const double v : c.velocity[i]) row += fmt::format("|{:.10g}", v);
    for (const double w : c.spin[i]) row += fmt::format("|{:.10g}", w);
    row += fmt::format("|{:.10g}|0\n", 2e3 * c.radius[i]);
    if (separator == ';') std::replace(row.begin(), row.end(), '.', ',');
    std::replace(row.begin(), row.end(), '|', separator);
    text += row;
  }
  return text;
}

std::string queries(const Charge& c, double time, bool below) {
  std::string text = fmt::format("TIME:,{}\n", time);
  int number = 0;
  const auto add = [&](const std::string& name, const std::vector<double>& values) {
    text += fmt::format("Q{:02d} : {}:", ++number, name);
    for (const double v : values) text += fmt::format("{},{:.10g}", below ? "\n" : "", v);
    text += "\n";
  };
  const auto part = [](const std::vector<std::array<double, 3>>& vectors, std::size_t axis) {
    std::vector<double> out;
    for (const auto& v : vectors) out.push_back(v[axis]);
    return out;
  };
  add("Particle ID", doubles(c.id));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add(fmt::format("Particle Position {}", "XYZ"[axis]), part(c.place, axis));
    add(fmt::format("Particle Velocity {}", "XYZ"[axis]), part(c.velocity, axis));
    add(fmt::format("Particle Angular Velocity {}", "XYZ"[axis]), part(c.spin, axis));
  }
  std::vector<double> diameters = c.radius;
  for (double& d : diameters) d *= 2;
  add("Particle Diameter", diameters);
  return text;
}

std::string legacy_vtk(const Charge& c, bool binary, bool grid, bool little) {
  const std::size_t n = c.size();
  const auto floats = [&](const std::vector<double>& v) { return binary ? bytes_of<float>(v, !little) + "\n" : words(v); };
  const auto ints = [&](const std::vector<double>& v) { return binary ? bytes_of<std::int32_t>(v, !little) + "\n" : words(v); };
  std::vector<double> cells, kinds(n, 1.0);
  for (std::size_t i = 0; i < n; ++i) cells.push_back(1), cells.push_back(static_cast<double>(i));
  std::string text = fmt::format("# vtk DataFile Version 3.0\nmade up\n{}\nDATASET {}\nPOINTS {} float\n", binary ? "BINARY" : "ASCII",
                                 grid ? "UNSTRUCTURED_GRID" : "POLYDATA", n);
  text += floats(flat(c.place)) + fmt::format("{} {} {}\n", grid ? "CELLS" : "VERTICES", n, 2 * n) + ints(cells);
  if (grid) text += fmt::format("CELL_TYPES {}\n", n) + ints(kinds);
  text += fmt::format("POINT_DATA {}\nSCALARS id int 1\nLOOKUP_TABLE default\n", n) + ints(doubles(c.id));
  text += "VECTORS v float\n" + floats(flat(c.velocity));
  text += fmt::format("FIELD FieldData 3\nomega 3 {} float\n", n) + floats(flat(c.spin));
  text += fmt::format("radius 1 {} float\n", n) + floats(c.radius) + fmt::format("type 1 {} int\n", n) + ints(doubles(c.type));
  return text;
}

std::string xml_vtk(const Charge& c, Coding coding, bool packed, bool grid, bool wide, bool big, const std::string& time) {
  std::string appended;
  const auto array = [&](const char* type, const std::string& name, int components, const std::vector<double>& values,
                         const std::string& bytes) {
    const std::string head = fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" ", type, name, components);
    if (coding == Coding::ascii) return head + "format=\"ascii\">\n" + words(values) + "</DataArray>\n";
    const auto [lengths, body] = head_and_body(bytes, packed, wide, big);
    // Packed, VTK encodes the lengths and the blocks as two streams; else as one.
    const std::string coded = coding == Coding::raw ? lengths + body : packed ? base64(lengths) + base64(body) : base64(lengths + body);
    if (coding == Coding::base64) return head + "format=\"binary\">\n  " + coded + "\n</DataArray>\n";
    const std::size_t offset = appended.size();
    appended += coded;
    return head + fmt::format("format=\"appended\" offset=\"{}\"/>\n", offset);
  };
  const auto floats = [&](const std::string& name, int components, const std::vector<double>& v) {
    return array("Float32", name, components, v, bytes_of<float>(v, big));
  };
  const auto longs = [&](const std::string& name, const std::vector<double>& v) {
    return array("Int64", name, 1, v, bytes_of<std::int64_t>(v, big));
  };
  const std::string kind = grid ? "UnstructuredGrid" : "PolyData";
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"{}\" header_type=\"{}\"{}>\n<{}>\n", kind,
      big ? "BigEndian" : "LittleEndian", wide ? "UInt64" : "UInt32", packed ? " compressor=\"vtkZLibDataCompressor\"" : "", kind);
  if (!time.empty())
    text += fmt::format(
        "<FieldData><DataArray type=\"Int32\" Name=\"other\" NumberOfTuples=\"3\" format=\"ascii\">1 2 3</DataArray><DataArray "
        "type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray></FieldData>\n",
        time);
  text += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfCells=\"0\">\n<PointData>\n", c.size());
  text += longs("id", doubles(c.id)) + floats("Velocity", 3, flat(c.velocity)) + floats("omega", 3, flat(c.spin)) +
          floats("radius", 1, c.radius) + longs("type", doubles(c.type));
  text += "</PointData>\n<Points>\n" + floats("Points", 3, flat(c.place)) + "</Points>\n</Piece>\n</" + kind + ">\n";
  if (coding == Coding::raw || coding == Coding::appended_base64)
    text += fmt::format("<AppendedData encoding=\"{}\">\n_{}\n</AppendedData>\n", coding == Coding::raw ? "raw" : "base64", appended);
  return text + "</VTKFile>\n";
}

std::vector<millscope::frames::Frame> frames_of(const std::vector<fs::path>& files, double length) {
  const auto stream = millscope::frames::read_frames(files, {.length = length, .speed = length});
  std::vector<millscope::frames::Frame> all;
  millscope::frames::Frame frame;
  while (stream->next(frame)) all.push_back(frame);
  return all;
}

std::string mill(const std::string& files, const std::string& more, const std::string& of_mill) {
  return fmt::format("files: {}\naxis: z\ngravity: -y\nmill: {{diameter: 200 mm, ends: [0 mm, 50 mm], {}}}\n{}", files, of_mill, more);
}

}  // namespace frames_test
