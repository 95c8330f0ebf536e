#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "separation/identification/output_error.h"
#include "separation/model/fitted_bvrm.h"
#include "separation/segments/aligned_segment.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

/// Output-error fits of the orders 2, 4, ... max_order, each with two initial models: the fit of
/// the frequency response, and the fit with two poles less plus one mode without gain at the
/// largest residual of the response. The better result is kept, so that the squared error on these
/// segments never increases with the order. Stops when the response does not determine a model.
/// Throws UserError as refine_output_error() and identify_frequency() do. Proven by
/// tests/separation/identification/order_selection_test.cc.
std::vector<FittedBvrm> fit_orders(const signals::FrequencyResponse& response,
                                   std::span<const Segment> segments, double sampling_rate_hz,
                                   std::size_t max_order, double delay_s,
                                   const OutputErrorOptions& options);

struct OrderOptions {
  std::size_t max_order = 6;  // number of poles, even
  double delay_s = 0.;
  OutputErrorOptions fit = {};
  std::size_t period_samples =
      0;  // period of segments that are periodic and in steady state; 0: not periodic
  double held_out_share = 0.3;      // share of each segment, at its end
  std::size_t whitening_taps = 30;  // taps of the autoregression
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
  std::vector<OrderTrial> trials;  // ascending order
  /// The lowest order whose held-out error is not worse than the smallest by more than two standard
  /// deviations, or is only rounding.
  std::size_t by_cross_validation = 0;
  std::size_t by_information = 0;  // the smallest criterion
  std::string words;               // both orders, and whether they agree
};

/// Selects the number of poles that the records determine. Accelerometer noise that passes through
/// the model is large at the resonances; a criterion for white noise would then select too high an
/// order. Therefore both channels are first filtered by the autoregression (Yule-Walker) that
/// whitens the error of the highest order: the model between the channels stays the same, and its
/// error becomes white. Then the orders are fitted and compared. Throws UserError for an odd order,
/// a share outside (0, 0.9), or records too short. Proven by
/// tests/separation/identification/order_selection_test.cc, with white noise and with a noisy
/// accelerometer.
OrderSelection select_order(std::span<const Segment> segments, double sampling_rate_hz,
                            const OrderOptions& options = {});

}  // namespace vibrissa::separation
