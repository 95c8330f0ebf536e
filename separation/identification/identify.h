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

/// Share of the moment below which an error is too small to tell about delay, order or hold: no
/// accelerometer is calibrated that well (ISO 16063-21 reaches 0.5 %).
inline constexpr double exact_share = 1e-3;

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
  /// Orders above 6 are only tried while data that are not fitted gain.
  std::size_t max_order = 20;
  OrderRule order_rule = OrderRule::information;
  /// Period of records that are periodic and in steady state [samples]; 0: not periodic.
  std::size_t period_samples = 0;
  /// Nothing: the one that fits best, see choose_structure().
  std::optional<Hold> hold = std::nullopt;
  bool direct_term = true;  // allowed; left out where the records do not determine it
  double delay_s = 0.;      // known, not estimated
  Nuisance nuisance = {};   // estimated in every record together with the model
};

struct Identification {
  FittedBvrm fit;
  Bvrm scored;  // the model that the held-out record scored; it has not seen that record
  Hold hold = Hold::first_order;
  std::size_t order = 0;
  /// Unknowns of the fit; the methods srivc and frequency keep all that are allowed.
  bool direct_term = true, viscous_term = true;
  /// Held-out record in free simulation, its initial state and offset estimated (see Nuisance).
  double held_out_fit_percent = 0.;
  double held_out_vaf_percent = 0.;
  double fit_record_fit_percent = 0.;  // of the first fit record, likewise
  std::string order_words;             // how certain the order is; empty when it was given
  std::string scatter_words;           // see ScatteredFit
  /// By which the moment is later than the acceleration; found because without it the residual
  /// followed the acceleration, and undone (delay_s of the model). See estimate_delay().
  std::optional<Estimate> found_delay_s;
  std::size_t n_hits = 0;  // of the record; 0: its input is no hit
  double duration_s = 0.;  // of the longest record that the model was fitted to
};

/// A record divided in time into a part to fit and a part that only scores the model.
struct SplitRecord {
  signals::Record fit, held_out;
};

/// Holds out the last third. The number of samples to fit is rounded down to a multiple of
/// `multiple`, for example to whole periods. Proven by
/// tests/separation/identification/identify_test.cc.
SplitRecord hold_out_last_third(const signals::Record& record, std::size_t multiple = 1);

/// What scores the model of one record: the last block when the record has several hits (see
/// hit_blocks()), else the last third.
SplitRecord hold_out_part(const signals::Record& record);

/// Identifies the base vibration response model from base_acceleration to base_moment. The
/// frequency response of the longest fit record (from whole periods, or by Welch's method) gives
/// the initial model of every order; select_order() gives the order, choose_structure() the hold
/// and the unknowns, and the output-error fit to all fit records the model; options.method may
/// select another method for it. Deviations: see widen_by_scatter(). The held-out record only
/// scores the model. Throws UserError for a missing channel, a channel that is constant or not
/// finite, different sampling rates, a record that is too short for the order, and an odd order.
/// Proven by tests/separation/identification/identify_test.cc.
Identification identify_bvrm(std::span<const signals::Record> fit_records,
                             const signals::Record& held_out, const IdentifyOptions& options = {});
Identification identify_bvrm(const signals::Record& fit_record, const signals::Record& held_out,
                             const IdentifyOptions& options = {});

/// The same for one record: hold_out_part() scores the model, and each hit is a fit record; then
/// the model of this order, hold and these unknowns is fitted to the whole record. When the
/// residual of the held-out part follows the acceleration, or the fit does not converge, a delay
/// between the channels is estimated; it is kept when the held-out part gains by it. Proven by
/// tests/separation/identification/identify_record_test.cc: the Cramer-Rao bound of all samples.
Identification identify_record(const signals::Record& record, const IdentifyOptions& options = {});

}  // namespace vibrissa::separation
