#include "diagnosis/model/complex_lanes.h"

#include <gtest/gtest.h>

#include <random>

namespace vibrissa::diagnosis {
namespace {

using Complex = std::complex<double>;

struct Operands {
  ComplexLanes a, b;
};

Operands drawn() {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  Operands out;
  for (Eigen::Index lane = 0; lane < signals::n_lanes; ++lane) {
    out.a.set(lane, {normal(generator), normal(generator)});
    out.b.set(lane, {normal(generator), normal(generator)});
  }
  return out;
}

TEST(ComplexLanes, EachIsTheComplexNumberOfItsLane) {
  const auto [a, b] = drawn();
  constexpr double r = -1.7;
  const auto expect = [](const ComplexLanes& got, const auto& of_lane) {
    for (Eigen::Index lane = 0; lane < signals::n_lanes; ++lane)
      EXPECT_LT(std::abs(got[lane] - of_lane(lane)), 1e-13 * std::abs(of_lane(lane)));
  };
  expect(a + b, [&](Eigen::Index i) { return a[i] + b[i]; });
  expect(a - b, [&](Eigen::Index i) { return a[i] - b[i]; });
  expect(a * b, [&](Eigen::Index i) { return a[i] * b[i]; });
  expect(a / b, [&](Eigen::Index i) { return a[i] / b[i]; });
  expect(r + a, [&](Eigen::Index i) { return r + a[i]; });
  expect(r * a, [&](Eigen::Index i) { return r * a[i]; });
  expect(a / r, [&](Eigen::Index i) { return a[i] / r; });
  expect(r / a, [&](Eigen::Index i) { return r / a[i]; });
  expect(ComplexLanes(r), [&](Eigen::Index) { return Complex(r); });
}

}  // namespace
}  // namespace vibrissa::diagnosis
