#include "separation/filters/fdaf.h"

#include <algorithm>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

std::size_t count_partitions(const FdafOptions& options) {
  if (options.filter_length == 0)
    throw signals::UserError("adaptive filter: filter_length must be at least 1");
  return (options.filter_length + options.block_length - 1) / options.block_length;
}

double kept_share(double leakage) {
  if (!(leakage >= 0. && leakage <= 1.))
    throw signals::UserError("adaptive filter: leakage = " + signals::to_text(leakage) +
                             " must be between 0 and 1");
  return 1. - leakage;
}

}  // namespace

FdafOptions paper_simulation_fdaf() {
  FdafOptions options;
  options.block_length = 20;
  options.filter_length = 440;
  options.step.step = 0.1;
  return options;
}

FdafOptions paper_experiment_fdaf() {
  FdafOptions options;
  options.block_length = 200;
  options.filter_length = 600;
  options.step.step = 0.001;
  return options;
}

Fdaf::Fdaf(const FdafOptions& options)
    : BlockSeparator(options.block_length),
      kept_(kept_share(options.leakage)),
      fft_(2 * options.block_length),
      filter_(options.block_length, count_partitions(options), options.constraint),
      step_rule_(options.step, filter_.n_bins()),
      error_(filter_.n_bins()) {}

void Fdaf::process_block(std::span<const double> base_acceleration,
                         std::span<const double> base_moment, std::span<double> wind_moment) {
  const auto n = static_cast<Eigen::Index>(block_length());
  filter_.push(base_acceleration);
  filter_.apply(wind_moment);
  Eigen::Map<Eigen::ArrayXd> wind(wind_moment.data(), n);
  guard_.hear(base_moment.data(), base_moment.size());
  if (!guard_.accepts(wind_moment.data(), wind_moment.size())) {
    filter_.clear_taps();
    wind.setZero();
  }
  wind = Eigen::Map<const Eigen::ArrayXd>(base_moment.data(), n) - wind;

  Eigen::Map<Eigen::ArrayXd> time(fft_.time().data(), 2 * n);
  time.head(n).setZero();
  time.tail(n) = wind;
  fft_.forward();
  error_ = Eigen::Map<const Spectrum>(fft_.spectrum().data(), n + 1) *
           step_rule_.update(filter_.power());
  if (kept_ < 1.) filter_.scale(kept_);
  filter_.adapt(error_);
}

void Fdaf::reset_blocks() {
  filter_.clear();
  step_rule_.clear();
  guard_.clear();
}

}  // namespace vibrissa::separation
