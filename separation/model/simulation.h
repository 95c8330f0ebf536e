#pragma once

#include <span>
#include <vector>

#include "separation/model/input_hold.h"
#include "separation/model/modal_bank.h"
#include "separation/model/rational_model.h"

namespace vibrissa::separation {

/// Moment at the samples for this base acceleration: exact for an input with the given hold.
/// initial_states: one state for each mode at the first sample; empty: at rest. Where a delay needs
/// samples outside the record, the input is assumed constant there. Throws UserError for a model
/// that check() refuses, an invalid sampling rate or a wrong number of states. Proven by
/// tests/separation/model/simulation_test.cc.
std::vector<double> simulate(const Bvrm& model, std::span<const double> base_acceleration,
                             double sampling_rate_hz, Hold hold = Hold::first_order,
                             std::span<const ModalState> initial_states = {});

/// Parameters of a record that are not part of the model.
struct Nuisance {
  bool initial_state = true;  // free response of each mode
  bool offset = true;         // constant offset of the moment (from either sensor)
};

/// Simulation of a record; only its initial state and offset are estimated from the moment, by
/// linear least squares. Samples whose delayed input is outside the record are simulated, but not
/// used for the estimate. Throws UserError when the record has fewer samples than twice the
/// unknowns.
std::vector<double> simulate_like(const Bvrm& model, std::span<const double> base_acceleration,
                                  std::span<const double> base_moment, double sampling_rate_hz,
                                  Hold hold, const Nuisance& nuisance = {});

}  // namespace vibrissa::separation
