#include "diagnosis/fit/fit_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vibrissa::diagnosis {
namespace {

/// Spread of the logarithm of the accelerometers' usual noise.
constexpr double usual_spread = 0.3;
/// The same where neither rest nor repeats show the noise: the quietest part of the spectrum is an
/// upper bound.
constexpr double unknown_spread = 1.;
/// Frequency below which flicker noise of electronics usually exceeds their white noise [Hz], and
/// the spread of its logarithm.
constexpr double usual_flicker_hz = 0.3, flicker_spread = 1.5;
/// Usual form error of an effect, relative to its documented limit.
constexpr double usual_form_level = 0.3;
/// Spread of the logarithm of a simulation's accuracy.
constexpr double accuracy_spread = 1.;
/// Usual relative error that a bench adds anew in each record and at each frequency.
constexpr double usual_incoherence = 0.002, largest_incoherence = 0.04;
/// Largest level of a narrow discrepancy, relative to the accuracy.
constexpr double most_inaccurate = 5.;
/// Upper edges of the bands of an unknown cause, relative to the first mode's frequency; the last
/// band has none.
constexpr std::array<double, 4> unknown_edges{0.5, 0.9, 1.1, 2.};

/// The joint's share in the damping of the first mode is at most 1.
double most_joint_loss(const NominalModel& nominal) {
  constexpr double most = 1.3, least = 1.;
  if (nominal.modes.empty()) return most;
  const StructuralMode& mode = nominal.modes.front();
  const double viscous = nominal.joint_viscous_ratio();
  return viscous > 0. ? std::clamp(2. * mode.damping_ratio / viscous, least, most) : most;
}

/// Positive level whose logarithm is normal about the logarithm of its usual value.
Parameter level(std::string name, std::string unit, const double usual, const double spread,
                const double low, const double high) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .logarithmic = true,
          .prior = {.kind = Prior::Kind::normal,
                    .centre = std::log(usual),
                    .scale = spread,
                    .low = std::log(low),
                    .high = std::log(high)}};
}

/// Parameters of every hypothesis: noise, joint, errors that every simulation has.
std::vector<FitParameter> common_parameters(const Experiment& experiment) {
  std::vector<FitParameter> out(n_common_parameters);
  const double m = std::log(experiment.moment_noise);
  out[index_of_moment_noise].description = {
      .name = "moment_noise",
      .unit = "N m",
      .logarithmic = true,
      .prior = {.kind = Prior::Kind::uniform, .low = m - 4., .high = m + 4.}};
  const bool is_measured = experiment.acceleration_noise_is_measured;
  out[index_of_acceleration_noise].description =
      level("acceleration_noise", "m/s^2",
            is_measured ? usual_acceleration_noise : experiment.acceleration_noise,
            is_measured ? usual_spread : unknown_spread, 1e-6, 20.);
  out[index_of_flicker].description =
      level("flicker_corner", "Hz", usual_flicker_hz, flicker_spread, 1e-3, 50.);
  out[index_of_joint_share].description =
      normal("joint_share", "1", experiment.nominal.joint_share,
             experiment.nominal.joint_share_deviation, 0.3, 1., 1.);
  out[index_of_joint_loss].description =
      normal("joint_loss_factor", "1", experiment.nominal.joint_loss_factor, 0.05, 0.7,
             most_joint_loss(experiment.nominal), 1.);
  out[index_of_higher_joint_share].description =
      normal("higher_joint_share", "1", experiment.nominal.higher_joint_share,
             experiment.nominal.higher_joint_share_deviation, 0., 1., 1.);
  const double accuracy = experiment.simulation_accuracy,
               without_cause = std::sqrt(power_without_cause(accuracy));
  for (std::size_t i = 0; i < n_discrepancy_levels; ++i)
    out[index_of_discrepancy + i].description =
        level("discrepancy", "1", accuracy, accuracy_spread, 1e-5,
              i < n_record_kinds ? most_inaccurate * accuracy : without_cause);
  out[index_of_incoherence].description =
      level("incoherent_error", "1", usual_incoherence, accuracy_spread, 1e-6, largest_incoherence);
  return out;
}

