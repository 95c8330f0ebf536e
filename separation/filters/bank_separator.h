#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "separation/filters/separator.h"
#include "separation/model/input_shaper.h"
#include "separation/model/mode_step.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

/// Ring buffer that delays a signal by a fixed number of samples. The first outputs are the start
/// value.
class DelayLine {
 public:
  explicit DelayLine(std::size_t delay) : ring_(delay + 1, 0.) {}
  void start(double value) { ring_.assign(ring_.size(), value); }
  double pass(double x) {
    ring_[next_] = x;
    next_ = next_ + 1 == ring_.size() ? 0 : next_ + 1;
    return ring_[next_];
  }

 private:
  std::vector<double> ring_;
  std::size_t next_ = 0;
};

/// M_s_hat = M_r - M_b_hat with the moment M_b_hat that a bank (ModalBank, NonlinearBank) simulates
/// as a stream from the base acceleration. The holds first_order and zero_order need no latency;
/// band_limited needs the future samples of the InputShaper, and a negative delay needs the samples
/// by which the moment leads. Before the first sample the acceleration is assumed constant. Proven
/// by tests/separation/filters/bvrm_separator_test.cc.
template <typename Bank>
class BankSeparator : public Separator {
 public:
  void process(std::span<const double> base_acceleration, std::span<const double> base_moment,
               std::span<double> wind_moment) override {
    assert(base_acceleration.size() == wind_moment.size());
    assert(base_moment.size() == wind_moment.size());
    if (wind_moment.size() == 1 && vibrates_ && passes_straight_through()) {
      process_sample(base_acceleration[0], base_moment[0], wind_moment[0]);
      return;
    }
    for (std::size_t first = 0; first < wind_moment.size(); first += block)
      process_block(base_acceleration.data() + first, base_moment.data() + first,
                    wind_moment.data() + first, std::min(block, wind_moment.size() - first));
  }

  void reset() override {
    bank_.reset();
    moment_line_.start(0.);
    n_skipped_ = n_early_ = 0;
    started_ = vibrates_ = false;
  }

  std::size_t latency_samples() const override { return latency_; }

 protected:
  BankSeparator(Bank bank, Hold hold, double delay_fraction)
      : bank_(std::move(bank)),
        shaper_(hold, delay_fraction),
        latency_(shaper_.reach() + positive_part(-bank_.shift())),
        moment_line_(latency_),
        vibration_line_(positive_part(bank_.shift())),
        window_(2 * shaper_.reach() + block) {
    reset();
  }

  /// Throws UserError unless the rate is positive and finite.
  static double checked_rate(double sampling_rate_hz) {
    if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
      throw signals::UserError("BVRM separator: the sampling rate " +
                               signals::to_text(sampling_rate_hz) +
                               " Hz is not positive and finite");
    return sampling_rate_hz;
  }

 private:
  static constexpr std::size_t block = 256;
  using Block = std::array<double, block>;

  static std::size_t positive_part(std::ptrdiff_t n) {
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, n));
  }

  bool passes_straight_through() const {
    return shaper_.reach() == 0 && !shaper_.has_midpoints() && latency_ == 0 && bank_.shift() <= 0;
  }

  // The result of process_block without input shaping and without latency.
  void process_sample(double acceleration, double moment, double& wind) {
    double vibration = 0.;
    bank_.process(&acceleration, nullptr, &acceleration, &vibration, 1);
    wind = moment - vibration;
  }

  void process_block(const double* acceleration, const double* moment, double* wind,
                     std::size_t n) {
    const std::size_t reach = shaper_.reach();
    if (!started_) std::fill_n(window_.begin(), 2 * reach, acceleration[0]);
    started_ = true;
    std::copy_n(acceleration, n, window_.begin() + static_cast<std::ptrdiff_t>(2 * reach));

    const std::size_t skip = std::min(n, reach - n_skipped_), m = n - skip;
    n_skipped_ += skip;
    if (m > 0) {
      double* midpoint = shaper_.has_midpoints() ? midpoint_.data() : nullptr;
      shaper_.shape(window_.data() + reach + skip, m, node_.data(), midpoint, direct_.data());
      bank_.process(node_.data(), midpoint, direct_.data(), vibration_.data(), m);
      if (!vibrates_) vibration_line_.start(vibration_[0]);
      vibrates_ = true;
    }
    std::copy_n(window_.begin() + static_cast<std::ptrdiff_t>(n), 2 * reach, window_.begin());

    for (std::size_t i = 0; i < n; ++i) {
      const double measured = moment_line_.pass(moment[i]);
      const double vibration = i < skip ? 0. : vibration_line_.pass(vibration_[i - skip]);
      wind[i] = measured - vibration;
    }
    for (std::size_t i = 0; i < n && n_early_ < latency_; ++i, ++n_early_) wind[i] = 0.;
  }

  Bank bank_;
  InputShaper shaper_;
  std::size_t latency_;
  DelayLine moment_line_, vibration_line_;
  std::vector<double> window_;  // acceleration: past samples (two reaches), then the block
  std::size_t n_skipped_ = 0;   // shaped samples before the first sample
  std::size_t n_early_ = 0;     // results before the latency has passed
  bool started_ = false, vibrates_ = false;
  Block node_{}, midpoint_{}, direct_{}, vibration_{};
};

}  // namespace vibrissa::separation
