#include "diagnosis/validation/parameter_estimates.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/model/hypothesis.h"
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

namespace {

constexpr std::size_t ratio_number = 0, wire_share_number = 2;

/// Estimate from the logarithm of a ratio and its gradient by fit parameters.
ParameterEstimate estimate(const HypothesisFit& fit, const std::string& effect,
                           const std::string& name, const double log_ratio,
                           const std::vector<std::pair<std::size_t, double>>& gradient) {
  double variance = 0.;
  for (const auto& [i, slope_i] : gradient)
    for (const auto& [j, slope_j] : gradient)
      variance += slope_i * slope_j *
                  fit.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  const double half = signals::normal_quantile_975 * std::sqrt(std::max(0., variance));
  return {.effect = effect,
          .name = name,
          .unit = "1",
          .value = std::exp(log_ratio),
          .ci95 = {std::exp(log_ratio - half), std::exp(log_ratio + half)}};
}

/// ln of spring_ratio(exp(log_ratio), share), and its slope by log_ratio.
struct Spring {
  Spring(const double log_ratio, const double share)
      : log_value(std::log(spring_ratio(std::exp(log_ratio), share))),
        slope(std::exp(log_value - log_ratio) / share) {}
  double log_value, slope;
};

void add_stiffness(const NominalModel& nominal, const HypothesisFit& fit,
                   std::vector<ParameterEstimate>& out) {
  const ParameterPath *silicone = nominal.path("silicone_modulus"),
                      *wire = nominal.path("wire_modulus");
  const auto ratio = fit.index("stiffness", ratio_number),
             share = fit.index("stiffness", wire_share_number);
  if (!silicone || !wire || !ratio || !share) return;
  const double log_ratio = fit.x(static_cast<Eigen::Index>(*ratio)),
               wire_share = fit.x(static_cast<Eigen::Index>(*share));
  const Spring of_silicone((1. - wire_share) * log_ratio,
                           NominalModel::compliance_share(*silicone)),
      of_wire(wire_share * log_ratio, NominalModel::compliance_share(*wire));
  out.push_back(estimate(
      fit, "stiffness", "silicone_modulus_ratio", of_silicone.log_value,
      {{*ratio, of_silicone.slope * (1. - wire_share)}, {*share, -of_silicone.slope * log_ratio}}));
  out.push_back(
      estimate(fit, "stiffness", "wire_modulus_ratio", of_wire.log_value,
               {{*ratio, of_wire.slope * wire_share}, {*share, of_wire.slope * log_ratio}}));
}

void add_mass(const NominalModel& nominal, const HypothesisFit& fit,
              std::vector<ParameterEstimate>& out) {
  const std::string name = nominal.mass_parameter();
  const ParameterPath* path = nominal.path(name);
  const auto ratio = fit.index("mass", ratio_number);
  if (!path || !ratio) return;
  const double slope = -0.5 / path->frequency.front();
  out.push_back(estimate(fit, "mass", name + "_ratio",
                         slope * fit.x(static_cast<Eigen::Index>(*ratio)), {{*ratio, slope}}));
}

}  // namespace

std::vector<ParameterEstimate> material_estimates(const NominalModel& nominal,
                                                  const HypothesisFit& fit,
                                                  const std::string& answer) {
  const std::vector<std::string> ids = effect_ids(answer);
  const auto names = [&](const char* id) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  };
  std::vector<ParameterEstimate> out;
  if (names("stiffness")) add_stiffness(nominal, fit, out);
  if (names("mass")) add_mass(nominal, fit, out);
  // A parameter that hardly changes the resonance cannot be determined from it.
  constexpr double largest_ratio = 100.;
  std::erase_if(out, [](const ParameterEstimate& estimate) {
    return !(estimate.ci95[1] < largest_ratio * estimate.ci95[0]);
  });
  return out;
}

}  // namespace vibrissa::diagnosis
