#include "materials/sensor_materials.h"

#include <deal.II/base/utilities.h>

#include <sstream>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::materials {

namespace {

using dealii::ParameterHandler;
using dealii::Patterns::Double;
using dealii::Patterns::List;
using dealii::Patterns::Selection;

std::string text(const double value) {
  std::ostringstream out;
  out.precision(12);  // hides the last bits of moduli recomputed from one another
  out << value;
  return out.str();
}

void declare_body(ParameterHandler& prm, const Material& nominal) {
  prm.declare_entry("Density", text(nominal.density), Double(1., 1e5),
                    "Mass per undeformed volume [kg/m^3].");
  prm.declare_entry("Loss factor", text(nominal.loss_factor), Double(0., 10.),
                    "Loss factor of the material [1], the same at all frequencies; 0: this "
                    "material adds no damping.");
  prm.declare_entry(
      "Prony moduli", "", List(Double(0.), 0, 20),
      "Shear moduli of the Prony branches, divided by the shear modulus at infinite time, which "
      "the other entries give [1]; used by the transient at finite strain; empty: none.");
  prm.declare_entry("Prony times", "", List(Double(1e-9), 0, 20),
                    "Relaxation times of the Prony branches [s].");
}

std::vector<double> numbers(ParameterHandler& prm, const std::string& entry) {
  return dealii::Utilities::string_to_double(
      dealii::Utilities::split_string_list(prm.get(entry), ','));
}

PronySeries parse_relaxation(ParameterHandler& prm) {
  const auto moduli = numbers(prm, "Prony moduli"), times = numbers(prm, "Prony times");
  if (moduli.size() != times.size())
    throw signals::UserError("Prony moduli has " + std::to_string(moduli.size()) +
                             " entries and Prony times " + std::to_string(times.size()) +
                             "; give the same number of both");
  std::vector<PronyBranch> branches;
  for (std::size_t i = 0; i < moduli.size(); ++i) branches.push_back({moduli[i], times[i]});
  return PronySeries(branches);
}

void declare_rubber(ParameterHandler& prm, const Material& nominal) {
  const auto& c = std::get<Yeoh>(nominal.isochoric).c;
  const std::string energy =
      "Pa, in the strain energy W = c1 x + c2 x^2 + c3 x^3 per undeformed volume, x = I1bar - 3";
  prm.declare_entry("c1", text(c[0]), Double(1., 1e12),
                    "Yeoh coefficient [" + energy + "]; the shear modulus at rest is 2 c1.");
  prm.declare_entry("c2", text(c[1]), Double(), "Yeoh coefficient [" + energy + "].");
  prm.declare_entry("c3", text(c[2]), Double(), "Yeoh coefficient [" + energy + "].");
  prm.declare_entry("Bulk modulus", text(nominal.volumetric.bulk_modulus), Double(10., 1e13),
                    "Bulk modulus [Pa]; at least 20 c1 (ten shear moduli).");
  prm.declare_entry("Volumetric law", "quadratic", Selection("quadratic|Hartmann-Neff"),
                    "Energy of a volume change per undeformed volume: quadratic is K/2 (J - 1)^2, "
                    "Hartmann-Neff K/50 (J^5 + J^-5 - 2). They differ only at large strain.");
  declare_body(prm, nominal);
}

void declare_elastic(ParameterHandler& prm, const Material& nominal) {
  prm.declare_entry("Young modulus", text(nominal.youngs_modulus_at_rest()), Double(1., 1e13),
                    "Young's modulus at small strain [Pa].");
  prm.declare_entry("Poisson ratio", text(nominal.poisson_ratio_at_rest()), Double(-0.99, 0.4999),
                    "Poisson's ratio at small strain [1].");
  declare_body(prm, nominal);
}

Material parse_rubber(ParameterHandler& prm) {
  return make_yeoh({prm.get_double("c1"), prm.get_double("c2"), prm.get_double("c3")},
                   prm.get_double("Bulk modulus"), prm.get_double("Density"),
                   prm.get_double("Loss factor"),
                   prm.get("Volumetric law") == "quadratic" ? VolumetricLaw::Kind::quadratic
                                                            : VolumetricLaw::Kind::hartmann_neff);
}

Material parse_elastic(ParameterHandler& prm) {
  return make_elastic(prm.get_double("Young modulus"), prm.get_double("Poisson ratio"),
                      prm.get_double("Density"), prm.get_double("Loss factor"));
}

Material parse_subsection(ParameterHandler& prm, const std::string& name,
                          Material (*const parse_entries)(ParameterHandler&)) {
  prm.enter_subsection(name);
  try {
    Material material = parse_entries(prm);
    material.relaxation = parse_relaxation(prm);
    prm.leave_subsection();
    return material;
  } catch (const signals::UserError& error) {
    throw signals::UserError("subsection Materials/" + name + ": " + error.what());
  }
}

}  // namespace

void SensorMaterials::declare(ParameterHandler& prm) {
  const SensorMaterials nominal;
  prm.enter_subsection("Materials");
  prm.enter_subsection("Silicone");
  declare_rubber(prm, nominal.silicone);
  prm.leave_subsection();
  prm.enter_subsection("Wire");
  declare_elastic(prm, nominal.wire);
  prm.leave_subsection();
  prm.enter_subsection("Fin");
  declare_elastic(prm, nominal.fin);
  prm.leave_subsection();
  prm.leave_subsection();
}

void SensorMaterials::parse(ParameterHandler& prm) {
  prm.enter_subsection("Materials");
  silicone = parse_subsection(prm, "Silicone", parse_rubber);
  wire = parse_subsection(prm, "Wire", parse_elastic);
  fin = parse_subsection(prm, "Fin", parse_elastic);
  prm.leave_subsection();
}

std::map<std::string, Material> SensorMaterials::by_region() const {
  return {{"silicone", silicone}, {"wire", wire}, {"fin", fin}};
}

}  // namespace vibrissa::materials
