#include "meshes/regions.h"

#include "signals/base/error.h"

namespace vibrissa::meshes {

namespace {

template <class Id>
std::string name_of(const std::string& kind, const std::map<std::string, Id>& ids, const Id id) {
  std::string known;
  for (const auto& [name, known_id] : ids) {
    if (known_id == id) return name;
    known += (known.empty() ? "" : ", ") + name + " (" + std::to_string(known_id) + ")";
  }
  throw signals::UserError("no " + kind + " has the id " + std::to_string(id) +
                           ". Known: " + known);
}

}  // namespace

const std::map<std::string, dealii::types::material_id>& region_ids() {
  static const std::map<std::string, dealii::types::material_id> ids = {
      {"silicone", region::silicone}, {"wire", region::wire}, {"fin", region::fin}};
  return ids;
}

const std::map<std::string, dealii::types::boundary_id>& boundary_ids() {
  static const std::map<std::string, dealii::types::boundary_id> ids = {
      {"clamp", boundary::clamp},
      {"silicone_surface", boundary::silicone_surface},
      {"wire_surface", boundary::wire_surface},
      {"fin_surface", boundary::fin_surface}};
  return ids;
}

std::string region_name(const dealii::types::material_id id) {
  return name_of("region", region_ids(), id);
}

std::string boundary_name(const dealii::types::boundary_id id) {
  return name_of("boundary", boundary_ids(), id);
}

}  // namespace vibrissa::meshes
