#pragma once

#include <string>

#include "separation/filters/bank_separator.h"
#include "separation/model/modal_bank.h"
#include "separation/model/rational_model.h"

namespace vibrissa::separation {

/// M_s_hat = M_r - G a with an identified model (Routray et al. 2024, eq. 12), from rest; latency
/// as the BankSeparator says. Proven by tests/separation/filters/bvrm_separator_test.cc.
class BvrmSeparator : public BankSeparator<ModalBank> {
 public:
  /// Throws UserError for a model that check() refuses or a rate that is not positive.
  BvrmSeparator(const Bvrm& model, double sampling_rate_hz, Hold hold = Hold::first_order)
      : BankSeparator(ModalBank(model, checked_rate(sampling_rate_hz), hold), hold,
                      sampled_delay(model.delay_s, sampling_rate_hz).fraction) {}

  std::string name() const override { return "BVRM"; }
};

}  // namespace vibrissa::separation
