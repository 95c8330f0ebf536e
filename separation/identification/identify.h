#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "separation/model/fitted_bvrm.h"
#include "separation/model/input_hold.h"
#include "separation/model/simulation.h"
#include "signals/record/record.h"

namespace vibrissa::separation {

/// Criterion for the order: see OrderSelection.
enum class OrderRule { information, cross_validation };

/// Method of the final fit, after output-error fits have selected the order and the hold unless
/// they are given.
enum class IdentifyMethod {
  output_error,  // see refine_output_error()
  srivc,         // refine_srivc(), from the fit of the frequency response
  frequency      // identify_frequency() on the frequency response of the longest fit record
};
std::string to_string(IdentifyMethod method);
/// Throws UserError that lists the known names.
IdentifyMethod parse_identify_method(const std::string& name);

struct IdentifyOptions {
  IdentifyMethod method = IdentifyMethod::output_error;
  /// Number of poles, even. Nothing: selected on the fit records after whitening; on records of
  /// less than 400 samples by the criterion of the trials.
  std::optional<std::size_t> order = std::nullopt;
  std::size_t max_order = 6;
  OrderRule order_rule = OrderRule::information;
  /// Period of records that are periodic and in steady state [samples]; 0: not periodic.
  std::size_t period_samples = 0;
  /// Nothing: first_order or band_limited, the one that fits better.
  std::optional<Hold> hold = std::nullopt;
  bool direct_term = true;
  double delay_s = 0.;     // known, not estimated
  Nuisance nuisance = {};  // estimated in every record together with the model
};

/// One order and hold that was tried.
struct IdentificationTrial {
  std::size_t order = 0;
  Hold hold = Hold::first_order;
  double residual_rms_n_m = 0.;  // on the fit records
  /// n ln(mean e^2) + n_parameters ln n: valid for a white error; selects the hold.
  double information_criterion = 0.;
  FitEnd end = FitEnd::converged;
};

struct Identification {
  FittedBvrm fit;
  Hold hold = Hold::first_order;
  std::size_t order = 0;
  /// Held-out record in free simulation, its initial state and offset estimated (see Nuisance).
  double held_out_fit_percent = 0.;
  double held_out_vaf_percent = 0.;
  double fit_record_fit_percent = 0.;  // of the first fit record, likewise
  std::vector<IdentificationTrial> trials;
  std::string order_words;  // how certain the order is; empty when it was given
};

/// A record divided in time into a part to fit and a part that only scores the model.
struct SplitRecord {
  signals::Record fit, held_out;
};

/// Holds out the last third. The number of samples to fit is rounded down to a multiple of
/// `multiple`, for example to whole periods. Proven by
/// tests/separation/identification/identify_test.cc.
SplitRecord hold_out_last_third(const signals::Record& record, std::size_t multiple = 1);

/// Identifies the base vibration response model from base_acceleration to base_moment. The
/// frequency response of the longest fit record (from whole periods, or by Welch's method) gives
/// the initial model of every order. The output-error fit to all fit records gives the model, with
/// an error that never increases with the order (see fit_orders()); options.method may select
/// another method. The held-out record only scores the model. Throws UserError for a missing
/// channel, a channel that is constant or not finite, different sampling rates, a record that is
/// too short for the order, and an odd order. Proven by
/// tests/separation/identification/identify_test.cc.
Identification identify_bvrm(std::span<const signals::Record> fit_records,
                             const signals::Record& held_out, const IdentifyOptions& options = {});
Identification identify_bvrm(const signals::Record& fit_record, const signals::Record& held_out,
                             const IdentifyOptions& options = {});

}  // namespace vibrissa::separation
