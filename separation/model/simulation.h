#pragma once

#include <span>
#include <vector>

#include "separation/model/input_hold.h"
#include "separation/model/modal_bank.h"
#include "separation/model/rational_model.h"

namespace vibrissa::separation {

/// Moment at the samples for this base acceleration: exact for an input that runs between its
/// samples as the hold says. One state per mode at the first sample; none: at rest. Where a delay
/// reaches beyond the record, the input is taken as constant there. Throws UserError for a model
/// that check() refuses, a bad rate or a wrong number of states. Proven by
/// tests/separation/model/simulation_test.cc.
std::vector<double> simulate(const Bvrm& model, std::span<const double> base_acceleration,
                             double sampling_rate_hz, Hold hold = Hold::first_order,
                             std::span<const ModalState> initial_states = {});

/// What a record brings along that the model does not determine.
struct Nuisance {
  bool initial_state = true;  // free response of each mode
  bool offset = true;         // constant (an offset of either sensor)
};

/// Free simulation of a record with its initial state and offset estimated by linear least squares
/// from the moment itself (nothing else is). Samples that the model's delay takes from outside of
/// the record are simulated too, but not used for the estimate. Throws UserError when the record
/// has fewer samples than twice the unknowns.
std::vector<double> simulate_like(const Bvrm& model, std::span<const double> base_acceleration,
                                  std::span<const double> base_moment, double sampling_rate_hz,
                                  Hold hold, const Nuisance& nuisance = {});

}  // namespace vibrissa::separation
