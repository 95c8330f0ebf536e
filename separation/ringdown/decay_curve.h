#pragma once

#include <optional>
#include <vector>

#include "separation/model/fitted_bvrm.h"
#include "separation/ringdown/decay_growth.h"

namespace vibrissa::separation {

/// Resonance and damping at one amplitude of the base moment.
struct DecayPoint {
  double amplitude_n_m = 0.;
  Estimate frequency_hz, damping_ratio;
};

/// A decay by a fitted law, from the start of one of its pieces.
struct FittedCurve {
  const FittedDecay& fit;
  std::size_t piece = 0;
  double duration_s = 0.;
};

/// Logarithms of amplitudes in equal steps over a decay, as far as they exceed three times the
/// noise; empty where it has less than two periods.
std::vector<double> amplitudes_of(const FittedCurve& curve, double noise_rms, std::size_t n);

/// Frequency and damping of the periods of the curve, by its maxima, at these amplitudes;
/// deviations from the covariance of the fit.
std::vector<DecayPoint> points_of(const FittedCurve& curve,
                                  const std::vector<double>& log_amplitudes);

/// The better one of a fit and the same law with the other form of friction; of the other one the
/// probability by Schwarz's criterion.
struct FrictionForms {
  FittedDecay fit;
  std::optional<FittedDecay> other{};
  double probability_of_other = 0.;
};
FrictionForms compare_frictions(FittedDecay fit, const DecayMoments& pieces, double rate_hz);

/// n points of the better form; their deviations allow for the other one.
std::vector<DecayPoint> points_of(const FrictionForms& forms, std::size_t piece, double duration_s,
                                  double noise_rms, std::size_t n);

}  // namespace vibrissa::separation
