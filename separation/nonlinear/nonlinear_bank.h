#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "separation/model/mode_step.h"
#include "separation/nonlinear/mode_integrator.h"
#include "separation/nonlinear/nonlinear_bvrm.h"

namespace vibrissa::separation {

/// Simulates the nonlinear model as a stream, sample by sample, without allocation, in the manner
/// of the ModalBank: output n is the moment at the time (n - fraction) / rate; the caller applies
/// shift(). At rest at the first sample. A state that diverges starts again at rest (see
/// diverged_in_largest_deflections). Proven by tests/separation/nonlinear/nonlinear_bank_test.cc.
class NonlinearBank {
 public:
  NonlinearBank(const NonlinearBvrm& model, double sampling_rate_hz, Hold hold);

  std::ptrdiff_t shift() const { return delay_.shift; }
  void reset() { started_ = false; }
  /// As ModalBank::process().
  void process(const double* node, const double* midpoint, const double* direct, double* output,
               std::size_t n);

 private:
  struct Mode {
    ModeIntegrator integrator;
    double b1, b0, law_gain = 0.;
    double largest_m = std::numeric_limits<double>::infinity();
  };

  double next(double node, double midpoint, double direct);
  static void restart_when_diverged(Mode& mode);

  std::vector<Mode> modes_;
  SampledDelay delay_;
  InputPath path_;
  bool has_midpoints_;
  double direct_term_;
  InputPath::Knots knots_{};  // of the last step
  double last_midpoint_ = 0.;
  bool started_ = false;
};

/// Moment at the samples for this base acceleration, from rest, as simulate(Bvrm). Throws UserError
/// for a model that check() refuses or an invalid sampling rate. Proven by
/// tests/separation/nonlinear/nonlinear_bank_test.cc.
std::vector<double> simulate(const NonlinearBvrm& model, std::span<const double> base_acceleration,
                             double sampling_rate_hz, Hold hold);

}  // namespace vibrissa::separation
