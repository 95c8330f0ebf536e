#include "diagnosis/validation/parameter_estimates.h"

#include <algorithm>
#include <cmath>

#include "signals/base/student.h"

namespace vibrissa::diagnosis {

std::vector<ParameterEstimate> parameter_estimates(const HypothesisFit& fit,
                                                   const std::string& name) {
  const std::vector<std::string> ids = effect_ids(name);
  std::vector<ParameterEstimate> out;
  for (const std::string& id : ids)
    for (std::size_t i = 0; i < fit.fit_parameters.size(); ++i) {
      const FitParameter& fit_parameter = fit.fit_parameters[i];
      if (fit_parameter.effect == nullptr || fit_parameter.effect->id != id) continue;
      const auto index = static_cast<Eigen::Index>(i);
      const Parameter& parameter = fit_parameter.description;
      if (parameter.prior.is_fixed()) continue;
      const double x = fit.x(index), variance = fit.covariance(index, index),
                   half = signals::normal_quantile_975 * std::sqrt(variance);
      const auto value = [&](double at) {
        return parameter.value(std::clamp(at, parameter.prior.low, parameter.prior.high));
      };
      const double reach = 1e-6 * (parameter.prior.high - parameter.prior.low);
      out.push_back(
          {.effect = id,
           .name = parameter.name,
           .unit = parameter.unit,
           .relative_to = parameter.relative_to,
           .value = value(x),
           .ci95 = {value(x - half), value(x + half)},
           .at_limit = x < parameter.prior.low + reach || x > parameter.prior.high - reach});
    }
  return out;
}

}  // namespace vibrissa::diagnosis
