#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vibrissa::meshes {

template <std::size_t n_nodes>
struct MshElement {
  std::array<unsigned int, n_nodes> nodes;  // indices into MshText::nodes, in Gmsh's order
  int physical_tag;                         // 0: in no physical group
  unsigned int line;
};

/// Content of a Gmsh file, not yet checked; points and lines are omitted.
struct MshText {
  std::map<std::pair<int, int>, std::string> physical_names;  // by dimension and tag
  std::vector<dealii::Point<3>> nodes;
  std::vector<MshElement<4>> quadrangles;
  std::vector<MshElement<8>> hexahedra;
};

/// Reads the file format "MSH" of Gmsh's reference manual, versions 2.2 and 4.1, ASCII. Throws
/// UserError with file, line and reason: file missing, binary or another version, text instead of a
/// number, unknown or repeated nodes, elements other than points, lines, first-order quadrangles
/// and hexahedra, an early end of the file. tests/meshes/gmsh_file_test.cc reads files that Gmsh
/// wrote.
MshText read_msh_text(const std::filesystem::path& file);

}  // namespace vibrissa::meshes
