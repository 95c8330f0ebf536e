#include "meshes/msh_text.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>
#include <unordered_map>

#include "signals/base/error.h"

namespace vibrissa::meshes {

namespace {

/// Words of a text file, each with its line.
class Words {
 public:
  explicit Words(const std::filesystem::path& file) : file_(file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file))
      throw signals::UserError(file.string() + ": cannot open this Gmsh file");
    text_.assign(std::istreambuf_iterator<char>(stream), {});
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw signals::UserError(file_.string() + ":" + std::to_string(line_) + ": " + why);
  }

  unsigned int line() const { return line_; }
  std::size_t n_bytes() const { return text_.size(); }

  bool at_end() {
    skip_space();
    return position_ == text_.size();
  }

  std::string_view word() {
    if (at_end()) refuse("the file ends too early");
    const std::size_t begin = position_;
    while (position_ < text_.size() && !is_space(text_[position_])) ++position_;
    return std::string_view(text_).substr(begin, position_ - begin);
  }

  template <class Number>
  Number number(const std::string& what) {
    const std::string_view given = word();
    Number value{};
    const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), value);
    if (error != std::errc() || end != given.data() + given.size())
      refuse("expected " + what + ", found '" + std::string(given) + "'");
    return value;
  }

  double coordinate() {
    const double value = number<double>("a coordinate");
    if (!std::isfinite(value)) refuse("a coordinate is not finite");
    return value;
  }

  /// A number of things that follow, each at least one character long.
  std::size_t count(const std::string& what) {
    const auto value = number<std::size_t>("the number of " + what);
    if (value > n_bytes()) refuse(std::to_string(value) + " " + what + " do not fit in this file");
    return value;
  }

  std::string quoted() {
    if (at_end() || text_[position_] != '"') refuse("expected a name in quotes");
    const std::size_t begin = position_ + 1;
    const std::size_t end = text_.find_first_of("\"\n", begin);
    if (end == std::string::npos || text_[end] != '"') refuse("a name lacks its closing quote");
    position_ = end + 1;
    return text_.substr(begin, end - begin);
  }

  void expect(const std::string& wanted) {
    const std::string_view given = word();
    if (given != wanted) refuse("expected " + wanted + ", found '" + std::string(given) + "'");
  }

  void skip_words(const std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) word();
  }

 private:
  static bool is_space(const char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

  void skip_space() {
    for (; position_ < text_.size() && is_space(text_[position_]); ++position_)
      if (text_[position_] == '\n') ++line_;
  }

  std::filesystem::path file_;
  std::string text_;
  std::size_t position_ = 0;
  unsigned int line_ = 1;
};

class MshReader {
 public:
  explicit MshReader(const std::filesystem::path& file) : words_(file) {}

  MshText read();

 private:
  void read_format();
  void read_section(const std::string& section);
  void read_physical_names();
  void read_entities();
  void read_entity(int dimension);
  void read_nodes_2();
  void read_nodes_4();
  void read_elements_2();
  void read_elements_4();
  void add_node(long tag, const dealii::Point<3>& place);
  dealii::Point<3> read_point();
  void read_element(int type, int physical_tag);
  template <std::size_t n_nodes>
  MshElement<n_nodes> read_element_nodes(int physical_tag);

  Words words_;
  bool is_version_4_ = false;
  std::map<std::pair<int, int>, int> physical_tag_of_entity_;  // by dimension and tag
  std::unordered_map<long, unsigned int> node_index_;
  MshText msh_;
};

MshText MshReader::read() {
  read_format();
  while (!words_.at_end()) {
    const std::string section(words_.word());
    if (section.front() != '$') words_.refuse("expected a section, found '" + section + "'");
    read_section(section.substr(1));
  }
  return std::move(msh_);
}

void MshReader::read_format() {
  if (words_.at_end() || words_.word() != "$MeshFormat")
    words_.refuse("not a Gmsh file of version 2.2 or 4.1: it does not begin with $MeshFormat");
  const std::string version(words_.word());
  if (version != "2.2" && version != "4.1")
    words_.refuse("Gmsh format " + version +
                  " cannot be read; save as 4.1 or 2.2 (gmsh -format msh41 or msh22)");
  is_version_4_ = version == "4.1";
  if (words_.word() != "0")
    words_.refuse("binary Gmsh files cannot be read; save as ASCII (gmsh -bin 0)");
  words_.skip_words(1);
  words_.expect("$EndMeshFormat");
}

void MshReader::read_section(const std::string& section) {
  if (section == "PhysicalNames") {
    read_physical_names();
  } else if (section == "Entities") {
    read_entities();
  } else if (section == "Nodes") {
    is_version_4_ ? read_nodes_4() : read_nodes_2();
  } else if (section == "Elements") {
    is_version_4_ ? read_elements_4() : read_elements_2();
  } else {
    while (words_.word() != "$End" + section) {
    }
    return;
  }
  words_.expect("$End" + section);
}

void MshReader::read_physical_names() {
  const std::size_t n_names = words_.count("physical names");
  for (std::size_t i = 0; i < n_names; ++i) {
    const int dimension = words_.number<int>("a dimension");
    const int tag = words_.number<int>("a physical tag");
    msh_.physical_names[{dimension, std::abs(tag)}] = words_.quoted();
  }
}

