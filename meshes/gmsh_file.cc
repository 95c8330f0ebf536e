#include "meshes/gmsh_file.h"

#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "meshes/msh_text.h"
#include "meshes/place_text.h"
#include "meshes/regions.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::meshes {

namespace {

constexpr double largest_size_m = 10.;
constexpr double clamp_tolerance = 1e-6;  // of the mesh's size

using FaceKey = std::array<unsigned int, 4>;  // node or vertex numbers, ascending
using Hexahedron = MshElement<8>;

/// Faces of a hexahedron in Gmsh's node order (reference manual, "Node ordering").
constexpr std::array<std::array<unsigned int, 4>, 6> hexahedron_faces = {
    {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
/// Gmsh's node at each of deal.II's lexicographic vertices.
constexpr std::array<unsigned int, 8> lexicographic = {0, 1, 3, 2, 4, 5, 7, 6};

template <class Map>
std::vector<std::string> names_of(const Map& ids) {
  std::vector<std::string> names;
  for (const auto& [name, id] : ids) names.push_back(name);
  return names;
}

template <class Map>
std::string listed(const Map& ids) {
  std::string text;
  for (const std::string& name : names_of(ids)) text += (text.empty() ? "" : ", ") + name;
  return text;
}

FaceKey sorted(FaceKey key) {
  std::sort(key.begin(), key.end());
  return key;
}

FaceKey face_of(const Hexahedron& cell, const std::array<unsigned int, 4>& corners) {
  FaceKey key;
  for (unsigned int i = 0; i < 4; ++i) key[i] = cell.nodes[corners[i]];
  return sorted(key);
}

/// Turns the text of a Gmsh file into a marked triangulation, refusing what the solver could
/// misread.
class GmshMesh {
 public:
  explicit GmshMesh(const std::filesystem::path& file) : file_(file), msh_(read_msh_text(file)) {}

  void make(dealii::Triangulation<3>& mesh) {
    read_names();
    check_cells();
    check_size();
    mark_faces();
    check_outer_faces();
    check_clamp();
    check_connected();
    create(mesh);
  }

 private:
  struct Face {
    std::vector<unsigned int> cells;
    dealii::types::boundary_id boundary = dealii::numbers::internal_face_boundary_id;
  };

  [[noreturn]] void refuse(const std::string& why) const {
    throw signals::UserError(file_.string() + ": " + why);
  }
  [[noreturn]] void refuse(const unsigned int line, const std::string& why) const {
    throw signals::UserError(file_.string() + ":" + std::to_string(line) + ": " + why);
  }

  void read_names();
  void check_cells() const;
  void check_size();
  void mark_faces();
  void check_outer_faces() const;
  void check_clamp() const;
  void check_connected() const;
  void create(dealii::Triangulation<3>& mesh) const;

  template <class Id>
  void add_name(const std::string& kind, const int tag, const std::string& name,
                const std::map<std::string, Id>& ids, std::map<int, Id>& id_of_tag);
  template <std::size_t n_nodes>
  dealii::Point<3> centre(const std::array<unsigned int, n_nodes>& nodes) const;

  std::filesystem::path file_;
  MshText msh_;
  std::map<int, dealii::types::material_id> region_of_tag_;
  std::map<int, dealii::types::boundary_id> boundary_of_tag_;
  std::map<FaceKey, Face> faces_;
  double size_m_ = 0.;
};

template <std::size_t n_nodes>
dealii::Point<3> GmshMesh::centre(const std::array<unsigned int, n_nodes>& nodes) const {
  dealii::Point<3> sum;
  for (const unsigned int node : nodes) sum += msh_.nodes[node];
  return dealii::Point<3>(sum / static_cast<double>(n_nodes));
}

template <class Id>
void GmshMesh::add_name(const std::string& kind, const int tag, const std::string& name,
                        const std::map<std::string, Id>& ids, std::map<int, Id>& id_of_tag) {
  const auto id = ids.find(name);
  if (id == ids.end()) refuse(signals::unknown_name(kind, name, names_of(ids)));
  id_of_tag[tag] = id->second;
}

void GmshMesh::read_names() {
  for (const auto& [key, name] : msh_.physical_names) {
    const auto [dimension, tag] = key;
    if (dimension == 3) add_name("physical volume", tag, name, region_ids(), region_of_tag_);
    if (dimension == 2) add_name("physical surface", tag, name, boundary_ids(), boundary_of_tag_);
  }
  if (region_of_tag_.empty())
    refuse("no physical volume has a name. Known names of volumes: " + listed(region_ids()) +
           "; of surfaces: " + listed(boundary_ids()));
}

void GmshMesh::check_cells() const {
  if (msh_.hexahedra.empty()) refuse("the file has no hexahedra; save a 3-D mesh");
  std::set<std::array<unsigned int, 8>> seen;
  for (const Hexahedron& cell : msh_.hexahedra) {
    if (!region_of_tag_.contains(cell.physical_tag))
      refuse(cell.line, "this hexahedron is in no named physical volume. Known names: " +
                            listed(region_ids()));
    auto nodes = cell.nodes;
    std::sort(nodes.begin(), nodes.end());
    if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end())
      refuse(cell.line, "this hexahedron uses a node twice");
    if (!seen.insert(nodes).second)
      refuse(cell.line, "this hexahedron is given twice (a volume in two physical groups?)");
  }
}

void GmshMesh::check_size() {
  dealii::Point<3> lowest = msh_.nodes.front(), highest = lowest;
  for (const dealii::Point<3>& node : msh_.nodes)
    for (unsigned int d = 0; d < 3; ++d) {
      lowest[d] = std::min(lowest[d], node[d]);
      highest[d] = std::max(highest[d], node[d]);
    }
  size_m_ = lowest.distance(highest);
  if (size_m_ > largest_size_m)
    refuse("the mesh is " + signals::to_text(size_m_) +
           " m large; coordinates must be in metres (Mesh.ScalingFactor = 1e-3 turns millimetres "
           "into metres)");
}

void GmshMesh::mark_faces() {
  for (unsigned int c = 0; c < msh_.hexahedra.size(); ++c)
    for (const auto& corners : hexahedron_faces)
      faces_[face_of(msh_.hexahedra[c], corners)].cells.push_back(c);
  for (const auto& [key, face] : faces_)
    if (face.cells.size() > 2)
      refuse(msh_.hexahedra[face.cells.back()].line, "more than two hexahedra share one face");

  for (const MshElement<4>& quadrangle : msh_.quadrangles) {
    const auto boundary = boundary_of_tag_.find(quadrangle.physical_tag);
    if (boundary == boundary_of_tag_.end())
      refuse(quadrangle.line, "this quadrangle is in no named physical surface. Known names: " +
                                  listed(boundary_ids()));
    const auto face = faces_.find(sorted(quadrangle.nodes));
    if (face == faces_.end())
      refuse(quadrangle.line, "this quadrangle is not a face of a hexahedron");
    if (face->second.cells.size() == 2)
      refuse(quadrangle.line,
             "physical surface '" + boundary_name(boundary->second) +
                 "' contains a face inside the sensor (an interface between bodies?) at " +
                 place_text(centre(quadrangle.nodes)) + "; only outer faces may be in a group");
    if (face->second.boundary != dealii::numbers::internal_face_boundary_id)
      refuse(quadrangle.line, "this quadrangle is given twice (a surface in two physical groups?)");
    face->second.boundary = boundary->second;
  }
}

void GmshMesh::check_outer_faces() const {
  unsigned int n_unmarked = 0;
  dealii::Point<3> first;
  for (const auto& [key, face] : faces_)
    if (face.cells.size() == 1 && face.boundary == dealii::numbers::internal_face_boundary_id)
      if (n_unmarked++ == 0) first = centre(key);
  if (n_unmarked > 0)
    refuse(std::to_string(n_unmarked) + " outer faces are in no physical surface, the first at " +
           place_text(first) +
           ". Put them into a group; if they lie between two bodies, join the bodies (Coherence, "
           "BooleanFragments). Known names: " +
           listed(boundary_ids()));
}

void GmshMesh::check_clamp() const {
  bool has_clamp = false;
  for (const auto& [key, face] : faces_) {
    if (face.boundary != boundary::clamp) continue;
    has_clamp = true;
    for (const unsigned int node : key)
      if (std::abs(msh_.nodes[node][2]) > clamp_tolerance * size_m_)
        refuse("physical surface 'clamp' is not in the plane z = 0 at " +
               place_text(msh_.nodes[node]));
  }
  if (!has_clamp) refuse("no outer face is in a physical surface 'clamp' (the plane z = 0)");
}

void GmshMesh::check_connected() const {
  std::vector<unsigned int> parent(msh_.hexahedra.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](unsigned int c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  for (const auto& [key, face] : faces_)
    if (face.cells.size() == 2) parent[root(face.cells[0])] = root(face.cells[1]);
  for (const Hexahedron& cell : msh_.hexahedra) {
    const unsigned int c = &cell - msh_.hexahedra.data();
    if (root(c) != root(0))
      refuse(cell.line, "the hexahedron at " + place_text(centre(cell.nodes)) +
                            " shares no faces with the rest of the sensor; join the bodies "
                            "(Coherence, BooleanFragments)");
  }
}

void GmshMesh::create(dealii::Triangulation<3>& mesh) const {
  std::vector<dealii::Point<3>> vertices;
  std::map<unsigned int, unsigned int> vertex_of_node;
  std::vector<unsigned int> node_of_vertex;
  std::vector<dealii::CellData<3>> cells;
  for (const Hexahedron& hexahedron : msh_.hexahedra) {
    dealii::CellData<3> cell;
    for (unsigned int v = 0; v < 8; ++v) {
      const unsigned int node = hexahedron.nodes[lexicographic[v]];
      const auto [entry, is_new] = vertex_of_node.try_emplace(node, vertices.size());
      if (is_new) {
        vertices.push_back(msh_.nodes[node]);
        node_of_vertex.push_back(node);
      }
      cell.vertices[v] = entry->second;
    }
    cell.material_id = region_of_tag_.at(hexahedron.physical_tag);
    cells.push_back(cell);
  }
  dealii::GridTools::invert_cells_with_negative_measure(vertices, cells);
  dealii::GridTools::consistently_order_cells(cells);
  mesh.clear();
  mesh.create_triangulation(vertices, cells, dealii::SubCellData());

  for (const auto& face : mesh.active_face_iterators()) {
    if (!face->at_boundary()) continue;
    FaceKey key;
    for (unsigned int v = 0; v < 4; ++v) key[v] = node_of_vertex[face->vertex_index(v)];
    face->set_all_boundary_ids(faces_.at(sorted(key)).boundary);
  }
}

}  // namespace

void read_gmsh_mesh(const std::filesystem::path& file, dealii::Triangulation<3>& mesh) {
  GmshMesh(file).make(mesh);
}

}  // namespace vibrissa::meshes
