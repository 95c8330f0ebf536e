#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "separation/filters/block_separator.h"
#include "separation/filters/output_guard.h"
#include "separation/filters/paired_filter.h"
#include "separation/filters/step_rule.h"
#include "signals/spectra/fft.h"

namespace vibrissa::separation {

/// The reference paper uses one L for two lengths; its L = 20 and L = 200 are used as block length
/// here. The filter must be as long as the decay of the sensor (431 samples to 1 % at 31.47 Hz,
/// zeta 0.027, 500 Hz), so its length is a separate option.
struct FdafOptions {
  std::size_t block_length = 20;
  /// Rounded up to whole partitions of block_length.
  std::size_t filter_length = 440;
  StepOptions step = {};
  Constraint constraint = Constraint::constrained;
  /// Share by which the weights decrease in each block, 0 .. 1.
  double leakage = 0.;
};

/// The paper's settings in simulation (1 kHz): partitioned, constrained, L = 20, mu = 0.1.
FdafOptions paper_simulation_fdaf();
/// The paper's settings in the experiment (500 Hz): L = 200, mu = 0.001.
FdafOptions paper_experiment_fdaf();

/// Partitioned-block frequency-domain adaptive filter from base acceleration to base moment, by
/// overlap-save with transforms of 2 block_length. For each block
///   Y = sum_p X_p W_p,  e = M_r - y (last half),  W_p += conj(X_p) mu E   (constrained, see
/// Constraint; mu by bin, see StepOptions); e, the error before the update with this block, is
/// M_s_hat (OutputGuard states its bound). Latency block_length - 1. Proven by
/// tests/separation/filters/fdaf_test.cc against block LMS in the time domain.
class Fdaf : public BlockSeparator {
 public:
  /// Throws UserError for options out of range, with the option's name.
  explicit Fdaf(const FdafOptions& options);

  std::string name() const override { return "FDAF"; }
  std::size_t n_partitions() const { return filter_.n_partitions(); }
  /// block_length times n_partitions(), at least filter_length.
  std::size_t n_taps() const { return filter_.n_taps(); }
  /// The present taps, from base acceleration to base moment.
  std::vector<double> impulse_response() { return filter_.impulse_response(); }

 private:
  void process_block(std::span<const double> base_acceleration, std::span<const double> base_moment,
                     std::span<double> wind_moment) override;
  void reset_blocks() override;

  double kept_;
  signals::RealFft fft_;
  PairedFilter filter_;
  StepRule step_rule_;
  OutputGuard guard_;
  Spectrum error_;
};

}  // namespace vibrissa::separation
