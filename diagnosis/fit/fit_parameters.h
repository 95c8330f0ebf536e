#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "diagnosis/fit/model_discrepancy.h"
#include "diagnosis/model/hypothesis.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// One free parameter of a fit: a noise level, a joint parameter, the level of the simulation's
/// discrepancy, a nuisance, a parameter of an effect or a level of an unknown cause.
struct FitParameter {
  const Effect* effect = nullptr;  // nullptr: belongs to no effect
  std::size_t parameter = 0;       // index in the effect, or band of an unknown cause
  Parameter description{};
  bool nuisance = false;
};

/// Indices of the parameters that belong to no effect; the levels of an unknown cause come last.
/// The discrepancy (model_discrepancy.h) has three levels for each kind of record. Below its corner
/// the flicker noise of the moment (density as 1 / f, Keshner 1982) exceeds the white noise.
inline constexpr std::size_t index_of_moment_noise = 0, index_of_acceleration_noise = 1,
                             index_of_flicker = 2, index_of_joint_share = 3,
                             index_of_joint_loss = 4, index_of_higher_joint_share = 5,
                             index_of_discrepancy = 6, n_noise_parameters = 3,
                             index_of_incoherence = index_of_discrepancy + n_discrepancy_levels,
                             n_common_parameters = index_of_incoherence + 1;

/// Part of the building tolerance within which half of all sensors are: scale of the prior of a
/// calibration parameter.
inline constexpr double as_simulated = 1. / 3.;

/// Factor on the spread of that prior that gives its centre the curvature of a normal distribution
/// with the building tolerance.
inline const double spreads_of_tolerance = std::numbers::sqrt2 / as_simulated;

/// Name of the last parameter of a hypothesis with effects: factor on their form errors.
inline const std::string form_error_level = "form_error_level";

/// Number of bands of an unknown cause, and the band of a frequency (relative to the first mode's
/// frequency).
std::size_t n_unknown_bands();
std::size_t unknown_band(double frequency_ratio);

/// The free parameters of a hypothesis: noise levels, joint, discrepancy, nuisances, parameters of
/// the effects, level of their form errors or levels of the unknown cause.
std::vector<FitParameter> make_fit_parameters(const Experiment& experiment,
                                              const Hypothesis& hypothesis);

/// The chain at coordinates x of the parameters, without the effect left_out.
Chain make_chain(const Experiment& experiment, const std::vector<FitParameter>& fit_parameters,
                 const Eigen::VectorXd& x, const Effect* left_out = nullptr);

}  // namespace vibrissa::diagnosis
