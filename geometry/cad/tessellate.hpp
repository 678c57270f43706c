// From CAD bodies to triangles.
#pragma once

#include "geometry/cad/document.hpp"
#include "geometry/import/answer.hpp"

namespace millscope::cad {

struct Request {
  double chord = 0;        ///< largest distance between a face and its triangles, mm
  double angle = 0;        ///< largest angle between neighbouring triangles of a curved face, rad
  bool by_colour = false;  ///< one solid per colour of faces, not per name of bodies
  std::size_t max_triangles = 0;
};

/// In mm. Throws Refusal for a face that cannot be cut, and for too many triangles.
geometry::Solids tessellate(const Document& document, const Request& request);

}  // namespace millscope::cad
