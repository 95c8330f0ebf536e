#include "case/transient_parameters.h"

#include <algorithm>

#include "signals/base/error.h"

namespace vibrissa::sensor_case {

namespace Patterns = dealii::Patterns;

void TransientParameters::declare(dealii::ParameterHandler& prm) {
  prm.enter_subsection("Transient");
  prm.declare_entry("Strain", "finite", Patterns::Selection("small|finite"),
                    "Strain of the solid in 'vibrissa transient': finite allows large rotations "
                    "and stretches, small uses the stiffness at rest.");
  prm.declare_entry("Substeps", "1", Patterns::Integer(1, 100000),
                    "Time steps in one sampling interval of the records [1]; with adaptive "
                    "substeps, the smallest number.");
  prm.declare_entry(
      "Substep choice", "fixed", Patterns::Selection("fixed|adaptive"),
      "fixed: each sampling interval has this number of substeps. adaptive: the number is doubled "
      "until the time tolerance is met and Newton's iteration converges; finite strain only.");
  prm.declare_entry("Time tolerance", "1e-3", Patterns::Double(0., 1.),
                    "Adaptive substeps: largest estimated error of one sampling interval, divided "
                    "by the largest displacement so far [1]; more than 0.");
  prm.declare_entry("Least displacement", "1e-5", Patterns::Double(0.),
                    "Adaptive substeps: smallest displacement to which the time tolerance refers "
                    "[m]; more than 0.");
  prm.declare_entry(
      "Most substeps", "64", Patterns::Integer(1, 100000),
      "Adaptive substeps: largest number in one sampling interval [1]; Substeps times a power of "
      "two. Sampling intervals that need more for the time tolerance are counted.");
  prm.declare_entry("Spectral radius", "0.9", Patterns::Double(0., 1.),
                    "Spectral radius of the integrator at infinite frequency [1]: the factor by "
                    "which one time step multiplies the amplitude there; 1: no numerical damping.");
  prm.declare_entry(
      "Gravity", "0, 0, 0", Patterns::List(Patterns::Double(), 3, 3),
      "Gravity along x, y and z of the base [m/s^2]; the sensor starts in static "
      "equilibrium under it. Finite strain only. 'vibrissa modes' vibrates about that "
      "equilibrium; the other commands refuse gravity.");
  prm.declare_entry("Force tolerance", "1e-7", Patterns::Double(1e-13, 1e-3),
                    "Newton's iteration ends when the out-of-balance force is at most this share "
                    "of the forces in equilibrium [1].");
  prm.declare_entry("Checkpoint interval", "0", Patterns::Integer(0),
                    "Samples between two checkpoints [samples]; 0: by time only.");
  prm.declare_entry("Checkpoint minutes", "10", Patterns::Double(0.),
                    "Time between two checkpoints [min]; 0: by samples only.");
  prm.declare_entry("VTK interval", "0", Patterns::Integer(0),
                    "Samples between two files of displacement and stress [samples]; 0: none.");
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
        "Transient/Gravity needs Transient/Strain = finite: at small strain, gravity changes only "
        "the mean of the moment");
  if (strain == Strain::small && adaptive)
    throw signals::UserError(
        "Transient/Substep choice = adaptive needs Transient/Strain = finite: at small strain, the "
        "matrix is factorised once for one length of the time step");
  if (adaptive) adaptive->check(substeps);
}

}  // namespace vibrissa::sensor_case
