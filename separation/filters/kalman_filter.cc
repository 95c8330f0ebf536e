#include "separation/filters/kalman_filter.h"

#include <algorithm>
#include <cmath>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

const KalmanOptions& checked(const KalmanOptions& options) {
  const auto require = [](bool good, const std::string& name, double value,
                          const std::string& rule) {
    if (!good)
      throw signals::UserError("Kalman filter: " + name + " = " + signals::to_text(value) +
                               " must be " + rule);
  };
  require(options.block_length > 0, "block_length", 0., "at least 1");
  require(options.filter_length > 0, "filter_length", 0., "at least 1");
  require(options.transition > 0. && options.transition <= 1., "transition", options.transition,
          "above 0 and at most 1");
  require(options.noise_forgetting >= 0. && options.noise_forgetting < 1., "noise_forgetting",
          options.noise_forgetting, "at least 0 and below 1");
  return options;
}

std::size_t count_partitions(const KalmanOptions& options) {
  return (options.filter_length + options.block_length - 1) / options.block_length;
}

bool silent(std::span<const double> x) {
  return std::ranges::all_of(x, [](double value) { return value == 0.; });
}

}  // namespace

PartitionedKalman::PartitionedKalman(const KalmanOptions& options)
    : BlockSeparator(checked(options).block_length),
      options_(options),
      fft_(2 * options.block_length),
      input_(options.block_length, count_partitions(options)),
      filter_(options.block_length, input_.n_partitions()),
      error_(input_.n_bins()),
      covariance_(input_.n_bins(), static_cast<Eigen::Index>(input_.n_partitions())),
      gain_(covariance_.rows(), covariance_.cols()),
      wind_power_(input_.n_bins()),
      expected_power_(input_.n_bins()) {
  reset_blocks();
}

void PartitionedKalman::process_block(std::span<const double> base_acceleration,
                                      std::span<const double> base_moment,
                                      std::span<double> wind_moment) {
  const auto n = static_cast<Eigen::Index>(block_length());
  input_.push(base_acceleration, fft_);
  Eigen::Map<Spectrum> spectrum(fft_.spectrum().data(), n + 1);
  Eigen::Map<Eigen::ArrayXd> time(fft_.time().data(), 2 * n);

  filter_.apply(input_, error_);
  spectrum = error_;
  fft_.inverse();
  guard_.hear(base_moment.data(), base_moment.size());
  if (!guard_.accepts(time.data() + n, base_moment.size())) {
    forget();
    time.tail(n).setZero();
  }
  time.tail(n) = Eigen::Map<const Eigen::ArrayXd>(base_moment.data(), n) - time.tail(n);
  time.head(n).setZero();
  const bool teaches = !silent(base_moment) && !silent(base_acceleration);
  std::ranges::copy(fft_.time().last(wind_moment.size()), wind_moment.begin());
  if (!teaches) return;
  fft_.forward();
  error_ = spectrum;
  learn();
}

void PartitionedKalman::renew_prior(const Eigen::ArrayXd& error_power) {
  sum_of_errors_ += error_power.mean();
  sum_of_heard_ += 0.5 * input_.power().mean();
  const double ratio = sum_of_errors_ / sum_of_heard_;
  constexpr double far_beyond = 10.;
  if (!std::isfinite(ratio) || ratio <= far_beyond * prior_) return;
  prior_ = ratio;
  covariance_.setConstant(prior_);
}

void PartitionedKalman::learn() {
  const Eigen::ArrayXd error_power = error_.abs2();
  renew_prior(error_power);
  const double forgetting = has_wind_power_ ? options_.noise_forgetting : 0.;
  wind_power_ = forgetting * wind_power_ + (1. - forgetting) * error_power;
  has_wind_power_ = true;
  const double squared = options_.transition * options_.transition;
  if (squared < 1.) covariance_ = squared * covariance_ + (1. - squared) * filter_.power();

  expected_power_ = wind_power_;
  for (std::size_t p = 0; p < input_.n_partitions(); ++p)
    expected_power_ += 0.5 * input_.power(p) * covariance_.col(static_cast<Eigen::Index>(p));
  // A bin without signal and without expected power gives no update.
  const Eigen::ArrayXd share = (expected_power_ > 1e-290).select(expected_power_.inverse(), 0.);
  for (std::size_t p = 0; p < input_.n_partitions(); ++p) {
    const auto j = static_cast<Eigen::Index>(p);
    gain_.col(j) = covariance_.col(j) * share;
    covariance_.col(j) *= 1. - 0.5 * input_.power(p) * gain_.col(j);
  }
  filter_.adapt(input_, error_, gain_, fft_);
}

void PartitionedKalman::reset_blocks() {
  input_.clear();
  guard_.clear();
  forget();
}

void PartitionedKalman::forget() {
  filter_.clear();
  covariance_.setZero();
  wind_power_.setZero();
  prior_ = sum_of_errors_ = sum_of_heard_ = 0.;
  has_wind_power_ = false;
}

}  // namespace vibrissa::separation
