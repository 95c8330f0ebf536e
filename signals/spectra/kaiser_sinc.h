#pragma once

#include <cmath>
#include <numbers>

namespace vibrissa::signals {

/// Sinc in a Kaiser window, not normalised: an even low pass with this cut-off [cycles per sample]
/// and half length [samples]; the shape beta sets the attenuation (Oppenheim and Schafer,
/// Discrete-Time Signal Processing, 3rd edition, chapter 7). Proven by
/// tests/signals/spectra/resample_test.cc.
struct KaiserSinc {
  double cut_off = 0.5, half_length = 32., shape = 8.;

  double operator()(const double t) const {
    const double place = t / half_length;
    if (std::abs(place) >= 1.) return 0.;
    const double angle = 2. * std::numbers::pi * cut_off * t;
    const double sinc = angle == 0. ? 1. : std::sin(angle) / angle;
    return sinc * std::cyl_bessel_i(0., shape * std::sqrt(1. - place * place));
  }
};

}  // namespace vibrissa::signals
