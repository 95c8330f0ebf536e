#include "diagnosis/fit/noise_levels.h"

#include <cmath>

namespace vibrissa::diagnosis {
namespace {

NoiseLevel noise_level(const HypothesisFit& fit, const std::size_t fit_parameter) {
  const auto index = static_cast<Eigen::Index>(fit_parameter);
  return {std::exp(2. * fit.x(index)), std::sqrt(fit.covariance(index, index))};
}

}  // namespace

NoiseLevels noise_levels(const Experiment& experiment, const HypothesisFit& fit,
                         const Chain& chain) {
  NoiseLevels levels{noise_level(fit, index_of_moment_noise),
                     noise_level(fit, index_of_acceleration_noise)};
  double lines = 0.;
  for (const PreparedRecord& record : experiment.records)
    if (record.excitation == signals::Excitation{})
      lines += 0.5 * static_cast<double>(record.n_bins());
    else if (record.periodic)
      lines += 0.5 * static_cast<double>(record.n_acceleration_noise);
  if (lines < 32.) return levels;
  const double deviation = 0.5 / std::sqrt(lines);
  levels.moment = {experiment.moment_noise * experiment.moment_noise, deviation};
  if (chain.reference_variance == 0.)
    levels.acceleration = {experiment.acceleration_noise * experiment.acceleration_noise,
                           deviation};
  return levels;
}

}  // namespace vibrissa::diagnosis
