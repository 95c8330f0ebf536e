#pragma once

#include <cstddef>
#include <random>
#include <vector>

namespace vibrissa::signals::test {

inline std::vector<double> white_noise(std::size_t n, double deviation, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0., deviation);
  std::vector<double> x(n);
  for (double& value : x) value = normal(random);
  return x;
}

}  // namespace vibrissa::signals::test
