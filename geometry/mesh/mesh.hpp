// A triangle mesh as a wall.
#pragma once

#include <memory>
#include <string>

#include "geometry/mesh/candidate_finder.hpp"
#include "geometry/mesh/mesh_contact.hpp"
#include "geometry/mesh/placement.hpp"
#include "geometry/mesh/survey.hpp"
#include "millscope/geometry_adapter.hpp"

namespace millscope::geometry {

struct MeshOptions {
  std::string label;       ///< what messages call it: the file
  bool says_unit = false;  ///< the file says its unit, and the user does not
  Placement placement;
  double period = 0;  ///< along z, m; 0: none
  std::size_t max_triangles = 5'000'000;
};

class Mesh {
 public:
  /// Takes triangles in the file's unit. Throws Refusal.
  Mesh(Soup soup, const MeshOptions& options);
  Mesh(Mesh&&) = delete;  // the finder refers to the records

  const std::string& material_slots() const { return slots_; }
  const std::string& report() const { return report_; }
  Surface surface() const;
  Interior interior() const { return survey_.interior; }
  void candidates(const GeometryBeads& beads, double margin, const CandidateSink& sink) { finder_->find(beads, margin, sink); }
  void touch(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, WallContacts& out) const {
    contact_.touch(bead, candidates, count, out);
  }

  void prefetch(std::uint32_t candidate) const { contact_.prefetch(candidate); }

  const IndexedMesh& mesh() const { return mesh_; }
  const Topology& topology() const { return topology_; }
  const Survey& survey() const { return survey_; }
  const MeshContact& contact() const { return contact_; }

 private:
  void face_the_beads();

  std::string slots_, report_;
  IndexedMesh mesh_;
  Topology topology_;
  Survey survey_;
  MeshContact contact_;
  std::unique_ptr<CandidateFinder> finder_;
};

}  // namespace millscope::geometry
