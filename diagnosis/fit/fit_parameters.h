#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "diagnosis/model/hypothesis.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// One free parameter of a fit: a noise level, a joint parameter, a nuisance, a parameter of an
/// effect, the share of the model form error or a level of a discrepancy.
struct FitParameter {
  const Effect* effect = nullptr;  // nullptr: belongs to no effect
  std::size_t parameter = 0;       // index in the effect, or band of the discrepancy
  Parameter description{};
  bool nuisance = false;
};

/// Indices of the parameters that belong to no effect; model form error or discrepancy come last.
inline constexpr std::size_t index_of_moment_noise = 0, index_of_acceleration_noise = 1,
                             index_of_joint_share = 2, index_of_joint_loss = 3,
                             n_noise_parameters = 2, n_common_parameters = 4;

/// Number of bands of a discrepancy, and the band of a frequency (relative to the first mode's
/// frequency).
std::size_t n_discrepancy_bands();
std::size_t discrepancy_band(double frequency_ratio);

/// The free parameters of a hypothesis: noise levels, joint, nuisances, parameters of the effects,
/// and the share of the effects' model form errors, or the levels of the discrepancy.
std::vector<FitParameter> make_fit_parameters(const Experiment& experiment,
                                              const Hypothesis& hypothesis);

/// The chain at coordinates x of the parameters, without the effect left_out.
Chain make_chain(const Experiment& experiment, const std::vector<FitParameter>& fit_parameters,
                 const Eigen::VectorXd& x, const Effect* left_out = nullptr);

}  // namespace vibrissa::diagnosis
