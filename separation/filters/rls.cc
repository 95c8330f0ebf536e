#include "separation/filters/rls.h"

#include <cassert>
#include <cmath>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

std::size_t checked_length(const RlsOptions& options) {
  const auto refuse = [](const std::string& name, double value, const std::string& rule) {
    throw signals::UserError("RLS filter: " + name + " = " + signals::to_text(value) + " must be " +
                             rule);
  };
  if (options.filter_length == 0) refuse("filter_length", 0., "at least 1");
  if (!(options.forgetting > 0. && options.forgetting <= 1.))
    refuse("forgetting", options.forgetting, "above 0 and at most 1");
  if (!(options.regularisation >= 0. && std::isfinite(options.regularisation)))
    refuse("regularisation", options.regularisation, "finite and not negative");
  return options.filter_length;
}

}  // namespace

Rls::Rls(const RlsOptions& options)
    : options_(options),
      window_(checked_length(options)),
      factor_(static_cast<Eigen::Index>(options.filter_length),
              static_cast<Eigen::Index>(options.filter_length)),
      target_(factor_.rows()),
      taps_(factor_.rows()),
      row_(factor_.rows()) {
  reset();
}

void Rls::reset() {
  window_.clear();
  guard_.clear();
  factor_.setZero();
  target_.setZero();
  taps_.setZero();
  sum_of_squares_ = n_samples_ = 0.;
  next_pulled_ = 0;
}

void Rls::process(std::span<const double> base_acceleration, std::span<const double> base_moment,
                  std::span<double> wind_moment) {
  assert(base_acceleration.size() == wind_moment.size());
  assert(base_moment.size() == wind_moment.size());
  for (std::size_t i = 0; i < wind_moment.size(); ++i)
    wind_moment[i] = step(base_acceleration[i], base_moment[i]);
}

double Rls::step(double x, double d) {
  window_.push(x);
  guard_.hear(&d, 1);
  // A refused estimate is not an error of the data, which are kept: there are too few of them yet.
  double estimate = taps_.dot(window_.samples());
  if (!guard_.accepts(estimate)) estimate = 0.;
  sum_of_squares_ += x * x;
  n_samples_ += 1.;

  const double kept = std::sqrt(options_.forgetting);
  factor_ *= kept;
  target_ *= kept;
  row_ = window_.samples();
  row_target_ = d;
  rotate_in(0);
  pull_one_tap();
  solve();
  return d - estimate;
}

void Rls::pull_one_tap() {
  const double weight =
      options_.regularisation * static_cast<double>(row_.size()) * sum_of_squares_ / n_samples_;
  if (weight > 0.) {
    row_.setZero();
    row_[next_pulled_] = std::sqrt(weight);
    row_target_ = 0.;
    rotate_in(next_pulled_);
  }
  next_pulled_ = (next_pulled_ + 1) % row_.size();
}

// Rotates row_ and row_target_ into the factor; the places before first are zero.
void Rls::rotate_in(Eigen::Index first) {
  for (Eigen::Index j = first; j < row_.size(); ++j) {
    if (row_[j] == 0.) continue;
    const Eigen::Index n = row_.size() - j;
    auto factor = factor_.col(j).tail(n);
    auto row = row_.tail(n);
    const double length = std::hypot(factor[0], row[0]);
    const double cosine = factor[0] / length, sine = row[0] / length;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double old = factor[i];
      factor[i] = cosine * old + sine * row[i];
      row[i] = cosine * row[i] - sine * old;
    }
    const double old = target_[j];
    target_[j] = cosine * old + sine * row_target_;
    row_target_ = cosine * row_target_ - sine * old;
  }
}

void Rls::solve() {
  // Below this share of the largest diagonal entry, a diagonal entry is only rounding.
  const double smallest = 1e-14 * factor_.diagonal().cwiseAbs().maxCoeff();
  for (Eigen::Index j = row_.size() - 1; j >= 0; --j) {
    const Eigen::Index n = row_.size() - j - 1;
    const double known = factor_.col(j).tail(n).dot(taps_.tail(n));
    const double diagonal = factor_(j, j);
    taps_[j] = std::abs(diagonal) > smallest ? (target_[j] - known) / diagonal : 0.;
  }
}

}  // namespace vibrissa::separation
