#pragma once

#include <string>

#include "separation/filters/bank_separator.h"
#include "separation/nonlinear/nonlinear_bank.h"

namespace vibrissa::separation {

/// M_s_hat = M_r - M_b_hat with a nonlinear model, as a stream, from rest; latency as the
/// BankSeparator says. Proven by tests/separation/nonlinear/nonlinear_bank_test.cc.
class NonlinearSeparator : public BankSeparator<NonlinearBank> {
 public:
  /// Throws UserError for a model that check() refuses or a rate that is not positive.
  NonlinearSeparator(const NonlinearBvrm& model, double sampling_rate_hz, Hold hold)
      : BankSeparator(NonlinearBank(model, checked_rate(sampling_rate_hz), hold), hold,
                      sampled_delay(model.linear.delay_s, sampling_rate_hz).fraction) {}

  std::string name() const override { return "nonlinear BVRM"; }
};

}  // namespace vibrissa::separation
