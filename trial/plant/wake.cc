#include "trial/plant/wake.h"

#include <cmath>
#include <numbers>
#include <random>

namespace vibrissa::trial {

Wake::Wake(const double coefficient, const double step_s, const std::uint64_t seed)
    : coefficient_(coefficient), step_s_(step_s) {
  std::mt19937_64 random(seed);
  const double phase = 6.28 * std::uniform_real_distribution<double>()(random);
  q_ = 2. * std::cos(phase);
  p_ = std::sin(phase);
}

double Wake::next(const double speed) {
  if (coefficient_ == 0.) return 0.;
  constexpr double strouhal = 0.17, width = 8.5e-3, stiffness = 0.3;
  const double w = 2. * std::numbers::pi * strouhal * std::abs(speed) / width;
  const double h = w * step_s_;
  p_ += h * (-q_ - stiffness * (q_ * q_ - 1.) * p_);
  q_ += h * p_;
  return 0.5 * coefficient_ * q_;
}

}  // namespace vibrissa::trial
