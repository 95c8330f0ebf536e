#include "case/transient_parameters.h"

#include <algorithm>

#include "signals/base/error.h"

namespace vibrissa::sensor_case {

namespace Patterns = dealii::Patterns;

void TransientParameters::declare(dealii::ParameterHandler& prm) {
  prm.enter_subsection("Transient");
  prm.declare_entry("Strain", "finite", Patterns::Selection("small|finite"),
                    "Whether 'vibrissa transient' lets the solid turn and stretch at will, or "
                    "takes its stiffness at rest.");
  prm.declare_entry("Substeps", "1", Patterns::Integer(1, 100000),
                    "Steps of the integrator in one sample of the records [1]; the least number "
                    "where they are chosen.");
  prm.declare_entry("Substep choice", "fixed", Patterns::Selection("fixed|adaptive"),
                    "Whether every sample has those substeps, or as many, doubled and doubled "
                    "again, as the time tolerance and Newton's iteration ask for. Finite strain "
                    "only.");
  prm.declare_entry("Time tolerance", "1e-3", Patterns::Double(0., 1.),
                    "Adaptive: estimated error of the steps of one sample over the largest "
                    "displacement so far [1]; more than 0.");
  prm.declare_entry("Least displacement", "1e-5", Patterns::Double(0.),
                    "Adaptive: the time tolerance is a share of at least this [m]; more than 0.");
  prm.declare_entry("Most substeps", "64", Patterns::Integer(1, 100000),
                    "Adaptive: in one sample [1]; a power of two times the substeps. Samples that "
                    "need more for the time tolerance are counted.");
  prm.declare_entry("Spectral radius", "0.9", Patterns::Double(0., 1.),
                    "What the integrator leaves of infinitely high frequencies a step [1]; 1 keeps "
                    "all energy.");
  prm.declare_entry("Gravity", "0, 0, 0", Patterns::List(Patterns::Double(), 3, 3),
                    "Along x, y, z of the base [m/s^2]; the sensor begins at rest in it. Finite "
                    "strain only.");
  prm.declare_entry("Force tolerance", "1e-7", Patterns::Double(1e-13, 1e-3),
                    "Out-of-balance force, over the forces that balance, at which Newton's "
                    "iteration ends [1].");
  prm.declare_entry("Checkpoint interval", "0", Patterns::Integer(0),
                    "Samples from one checkpoint to the next [samples]; 0: by time only.");
  prm.declare_entry("Checkpoint minutes", "10", Patterns::Double(0.),
                    "Time from one checkpoint to the next [min]; 0: by samples only.");
  prm.declare_entry("VTK interval", "0", Patterns::Integer(0),
                    "Samples from one file of displacement and stress to the next [samples]; 0: "
                    "none.");
  prm.leave_subsection();
}

void TransientParameters::parse(dealii::ParameterHandler& prm) {
  prm.enter_subsection("Transient");
  strain = prm.get("Strain") == "small" ? Strain::small : Strain::finite;
  substeps = static_cast<unsigned int>(prm.get_integer("Substeps"));
  if (prm.get("Substep choice") == "adaptive")
    adaptive = {prm.get_double("Time tolerance"), prm.get_double("Least displacement"),
                static_cast<unsigned int>(prm.get_integer("Most substeps"))};
  spectral_radius = prm.get_double("Spectral radius");
  const auto gravity = dealii::Utilities::string_to_double(
      dealii::Utilities::split_string_list(prm.get("Gravity"), ','));
  std::copy(gravity.begin(), gravity.end(), gravity_m_s2.begin());
  newton.tolerance = prm.get_double("Force tolerance");
  checkpoint_samples = static_cast<std::size_t>(prm.get_integer("Checkpoint interval"));
  checkpoint_minutes = prm.get_double("Checkpoint minutes");
  vtk_samples = static_cast<std::size_t>(prm.get_integer("VTK interval"));
  prm.leave_subsection();
  const bool is_weightless =
      std::all_of(gravity.begin(), gravity.end(), [](const double g) { return g == 0.; });
  if (strain == Strain::small && !is_weightless)
    throw signals::UserError(
        "Transient/Gravity needs Transient/Strain = finite: at small strain weight changes nothing "
        "but the moment's mean");
  if (strain == Strain::small && adaptive)
    throw signals::UserError(
        "Transient/Substep choice = adaptive needs Transient/Strain = finite: at small strain the "
        "matrix is factorised once, for steps of one length");
  if (adaptive) adaptive->check(substeps);
}

}  // namespace vibrissa::sensor_case
