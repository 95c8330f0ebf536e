#pragma once

#include <cstdint>

namespace vibrissa::trial {

/// Van der Pol's oscillator as the wake: q'' + e w (q^2 - 1) q' + w^2 q = 0, w = 2 pi St u / D.
class Wake {
 public:
  /// Of a force coefficient; the phase that it begins with follows from the seed.
  Wake(double coefficient, double step_s, std::uint64_t seed);
  /// The share of u|u| that it adds at the end of a step.
  double next(double speed);

 private:
  double coefficient_, step_s_, q_, p_;
};

}  // namespace vibrissa::trial
