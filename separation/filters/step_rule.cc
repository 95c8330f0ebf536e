#include "separation/filters/step_rule.h"

#include <cmath>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

void require(bool good, const std::string& name, double value, const std::string& rule) {
  if (!good)
    throw signals::UserError("adaptive filter: " + name + " = " + signals::to_text(value) +
                             " must be " + rule);
}

void check(const StepOptions& options) {
  const bool normalised = options.normalisation == StepNormalisation::power;
  require(options.step > 0. && std::isfinite(options.step) && (!normalised || options.step < 2.),
          "step", options.step, normalised ? "above 0 and below 2" : "positive and finite");
  require(options.power_forgetting >= 0. && options.power_forgetting < 1., "power_forgetting",
          options.power_forgetting, "at least 0 and below 1");
  require(options.regularisation >= 0. && std::isfinite(options.regularisation), "regularisation",
          options.regularisation, "finite and not negative");
}

}  // namespace

StepRule::StepRule(const StepOptions& options, Eigen::Index n_bins)
    : options_(options), power_(n_bins), step_(n_bins) {
  check(options);
  clear();
}

void StepRule::clear() {
  power_.setZero();
  step_.setConstant(options_.normalisation == StepNormalisation::fixed ? options_.step : 0.);
  sum_of_means_ = n_blocks_ = 0.;
}

const Eigen::ArrayXd& StepRule::update(const Eigen::ArrayXd& power) {
  if (options_.normalisation == StepNormalisation::fixed) return step_;
  const double lambda = options_.smoothing == PowerSmoothing::none ? 0. : options_.power_forgetting;
  power_ = lambda * power_ + (1. - lambda) * power;
  if (options_.smoothing == PowerSmoothing::guarded) power_ = power.max(power_);
  sum_of_means_ += power.mean();
  n_blocks_ += 1.;
  const double floor = options_.regularisation * sum_of_means_ / n_blocks_;
  // Below the smallest normal number a quotient would overflow; such a bin counts as zero.
  constexpr double silence = std::numeric_limits<double>::min() * 1e10;
  step_ = (power_ + floor > silence).select(options_.step / (power_ + floor), 0.);
  return step_;
}

}  // namespace vibrissa::separation
