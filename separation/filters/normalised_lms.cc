#include "separation/filters/normalised_lms.h"

#include <cmath>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

std::size_t checked_length(const NlmsOptions& options, const std::string& filter) {
  const auto refuse = [&](const std::string& name, double value, const std::string& rule) {
    throw signals::UserError(filter + ": " + name + " = " + signals::to_text(value) + " must be " +
                             rule);
  };
  if (options.filter_length == 0) refuse("filter_length", 0., "at least 1");
  if (!(options.step > 0. && options.step < 2.))
    refuse("step", options.step, "above 0 and below 2");
  if (!(options.regularisation >= 0. && std::isfinite(options.regularisation)))
    refuse("regularisation", options.regularisation, "finite and not negative");
  return options.filter_length;
}

}  // namespace

NormalisedLms::NormalisedLms(const NlmsOptions& options, const std::string& filter_name)
    : options_(options),
      window_(checked_length(options, filter_name)),
      taps_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(options.filter_length))) {}

void NormalisedLms::clear() {
  window_.clear();
  guard_.clear();
  taps_.setZero();
  sum_of_energies_ = n_samples_ = 0.;
}

double NormalisedLms::step(double x, double d) {
  window_.push(x);
  const auto samples = window_.samples();
  guard_.hear(&d, 1);
  double estimate = taps_.dot(samples);
  if (!guard_.accepts(estimate)) {
    taps_.setZero();
    estimate = 0.;
  }
  const double error = d - estimate, energy = samples.squaredNorm();
  sum_of_energies_ += energy;
  n_samples_ += 1.;
  const double scale = energy + options_.regularisation * sum_of_energies_ / n_samples_;
  // Below the smallest normal number a quotient would overflow; such an input counts as zero.
  if (scale > 1e-290) taps_ += (options_.step * error / scale) * samples;
  return error;
}

}  // namespace vibrissa::separation
