#include "diagnosis/fit/measured_start.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/fit/optimiser.h"

namespace vibrissa::diagnosis {
namespace {

/// The measured mode whose frequency is nearest to the given one, by ratio.
const StructuralMode& nearest(const std::vector<StructuralMode>& measured,
                              const double frequency_rad_s) {
  return *std::ranges::min_element(measured, {}, [&](const StructuralMode& mode) {
    return std::abs(std::log(mode.frequency_rad_s / frequency_rad_s));
  });
}

/// Logarithms of an effect's ratio in each simulated mode.
using Changes = std::vector<double>;

void set_parameter(const std::vector<FitParameter>& fit_parameters, const std::string& effect,
                   const std::string& name, const double value, Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < fit_parameters.size(); ++i)
    if (fit_parameters[i].effect != nullptr && fit_parameters[i].effect->id == effect &&
        fit_parameters[i].description.name == name)
      x(static_cast<Eigen::Index>(i)) = fit_parameters[i].description.coordinate(value);
}

/// Each mode changed by itself, not by the joint.
void set_changes(const std::vector<FitParameter>& fit_parameters, const std::string& effect,
                 const Changes& changes, Eigen::VectorXd& x) {
  set_parameter(fit_parameters, effect, "ratio", std::exp(changes.front()), x);
  set_parameter(fit_parameters, effect, "modal_share", 1., x);
  for (std::size_t k = 1; k < std::min<std::size_t>(changes.size(), 3); ++k) {
    const std::string mode = std::to_string(k + 1);
    set_parameter(fit_parameters, effect, "ratio_of_mode_" + mode,
                  std::exp(changes[k] - 0.5 * changes.front()), x);
    if (changes.front() != 0.)
      set_parameter(fit_parameters, effect, "spread_to_mode_" + mode, changes[k] / changes.front(),
                    x);
  }
}

}  // namespace

std::optional<Eigen::VectorXd> start_at_measured_modes(
    const Experiment& experiment, const std::vector<FitParameter>& fit_parameters,
    const std::string& effect, Eigen::VectorXd x) {
  const std::vector<StructuralMode>& simulated = experiment.nominal.modes;
  if (experiment.measured_modes.empty() || simulated.empty()) return std::nullopt;
  const double first = nearest(experiment.measured_modes, simulated.front().frequency_rad_s)
                           .frequency_rad_s,
               shift = first / simulated.front().frequency_rad_s;
  Changes of_frequency, of_damper;
  for (const StructuralMode& mode : simulated) {
    const StructuralMode& there = nearest(experiment.measured_modes, shift * mode.frequency_rad_s);
    const double change = std::log(there.frequency_rad_s / mode.frequency_rad_s);
    of_frequency.push_back((effect == "mass" ? -2. : 2.) * change);
    of_damper.push_back(std::log(there.damping_ratio / mode.damping_ratio) + change);
  }
  set_changes(fit_parameters, effect, of_frequency, x);
  set_changes(fit_parameters, "damping", of_damper, x);
  clamp(fit_parameters, x);
  return x;
}

}  // namespace vibrissa::diagnosis
