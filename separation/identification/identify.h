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

/// What chooses the order: see OrderSelection.
enum class OrderRule { information, cross_validation };

/// Who gives the model, once output-error fits have chosen what is not given of order and hold.
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
  /// Number of poles, even. Nothing: chosen on the fit records, after whitening; on records of less
  /// than 400 samples by the criterion of the trials.
  std::optional<std::size_t> order = std::nullopt;
  std::size_t max_order = 6;
  OrderRule order_rule = OrderRule::information;
  /// Of periodic records in steady state; 0: not periodic.
  std::size_t period_samples = 0;
  /// Nothing: first_order or band_limited, whichever fits the fit records better.
  std::optional<Hold> hold = std::nullopt;
  bool direct_term = true;
  double delay_s = 0.;     // known, not estimated
  Nuisance nuisance = {};  // estimated in every record beside the model
};

/// One order and hold that was tried.
struct IdentificationTrial {
  std::size_t order = 0;
  Hold hold = Hold::first_order;
  double residual_rms_n_m = 0.;  // on the fit records
  /// n ln(mean e^2) + n_parameters ln n: right for a white error; chooses the hold.
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
  std::string order_words;  // how sure the order is; empty when it was given
};

/// A record cut in time into what a model is fitted to and what only scores it.
struct SplitRecord {
  signals::Record fit, held_out;
};

/// The last third held out. multiple: the number of samples to fit is rounded down to one of it, to
/// whole periods for instance. Proven by tests/separation/identification/identify_test.cc.
SplitRecord hold_out_last_third(const signals::Record& record, std::size_t multiple = 1);

/// Identifies the base-vibration response model from base_acceleration to base_moment. The
/// frequency response of the longest fit record (from whole periods, or Welch's) gives the start of
/// every order, the output-error fit to all fit records the model, its error never rising with the
/// order (see fit_orders()), or another method when asked; the held-out record only scores it.
/// Throws UserError: no such channel, a constant or not finite one, unequal rates, a record too
/// short for the order, an odd order. Proven by tests/separation/identification/identify_test.cc.
Identification identify_bvrm(std::span<const signals::Record> fit_records,
                             const signals::Record& held_out, const IdentifyOptions& options = {});
Identification identify_bvrm(const signals::Record& fit_record, const signals::Record& held_out,
                             const IdentifyOptions& options = {});

}  // namespace vibrissa::separation
