// read_cad FILE CHORD_MM ANGLE_RAD name|colour MAX_TRIANGLES PIPE
//
// Reads STEP or IGES with OpenCASCADE, cuts the faces into triangles and writes them to the file descriptor PIPE as answer.hpp has it.
// geometry/import/cad_file.cpp starts it, in a process with limits.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <opencascade/Standard_Failure.hxx>
#include <string>

#include "geometry/cad/tessellate.hpp"
#include "geometry/import/answer.hpp"

int main(int count, char** words) {
  using namespace millscope;
  if (count != 7) {
    std::fputs("read_cad is started by millscope: 'millscope geometry report FILE.step'\n", stderr);
    return 2;
  }
  const int pipe = std::atoi(words[6]);
  try {
    const cad::Request request{std::atof(words[2]), std::atof(words[3]), std::string(words[4]) == "colour",
                               std::strtoull(words[5], nullptr, 10)};
    geometry::send_solids(pipe, cad::tessellate(cad::read_document(words[1]), request));
  } catch (const Standard_Failure& e) {
    const std::string what =
        std::string("its reader says '") + e.GetMessageString() + "': heal or export it again, as STL if that is possible";
    geometry::send_refusal(pipe, what.c_str());
  } catch (const std::bad_alloc&) {
    geometry::send_refusal(pipe, "needs more memory than is allowed for a file of its size: it is damaged or hostile; export it again");
  } catch (const std::exception& e) {
    geometry::send_refusal(pipe, e.what());
  }
  return 0;
}
