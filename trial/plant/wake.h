#pragma once

#include <cstdint>

namespace vibrissa::trial {

/// Van der Pol's oscillator as the wake: q'' + e w (q^2 - 1) q' + w^2 q = 0, w = 2 pi St u / D.
class Wake {
 public:
  /// A wake with this force coefficient; the seed determines its initial phase.
  Wake(double coefficient, double step_s, std::uint64_t seed);
  /// Its addition relative to u|u| at the end of a step.
  double next(double speed);

 private:
  double coefficient_, step_s_, q_, p_;
};

}  // namespace vibrissa::trial
