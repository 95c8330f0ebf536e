#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "separation/identification/output_error.h"
#include "separation/model/fitted_bvrm.h"
#include "separation/segments/aligned_segment.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

/// Asked after each fit, the lowest order first: whether the next order is wanted.
using WantsNextOrder = std::function<bool(const FittedBvrm&)>;

/// Output-error fits of the orders 2, 4, ... max_order, each with up to four initial models: the
/// fit of the frequency response, the fit with two poles less plus one mode without gain where
/// the residual of the response is largest, and that of the further starts, which ascend alike. The
/// best result is kept, so that the squared error on these segments never increases with the order.
/// Stops when the response does not determine a model, and when the next order is not wanted.
/// Throws UserError as refine_output_error() and identify_frequency() do. Proven by
/// tests/separation/identification/order_selection_test.cc.
std::vector<FittedBvrm> fit_orders(const signals::FrequencyResponse& response,
                                   std::span<const Segment> segments, double sampling_rate_hz,
                                   std::size_t max_order, double delay_s,
                                   const OutputErrorOptions& options,
                                   const WantsNextOrder& wants_next = {},
                                   std::span<const FittedBvrm> further_starts = {});

/// The frequencies [Hz] of the modes that do not decay by a factor e within this time: they are
/// near a line of the input and fit that line through the accelerometer noise. In a separator that
/// starts at rest they would oscillate without end.
std::vector<double> lasting_modes_hz(const Bvrm& model, double duration_s);

/// Whether each segment begins with one hit (hits_of()). A pulse has no lines that a mode could
/// fit, and what rings after it tells a mode that lasts longer than the record.
bool are_hits(std::span<const Segment> segments);

/// The response of the longest segment, from whole periods or by Welch's method. Where the input is
/// a hit (hits_of()), of all segments: sum Y conj(X) / sum |X|^2 over the hits, each one block
/// without averaging over silence, X of the pulse alone.
signals::FrequencyResponse response_of(std::span<const Segment> segments, double rate_hz,
                                       std::size_t period_samples);

/// Samples of a fit record below which no part of it can be held out to choose the order.
inline constexpr std::size_t fewest_samples_for_order = 400;

struct OrderOptions {
  std::size_t max_order = 6;  // number of poles, even
  double delay_s = 0.;
  OutputErrorOptions fit = {};
  /// The holds to try instead of that of the fit; the one with the smallest information criterion
  /// is taken.
  std::vector<Hold> holds = {};
  std::size_t period_samples =
      0;  // period of segments that are periodic and in steady state; 0: not periodic
  double held_out_share = 0.3;      // share of each segment, at its end
  std::size_t whitening_taps = 30;  // taps of the autoregression
  /// Successive orders without gain on held-out data after which no higher one is tried.
  std::size_t fruitless_orders = 2;
};

struct OrderTrial {
  std::size_t order = 0;
  FittedBvrm fit;                    // to the whitened fitting parts
  double fitted_mean_square = 0.;    // whitened error on the fitting parts, N^2 m^2
  double held_out_mean_square = 0.;  // whitened error on the held-out parts in free simulation
  /// Mean difference between the squared held-out errors of this order and of the best order, in
  /// standard deviations (from the scatter between 40 parts).
  double worse_than_best = 0.;
  double information_criterion = 0.;  // n ln fitted_mean_square + unknowns ln n
};

struct OrderSelection {
  Hold hold = Hold::first_order;
  std::vector<OrderTrial> trials;  // ascending order
  /// The lowest order whose held-out error is not worse than the smallest by more than two standard
  /// deviations, or is only rounding.
  std::size_t by_cross_validation = 0;
  std::size_t by_information = 0;  // the smallest criterion
  /// Both select the highest order that was allowed, so more poles may gain.
  bool at_ceiling = false;
  std::string words;  // both orders, whether they agree, and what limited them
};

/// Selects the number of poles that the records determine. Accelerometer noise that passes through
/// the model is large at the resonances; a criterion for white noise would then select too high an
/// order. Therefore both channels are first filtered by the autoregression (Yule-Walker) that
/// whitens the error of the highest order: the model between the channels stays the same, and its
/// error becomes white. Then the orders are fitted and compared. The orders rise as long as data
/// that were not fitted gain (Ljung, System Identification, 2nd ed., section 16.4). Throws
/// UserError for an odd order, a share outside (0, 0.9), or records too short. Proven by
/// tests/separation/identification/order_selection_test.cc, with white noise and with a noisy
/// accelerometer.
OrderSelection select_order(std::span<const Segment> segments, double sampling_rate_hz,
                            const OrderOptions& options = {});

}  // namespace vibrissa::separation
