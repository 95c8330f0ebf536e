#pragma once

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

/// Largest and smallest moments of each period.
struct Envelope {
  std::vector<double> upper_s{}, upper_n_m{}, lower_s{}, lower_n_m{};
};

/// Of the curve with its offset, by the maxima and minima; times from the start of the piece.
Envelope envelope_of(const FittedCurve& curve);

/// Logarithms of amplitudes in equal steps over a decay, as far as they exceed three times the
/// noise; empty where it has less than two periods.
std::vector<double> amplitudes_of(const FittedCurve& curve, double noise_rms, std::size_t n);

/// Frequency and damping of the periods of the curve, by its maxima, at these amplitudes;
/// deviations from the covariance of the fit, by differences over a tenth of a standard deviation
/// to either side: the maxima of friction have corners, which smaller steps would show as noise.
/// Empty where a decay has no period.
std::vector<DecayPoint> points_of(const FittedCurve& curve,
                                  const std::vector<double>& log_amplitudes);

/// n points of the grown law; their deviations allow for the other laws, each with its probability
/// by Schwarz's criterion (Bayesian model averaging: Hoeting et al. 1999, Statistical Science
/// 14(4), 382-417): mean over all laws of their variance and squared distance from the grown one.
std::vector<DecayPoint> points_of(const GrownLaw& grown, std::size_t piece, double duration_s,
                                  double noise_rms, std::size_t n);

}  // namespace vibrissa::separation