void MshReader::read_entities() {
  std::array<std::size_t, 4> n_entities;
  for (std::size_t& n : n_entities) n = words_.count("entities");
  for (int dimension = 0; dimension < 4; ++dimension)
    for (std::size_t i = 0; i < n_entities[dimension]; ++i) read_entity(dimension);
}

void MshReader::read_entity(const int dimension) {
  const int tag = words_.number<int>("an entity's tag");
  const unsigned int n_box_coordinates = dimension == 0 ? 3 : 6;
  words_.skip_words(n_box_coordinates);
  const std::size_t n_groups = words_.count("physical groups");
  if (dimension >= 2 && n_groups > 1)
    words_.refuse("an entity is in " + std::to_string(n_groups) +
                  " physical groups; each volume and surface may be in one");
  for (std::size_t i = 0; i < n_groups; ++i)
    physical_tag_of_entity_[{dimension, tag}] = std::abs(words_.number<int>("a physical tag"));
  if (dimension > 0) words_.skip_words(words_.count("bounding entities"));
}

dealii::Point<3> MshReader::read_point() {
  dealii::Point<3> place;
  for (unsigned int d = 0; d < 3; ++d) place[d] = words_.coordinate();
  return place;
}

void MshReader::add_node(const long tag, const dealii::Point<3>& place) {
  if (!node_index_.try_emplace(tag, msh_.nodes.size()).second)
    words_.refuse("node " + std::to_string(tag) + " is given twice");
  msh_.nodes.push_back(place);
}

void MshReader::read_nodes_2() {
  const std::size_t n_nodes = words_.count("nodes");
  for (std::size_t i = 0; i < n_nodes; ++i) {
    const long tag = words_.number<long>("a node's tag");
    add_node(tag, read_point());
  }
}

void MshReader::read_nodes_4() {
  const std::size_t n_blocks = words_.count("node blocks");
  words_.skip_words(3);
  for (std::size_t block = 0; block < n_blocks; ++block) {
    const int dimension = words_.number<int>("a dimension");
    words_.skip_words(1);
    const bool is_parametric = words_.number<int>("0 or 1") != 0;
    std::vector<long> tags(words_.count("nodes"));
    for (long& tag : tags) tag = words_.number<long>("a node's tag");
    for (const long tag : tags) {
      add_node(tag, read_point());
      if (is_parametric) words_.skip_words(dimension);
    }
  }
}

void MshReader::read_elements_2() {
  const std::size_t n_elements = words_.count("elements");
  for (std::size_t i = 0; i < n_elements; ++i) {
    words_.skip_words(1);
    const int type = words_.number<int>("an element type");
    const std::size_t n_tags = words_.count("tags");
    const int physical_tag = n_tags == 0 ? 0 : words_.number<int>("a physical tag");
    if (n_tags > 1) words_.skip_words(n_tags - 1);
    read_element(type, std::abs(physical_tag));
  }
}

void MshReader::read_elements_4() {
  const std::size_t n_blocks = words_.count("element blocks");
  words_.skip_words(3);
  for (std::size_t block = 0; block < n_blocks; ++block) {
    const int dimension = words_.number<int>("a dimension");
    const int entity = words_.number<int>("an entity's tag");
    const int type = words_.number<int>("an element type");
    const std::size_t n_elements = words_.count("elements");
    const auto physical_tag = physical_tag_of_entity_.find({dimension, entity});
    for (std::size_t i = 0; i < n_elements; ++i) {
      words_.skip_words(1);
      read_element(type, physical_tag == physical_tag_of_entity_.end() ? 0 : physical_tag->second);
    }
  }
}

void MshReader::read_element(const int type, const int physical_tag) {
  constexpr int line = 1, quadrangle = 3, hexahedron = 5, point = 15;
  switch (type) {
    case point:
      return words_.skip_words(1);
    case line:
      return words_.skip_words(2);
    case quadrangle:
      msh_.quadrangles.push_back(read_element_nodes<4>(physical_tag));
      return;
    case hexahedron:
      msh_.hexahedra.push_back(read_element_nodes<8>(physical_tag));
      return;
    default:
      words_.refuse("element type " + std::to_string(type) +
                    " (2 triangle, 4 tetrahedron, 6 prism, 7 pyramid, 8 and above: higher order) "
                    "cannot be read; only first-order hexahedra (5) and quadrangles (3) can: "
                    "extrude recombined surfaces and set Mesh.ElementOrder = 1");
  }
}

template <std::size_t n_nodes>
MshElement<n_nodes> MshReader::read_element_nodes(const int physical_tag) {
  MshElement<n_nodes> element;
  for (unsigned int& node : element.nodes) {
    const long tag = words_.number<long>("a node's tag");
    const auto index = node_index_.find(tag);
    if (index == node_index_.end())
      words_.refuse("an element refers to node " + std::to_string(tag) + ", which is not given");
    node = index->second;
  }
  element.physical_tag = physical_tag;
  element.line = words_.line();
  return element;
}

}  // namespace

MshText read_msh_text(const std::filesystem::path& file) {
  return MshReader(file).read();
}

}  // namespace vibrissa::meshes
