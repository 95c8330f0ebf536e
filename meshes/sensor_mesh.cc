#include "meshes/sensor_mesh.h"

#include <cmath>

#include "meshes/cross_section.h"
#include "meshes/extrusion.h"
#include "meshes/layers.h"
#include "meshes/regions.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::meshes {

namespace {

/// Layers of the coarsest mesh, and how much thicker the coarse end is than the fine one. The error
/// of the first frequency sits at the wire's tip, where the wire leaves the silicone, and at the
/// fin's lower edge. Measured with quadratic elements and pressure in P1: whisker 27.22 and 27.20
/// Hz, flow sensor 37.38 and 37.34 Hz at resolutions 2 and 4.
struct Grading {
  unsigned int n_layers;
  double growth;
  FineEnd fine_end;
};
constexpr Grading below_wire{2, 8., FineEnd::upper};
constexpr Grading embedded_wire{3, 2., FineEnd::both};
constexpr Grading neck{2, 3., FineEnd::both};
constexpr Grading whisker{8, 2., FineEnd::lower};
constexpr Grading blades{2, 100., FineEnd::lower};
constexpr Grading clamped_wire{10, 2., FineEnd::lower};

void check_resolution(const unsigned int resolution) {
  if (resolution < 1 || resolution > max_resolution)
    throw signals::UserError("mesh resolution " + std::to_string(resolution) +
                             " is outside 1 ... " + std::to_string(max_resolution));
}

/// Stacks slabs on top of each other.
class SlabStack {
 public:
  explicit SlabStack(const unsigned int resolution) : resolution_(resolution) {}

  void add(const double thickness, const Grading& grading,
           const std::map<Part, dealii::types::material_id>& region_of) {
    add_up_to(height() + thickness, grading, region_of);
  }

  void add_up_to(const double top, const Grading& grading,
                 const std::map<Part, dealii::types::material_id>& region_of) {
    slabs_.push_back({graded_heights(height(), top, grading.n_layers * resolution_, grading.growth,
                                     grading.fine_end),
                      region_of});
  }

  double height() const { return slabs_.empty() ? 0. : slabs_.back().heights.back(); }
  const std::vector<Slab>& slabs() const { return slabs_; }

 private:
  unsigned int resolution_;
  std::vector<Slab> slabs_;
};

}  // namespace

void make_sensor_mesh(const SensorGeometry& geometry, const unsigned int resolution,
                      dealii::Triangulation<3>& mesh) {
  geometry.check();
  check_resolution(resolution);
  const bool has_fin = geometry.fin != FinShape::none;

  CrossSection section = make_wire_section(geometry.wire_diameter, resolution);
  add_base_rings(section, geometry.base_diameter, resolution);
  if (has_fin) add_blades(section, geometry.fin_thickness, geometry.fin, resolution);

  SlabStack stack(resolution);
  if (geometry.embedded_length < geometry.base_height)
    stack.add(geometry.base_height - geometry.embedded_length, below_wire,
              {{Part::wire, region::silicone}, {Part::base, region::silicone}});
  stack.add_up_to(geometry.base_height, embedded_wire,
                  {{Part::wire, region::wire}, {Part::base, region::silicone}});
  stack.add(geometry.free_length, has_fin ? neck : whisker, {{Part::wire, region::wire}});
  const double fin_bottom = stack.height();
  if (has_fin)
    stack.add(geometry.fin_height, blades, {{Part::wire, region::wire}, {Part::fin, region::fin}});

  const auto blade_width = [&](const double height) {
    return std::lerp(geometry.fin_bottom_width, geometry.fin_top_width,
                     (height - fin_bottom) / geometry.fin_height);
  };
  extrude(section, stack.slabs(), blade_width, mesh);
}

void make_clamped_wire_mesh(const double diameter, const double length,
                            const unsigned int resolution, dealii::Triangulation<3>& mesh) {
  check_resolution(resolution);
  if (!(diameter > 0. && length > 0. && std::isfinite(diameter) && std::isfinite(length)))
    throw signals::UserError("clamped wire: diameter " + signals::to_text(diameter) +
                             " m and length " + signals::to_text(length) + " m must be positive");
  SlabStack stack(resolution);
  stack.add(length, clamped_wire, {{Part::wire, region::wire}});
  const auto no_blades = [](double) { return 0.; };
  extrude(make_wire_section(diameter, resolution), stack.slabs(), no_blades, mesh);
}

}  // namespace vibrissa::meshes
