#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "separation/filters/separator.h"
#include "separation/model/input_shaper.h"
#include "separation/model/modal_bank.h"
#include "separation/model/rational_model.h"

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

/// M_s_hat = M_r - G a with an identified model (Routray et al. 2024, eq. 12), from rest. The holds
/// first_order and zero_order need no latency; band_limited needs the future samples of the
/// InputShaper, and a negative delay needs the samples by which the moment leads. Before the first
/// sample the acceleration is assumed constant. Proven by
/// tests/separation/filters/bvrm_separator_test.cc.
class BvrmSeparator : public Separator {
 public:
  /// Throws UserError for a model that check() refuses or a rate that is not positive.
  BvrmSeparator(const Bvrm& model, double sampling_rate_hz, Hold hold = Hold::first_order);

  void process(std::span<const double> base_acceleration, std::span<const double> base_moment,
               std::span<double> wind_moment) override;
  void reset() override;
  std::string name() const override { return "BVRM"; }
  std::size_t latency_samples() const override { return latency_; }

 private:
  static constexpr std::size_t block = 256;
  using Block = std::array<double, block>;

  bool passes_straight_through() const;
  void process_sample(double acceleration, double moment, double& wind);
  void process_block(const double* acceleration, const double* moment, double* wind, std::size_t n);

  ModalBank bank_;
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
