#include "kernel/output/vtk.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "kernel/output/file.hpp"

namespace millscope::output {

namespace {

template <class T>
constexpr const char* kTypeName = nullptr;
template <>
constexpr const char* kTypeName<float> = "Float32";
template <>
constexpr const char* kTypeName<double> = "Float64";
template <>
constexpr const char* kTypeName<std::uint32_t> = "UInt32";
template <>
constexpr const char* kTypeName<std::int64_t> = "Int64";

// Collects the XML head and, after it, the arrays: each a length of 8 bytes and its values.
class Vtp {
 public:
  void tag(const std::string& line) { head_ += line + "\n"; }

  template <class T>
  void array(const std::string& name, const std::vector<T>& values, int components = 1) {
    head_ += fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", kTypeName<T>,
                         name, components, data_.size());
    const std::uint64_t bytes = values.size() * sizeof(T);
    data_.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    data_.append(reinterpret_cast<const char*>(values.data()), bytes);
  }

  void save(const std::filesystem::path& path) const {
    AtomicFile file(path);
    file.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n");
    file.write("<PolyData>\n" + head_ + "</PolyData>\n<AppendedData encoding=\"raw\">\n_");
    file.write(data_);
    file.write("\n</AppendedData>\n</VTKFile>\n");
    file.commit();
  }

 private:
  std::string head_, data_;
};

template <class T, class U>
std::vector<T> as(std::span<const U> values) {
  std::vector<T> result;
  result.reserve(values.size());
  for (const U value : values) result.push_back(static_cast<T>(value));
  return result;
}

// 0, step, 2 step … or 1, 2 …: connectivity and offsets.
std::vector<std::int64_t> count_up(std::size_t count, std::int64_t start, std::int64_t step) {
  std::vector<std::int64_t> result(count);
  for (std::size_t k = 0; k < count; ++k) result[k] = start + step * static_cast<std::int64_t>(k);
  return result;
}

std::vector<float> speeds_of(std::span<const double> velocity) {
  std::vector<float> speeds;
  for (std::size_t k = 0; k + 2 < velocity.size(); k += 3) {
    speeds.push_back(static_cast<float>(std::hypot(velocity[k], velocity[k + 1], velocity[k + 2])));
  }
  return speeds;
}

double area_of(const MeshPicture& mesh, std::size_t triangle) {
  double edge[2][3];
  const double* first = mesh.vertices.data() + std::size_t{3} * mesh.triangles[3 * triangle];
  for (std::size_t e = 0; e < 2; ++e) {
    const double* to = mesh.vertices.data() + std::size_t{3} * mesh.triangles[3 * triangle + 1 + e];
    for (std::size_t k = 0; k < 3; ++k) edge[e][k] = to[k] - first[k];
  }
  return 0.5 * std::hypot(edge[0][1] * edge[1][2] - edge[0][2] * edge[1][1], edge[0][2] * edge[1][0] - edge[0][0] * edge[1][2],
                          edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0]);
}

void add_work(Vtp& vtp, const MeshPicture& mesh, const std::string& name, std::span<const double> work) {
  if (work.empty()) return;
  std::vector<double> density;
  for (std::size_t k = 0; k < work.size(); ++k) {
    const double area = area_of(mesh, k);
    density.push_back(area > 0 ? work[k] / area : 0);
  }
  vtp.array(name, as<double>(work));
  vtp.array(name + "_per_area", density);
}

void require(bool right, const char* what) {
  if (!right) throw std::logic_error(what);
}

}  // namespace

void write_beads_vtp(const std::filesystem::path& path, const BeadPicture& p) {
  const std::size_t count = p.id.size();
  require(p.material.size() == count && p.radius.size() == count && p.position.size() == 3 * count && p.velocity.size() == 3 * count &&
              p.spin.size() == 3 * count,
          "write_beads_vtp: arrays differ in length");
  Vtp vtp;
  vtp.tag(fmt::format("<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">",
                      count));
  vtp.tag("<PointData Scalars=\"speed\" Vectors=\"velocity\">");
  vtp.array("radius", as<float>(p.radius));
  vtp.array("velocity", as<float>(p.velocity), 3);
  vtp.array("speed", speeds_of(p.velocity));
  vtp.array("spin", as<float>(p.spin), 3);
  vtp.array("id", as<std::uint32_t>(p.id));
  vtp.array("material", as<std::uint32_t>(p.material));
  vtp.tag("</PointData>\n<Points>");
  vtp.array("position", as<float>(p.position), 3);
  vtp.tag("</Points>\n<Verts>");
  vtp.array("connectivity", count_up(count, 0, 1));
  vtp.array("offsets", count_up(count, 1, 1));
  vtp.tag("</Verts>\n</Piece>");
  vtp.save(path);
}

void write_mesh_vtp(const std::filesystem::path& path, const MeshPicture& p) {
  const std::size_t count = p.triangles.size() / 3;
  require(p.materials.size() == count && (p.impact_work.empty() || p.impact_work.size() == count) &&
              (p.shear_work.empty() || p.shear_work.size() == count) && (p.worn_volume.empty() || p.worn_volume.size() == count),
          "write_mesh_vtp: arrays differ in length");
  Vtp vtp;
  vtp.tag(fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">",
                      p.vertices.size() / 3, count));
  vtp.tag("<CellData>");
  vtp.array("material", as<std::uint32_t>(p.materials));
  add_work(vtp, p, "impact_work", p.impact_work);
  add_work(vtp, p, "shear_work", p.shear_work);
  add_work(vtp, p, "worn_volume", p.worn_volume);
  vtp.tag("</CellData>\n<Points>");
  vtp.array("position", as<double>(p.vertices), 3);
  vtp.tag("</Points>\n<Polys>");
  vtp.array("connectivity", as<std::int64_t>(p.triangles));
  vtp.array("offsets", count_up(count, 3, 3));
  vtp.tag("</Polys>\n</Piece>");
  vtp.save(path);
}

}  // namespace millscope::output