void add_parameters(const Experiment& experiment, const Effect& effect, const bool nuisance,
                    std::vector<FitParameter>& out) {
  for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
    out.push_back({&effect, i, effect.parameters[i], nuisance});
    Prior& prior = out.back().description.prior;
    if (effect.parameters[i].mode > experiment.nominal.modes.size()) prior.fix();
    if (effect.parameters[i].in_moved_band)
      prior.high = std::clamp(std::log(experiment.scales.moved_band_hz), prior.low, prior.high);
    // Half of all sensors are as simulated, within a part of the building tolerance; the tails are
    // heavy, because some are far off.
    if (nuisance && i == 0 && prior.kind == Prior::Kind::normal) {
      prior.kind = Prior::Kind::student;
      prior.degrees_of_freedom = 1.;
      prior.scale *= as_simulated;
    }
  }
}

/// Only an additional moment of the joint moves the modes above the first.
bool moves_higher_modes(const Experiment& experiment, const Hypothesis& hypothesis) {
  const auto has_law = [](const Effect* effect) { return !probe(*effect).joint.empty(); };
  return experiment.nominal.modes.size() > 1 &&
         (std::ranges::any_of(hypothesis.effects(), has_law) ||
          !experiment.nominal_chain().joint.empty());
}

}  // namespace

std::size_t n_unknown_bands() {
  return unknown_edges.size() + 1;
}

std::size_t unknown_band(const double frequency_ratio) {
  return static_cast<std::size_t>(
      std::upper_bound(unknown_edges.begin(), unknown_edges.end(), frequency_ratio) -
      unknown_edges.begin());
}

std::vector<FitParameter> make_fit_parameters(const Experiment& experiment,
                                              const Hypothesis& hypothesis) {
  std::vector<FitParameter> out = common_parameters(experiment);
  if (!moves_higher_modes(experiment, hypothesis))
    out[index_of_higher_joint_share].description.prior.fix();
  for (const std::string& id : nuisance_ids()) {
    const Effect& effect = find_effect(id);
    if (shows(experiment, effect) && !hypothesis.contains(id))
      add_parameters(experiment, effect, true, out);
  }
  for (const Effect* effect : hypothesis.effects()) add_parameters(experiment, *effect, false, out);
  if (hypothesis.is_discrepancy())
    for (std::size_t i = 0; i < n_unknown_bands(); ++i)
      out.push_back({nullptr, i, log_uniform("unknown_cause", "1", 1e-4, 1., 0.), false});
  if (!hypothesis.effects().empty())
    out.push_back({nullptr, 0,
                   level(form_error_level, "1", usual_form_level, accuracy_spread, 1e-3, 1.),
                   false});
  return out;
}

Chain make_chain(const Experiment& experiment, const std::vector<FitParameter>& fit_parameters,
                 const Eigen::VectorXd& x, const Effect* left_out) {
  Chain chain = experiment.nominal_chain();
  chain.joint_share = x(index_of_joint_share);
  chain.joint_loss_factor = x(index_of_joint_loss);
  chain.higher_joint_share = x(index_of_higher_joint_share);
  for (std::size_t i = n_common_parameters; i < fit_parameters.size();) {
    const Effect* effect = fit_parameters[i].effect;
    if (effect == nullptr) break;  // form errors and the unknown cause come last
    std::vector<double> values;
    for (; i < fit_parameters.size() && fit_parameters[i].effect == effect; ++i)
      values.push_back(fit_parameters[i].description.value(x(static_cast<Eigen::Index>(i))));
    if (effect != left_out) effect->extend(chain, values, experiment.scales);
  }
  return chain;
}

}  // namespace vibrissa::diagnosis
