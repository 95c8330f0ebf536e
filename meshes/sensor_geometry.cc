#include "meshes/sensor_geometry.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::meshes {

namespace {

constexpr double smallest_length = 1e-5, largest_length = 1.;  // m
/// Below it the curved cells between wire and blades would overlap.
constexpr double least_fin_to_wire = 1.1;
constexpr const char* subsection = "Geometry";

/// One entry of the case file. Name, meaning and default live only here and in the struct.
struct Length {
  std::string entry;
  double SensorGeometry::*member;
  bool of_fin;
  std::string meaning;
};

const std::vector<Length>& lengths() {
  using G = SensorGeometry;
  static const std::vector<Length> table = {
      {"Base diameter", &G::base_diameter, false,
       "Diameter of the silicone cylinder, which is bonded to the rigid support at z = 0"},
      {"Base height", &G::base_height, false, "Height of the silicone cylinder"},
      {"Wire diameter", &G::wire_diameter, false, "Diameter of the wire along the z axis"},
      {"Embedded length", &G::embedded_length, false,
       "Length of wire inside the silicone, from its top; at most the base height"},
      {"Free length", &G::free_length, false,
       "Length of bare wire above the silicone: up to the fin's lower edge, or up to the tip of a "
       "whisker without a fin"},
      {"Fin height", &G::fin_height, true,
       "Height of the blades; the wire ends flush with their top"},
      {"Fin thickness", &G::fin_thickness, true,
       "Thickness of each blade; at least 1.1 times the wire diameter"},
      {"Fin top width", &G::fin_top_width, true,
       "Full width of the fin, from blade end to opposite blade end, at its top"},
      {"Fin bottom width", &G::fin_bottom_width, true,
       "Full width of the fin at its lower edge; it tapers linearly"},
  };
  return table;
}

const Length& length_named(double SensorGeometry::*member) {
  for (const Length& length : lengths())
    if (length.member == member) return length;
  throw std::logic_error("SensorGeometry: member without an entry");
}

std::string with_value(const SensorGeometry& geometry, double SensorGeometry::*member) {
  return "'" + length_named(member).entry + "' = " + signals::to_text(geometry.*member) + " m";
}

[[noreturn]] void refuse(const std::string& why) {
  throw signals::UserError(std::string("subsection ") + subsection + ": " + why);
}

void check_ranges(const SensorGeometry& geometry) {
  for (const Length& length : lengths()) {
    if (length.of_fin && geometry.fin == FinShape::none) continue;
    const double value = geometry.*length.member;
    if (!(value >= smallest_length && value <= largest_length))
      refuse(with_value(geometry, length.member) + " is outside " +
             signals::to_text(smallest_length) + " ... " + signals::to_text(largest_length) + " m");
  }
}

/// larger - smaller must leave room for a wall on both sides that a mesh can resolve. The wall may
/// be thinner by rounding: lengths are decimal fractions.
void check_wall(const SensorGeometry& geometry, double SensorGeometry::*larger,
                double SensorGeometry::*smaller, const std::string& what) {
  if (0.5 * (geometry.*larger - geometry.*smaller) < smallest_length * (1. - 1e-9))
    refuse(with_value(geometry, larger) + " must exceed " + with_value(geometry, smaller) +
           " by at least " + signals::to_text(2. * smallest_length) + " m, so that " + what);
}

void check_fin_thickness(const SensorGeometry& geometry) {
  using G = SensorGeometry;
  if (geometry.fin_thickness < least_fin_to_wire * (1. - 1e-9) * geometry.wire_diameter)
    refuse(with_value(geometry, &G::fin_thickness) + " must be at least " +
           signals::to_text(least_fin_to_wire) + " times " +
           with_value(geometry, &G::wire_diameter) + ", so that the fin surrounds the wire");
}

void check_embedded_length(const SensorGeometry& geometry) {
  using G = SensorGeometry;
  const double below = geometry.base_height - geometry.embedded_length;
  if (below < 0.)
    refuse(with_value(geometry, &G::embedded_length) + " must not exceed " +
           with_value(geometry, &G::base_height));
  if (below > 0. && below < smallest_length)
    refuse(with_value(geometry, &G::embedded_length) + " leaves a film of silicone thinner than " +
           signals::to_text(smallest_length) + " m below the wire; make it equal to " +
           with_value(geometry, &G::base_height) + " or shorter");
}

}  // namespace

double SensorGeometry::tip_height() const {
  return base_height + free_length + (fin == FinShape::none ? 0. : fin_height);
}

void SensorGeometry::declare(dealii::ParameterHandler& prm) {
  const SensorGeometry defaults;
  const dealii::Patterns::Double range(smallest_length, largest_length);
  prm.enter_subsection(subsection);
  for (const Length& length : lengths())
    prm.declare_entry(length.entry, signals::to_text(defaults.*length.member), range,
                      length.meaning + " [m].");
  prm.declare_entry(
      "Fin", "none", dealii::Patterns::Selection("none|cross|plate"),
      "Shape of the fin: none (whisker sensor), cross (flow sensor with four blades along x and "
      "y), plate (two blades along y, facing a wind along x).");
  prm.leave_subsection();
}

void SensorGeometry::parse(dealii::ParameterHandler& prm) {
  prm.enter_subsection(subsection);
  for (const Length& length : lengths()) this->*length.member = prm.get_double(length.entry);
  const std::string shape = prm.get("Fin");
  fin = shape == "cross" ? FinShape::cross : shape == "plate" ? FinShape::plate : FinShape::none;
  prm.leave_subsection();
}

void SensorGeometry::check() const {
  using G = SensorGeometry;
  check_ranges(*this);
  check_wall(*this, &G::base_diameter, &G::wire_diameter, "silicone surrounds the wire");
  check_embedded_length(*this);
  if (fin == FinShape::none) return;
  check_fin_thickness(*this);
  check_wall(*this, &G::fin_top_width, &G::fin_thickness, "the blades are wider than thick");
  check_wall(*this, &G::fin_bottom_width, &G::fin_thickness, "the blades are wider than thick");
}

}  // namespace vibrissa::meshes
