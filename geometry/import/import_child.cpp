#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <cstring>
#include <exception>
#include <new>
#include <vector>

#include "geometry/import/guarded_import.hpp"
#include "geometry/import/preflight.hpp"
#include "millscope/element.hpp"
#include "millscope/parameters.hpp"

namespace millscope::geometry {

namespace {

void write_all(int pipe, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(pipe, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(1);  // the host is gone
    at += written;
    size -= as_size(written);
  }
}

void write_text(int pipe, const std::string& text) {
  const auto size = static_cast<std::uint32_t>(text.size());
  write_all(pipe, &size, sizeof size);
  write_all(pipe, text.data(), text.size());
}

void write_block(int pipe, Block block) { write_all(pipe, &block, 1); }

/// A file seen as memory, for the preflight.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat info {};
    if (file < 0 || ::fstat(file, &info) != 0)
      throw Refusal(std::string("cannot be read (") + std::strerror(errno) + "): check its permissions");
    size_ = as_size(info.st_size);
    data_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
    ::close(file);
    if (data_ == MAP_FAILED) throw Refusal("does not fit into the memory allowed for it: export a coarser mesh or raise max_triangles");
  }
  ~MappedFile() { ::munmap(data_, size_); }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::string_view view() const { return {static_cast<const char*>(data_), size_}; }

 private:
  void* data_;
  std::size_t size_;
};

struct Placed {
  const aiNode* node;
  aiMatrix4x4t<double> to_world;
};

aiMatrix4x4t<double> in_double(const aiMatrix4x4& m) {
  return {m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4};
}

/// Names that the importer makes up begin with '<' or '$'; one solid without a name is "all".
std::string solid_name(const aiMesh& mesh, const aiNode& node, bool is_root) {
  const auto made_up = [](const std::string& s) { return s.empty() || s[0] == '<' || s[0] == '$' || s == "defaultobject"; };
  std::string name = mesh.mName.C_Str();
  const bool is_number = name.find_first_not_of("0123456789") == std::string::npos;  // 3MF: the object's id; its name is the node's
  if ((is_number && !made_up(node.mName.C_Str()) && !is_root) || made_up(name)) name = is_root ? "" : node.mName.C_Str();
  if (made_up(name)) name = "all";
  for (char& c : name) {
    if (c == '|' || static_cast<unsigned char>(c) < ' ') c = '_';
  }
  return name.substr(0, 100);
}

void append_triangles(const aiMesh& mesh, const aiMatrix4x4t<double>& to_world, std::vector<double>& out) {
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines
    for (unsigned k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices)
        throw Refusal("a face names a vertex that does not exist: the file is damaged, export it again");
      const aiVector3D& v = mesh.mVertices[face.mIndices[k]];
      const aiVector3t<double> p = to_world * aiVector3t<double>(v.x, v.y, v.z);
      for (const double x : {p.x, p.y, p.z}) out.push_back(x);
    }
  }
}

void send_scene(int pipe, const aiScene& scene, std::size_t max_triangles) {
  std::vector<Placed> open{{scene.mRootNode, in_double(scene.mRootNode->mTransformation)}};
  std::size_t total = 0;
  while (!open.empty()) {
    const Placed placed = open.back();
    open.pop_back();
    for (unsigned i = 0; i < placed.node->mNumMeshes; ++i) {
      const aiMesh& mesh = *scene.mMeshes[placed.node->mMeshes[i]];
      std::vector<double> triangles;
      append_triangles(mesh, placed.to_world, triangles);
      total += triangles.size() / 9;
      detail::check_size(static_cast<long long>(total), max_triangles);
      write_block(pipe, Block::solid);
      write_text(pipe, solid_name(mesh, *placed.node, placed.node == scene.mRootNode));
      const std::uint64_t count = triangles.size() / 9;
      write_all(pipe, &count, sizeof count);
      write_all(pipe, triangles.data(), triangles.size() * sizeof(double));
    }
    for (unsigned i = placed.node->mNumChildren; i-- > 0;) {  // the first child is taken first
      const aiNode* child = placed.node->mChildren[i];
      open.push_back({child, placed.to_world * in_double(child->mTransformation)});
    }
  }
}

void import_into(int pipe, const std::string& path, const std::string& extension, std::size_t max_triangles) {
  {
    const MappedFile file(path);
    preflight(file.view(), extension, max_triangles);
  }
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (!scene || !scene->mRootNode) {
    std::string why = importer.GetErrorString();
    for (char& c : why) c = static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    if (why.empty()) why = "its content is damaged";
    throw Refusal("cannot be read as " + extension + " (" + why.substr(0, 300) + "): export it again, as STL if that is possible");
  }
  send_scene(pipe, *scene, max_triangles);
  write_block(pipe, Block::done);
}

}  // namespace

void import_child(int pipe, const std::string& path, const std::string& extension, std::size_t max_triangles) noexcept {
  const auto refuse = [pipe](const char* reason) {
    write_block(pipe, Block::refused);
    write_text(pipe, reason);
    _exit(0);
  };
  try {
    import_into(pipe, path, extension, max_triangles);
  } catch (const std::bad_alloc&) {
    refuse("needs more memory than is allowed for a file of its size: it is damaged or hostile; export it again");
  } catch (const std::exception& e) {
    refuse(e.what());
  } catch (...) {
    refuse("the reader failed: export it again, as STL if that is possible");
  }
  _exit(0);
}

}  // namespace millscope::geometry
