// Any bytes as a Gmsh file: elements of nodes that are there, or a UserError; nothing else.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "meshes/msh_text.h"
#include "signals/base/error.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  const fuzz::FileOfBytes file(data, size);
  try {
    const meshes::MshText read = meshes::read_msh_text(file.path());
    const auto check = [&](const auto& elements) {
      for (const auto& element : elements)
        for (const unsigned int node : element.nodes)
          if (node >= read.nodes.size()) std::abort();
    };
    check(read.quadrangles);
    check(read.hexahedra);
    for (const dealii::Point<3>& node : read.nodes)
      if (!std::isfinite(node.norm())) std::abort();
  } catch (const signals::UserError&) {
  }
  return 0;
}
