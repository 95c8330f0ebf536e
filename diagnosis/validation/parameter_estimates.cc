#include "diagnosis/validation/parameter_estimates.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "diagnosis/model/hypothesis.h"
#include "signals/base/student.h"

namespace vibrissa::diagnosis {
namespace {

constexpr std::size_t ratio_number = 0, wire_share_number = 2;

/// Estimate of a ratio from its logarithm as a function of the fit's coordinates.
ParameterEstimate estimate(const HypothesisFit& fit, const std::string& effect,
                           const std::string& name,
                           const std::function<double(const Eigen::VectorXd& x)>& log_ratio) {
  constexpr double step = 1e-5;
  const double here = log_ratio(fit.x);
  Eigen::VectorXd gradient(fit.x.size());
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    const Eigen::VectorXd along = step * Eigen::VectorXd::Unit(gradient.size(), i);
    gradient(i) = (log_ratio(fit.x + along) - log_ratio(fit.x - along)) / (2. * step);
  }
  const double half = signals::normal_quantile_975 *
                      std::sqrt(std::max(0., gradient.dot(fit.covariance * gradient)));
  return {.effect = effect,
          .name = name,
          .unit = "1",
          .value = std::exp(here),
          .ci95 = {std::exp(here - half), std::exp(here + half)}};
}

void add_stiffness(const NominalModel& nominal, const HypothesisFit& fit,
                   std::vector<ParameterEstimate>& out) {
  const ParameterPath *silicone = nominal.path("silicone_modulus"),
                      *wire = nominal.path("wire_modulus");
  const auto ratio = fit.index("stiffness", ratio_number),
             share = fit.index("stiffness", wire_share_number);
  if (!silicone || !wire || !ratio || !share) return;
  const auto add = [&](const std::string& name, const ParameterPath& path, const bool is_wire) {
    out.push_back(estimate(fit, "stiffness", name, [&](const Eigen::VectorXd& x) {
      const double of_wire = x(static_cast<Eigen::Index>(*share));
      const double log_ratio =
          (is_wire ? of_wire : 1. - of_wire) * x(static_cast<Eigen::Index>(*ratio));
      return std::log(spring_ratio(std::exp(log_ratio), NominalModel::compliance_share(path)));
    }));
  };
  add("silicone_modulus_ratio", *silicone, false);
  add("wire_modulus_ratio", *wire, true);
}

void add_mass(const NominalModel& nominal, const HypothesisFit& fit,
              std::vector<ParameterEstimate>& out) {
  const std::string name = nominal.mass_parameter();
  const ParameterPath* path = nominal.path(name);
  const auto ratio = fit.index("mass", ratio_number);
  if (!path || !ratio) return;
  const double slope = -0.5 / path->frequency.front();
  out.push_back(estimate(fit, "mass", name + "_ratio", [&](const Eigen::VectorXd& x) {
    return slope * x(static_cast<Eigen::Index>(*ratio));
  }));
}

}  // namespace

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
      std::array<double, 2> ci95{x - half, x + half};
      const auto wider = fit.calibration_intervals.find(id);
      if (fit_parameter.parameter == 0 && wider != fit.calibration_intervals.end())
        ci95 = {std::min(x, wider->second[0]), std::max(x, wider->second[1])};
      const double reach = 1e-6 * (parameter.prior.high - parameter.prior.low);
      out.push_back(
          {.effect = id,
           .name = parameter.name,
           .unit = parameter.unit,
           .relative_to = parameter.relative_to,
           .value = value(x),
           .ci95 = {value(ci95[0]), value(ci95[1])},
           .at_limit = x < parameter.prior.low + reach || x > parameter.prior.high - reach});
    }
  return out;
}

std::vector<ParameterEstimate> material_estimates(const NominalModel& nominal,
                                                  const HypothesisFit& fit,
                                                  const std::string& answer) {
  const std::vector<std::string> ids = effect_ids(answer);
  std::vector<ParameterEstimate> out;
  if (std::ranges::count(ids, "stiffness") > 0) add_stiffness(nominal, fit, out);
  if (std::ranges::count(ids, "mass") > 0) add_mass(nominal, fit, out);
  // A parameter that hardly changes the resonance cannot be determined from it.
  constexpr double largest_ratio = 100.;
  std::erase_if(out, [](const ParameterEstimate& estimate) {
    return !(estimate.ci95[1] < largest_ratio * estimate.ci95[0]);
  });
  return out;
}

}  // namespace vibrissa::diagnosis
