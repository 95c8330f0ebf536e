#include "diagnosis/steady_state/fourier_basis.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

TEST(FourierBasisOfAPeriod, OfSamplesAreTheCoordinates) {
  for (const bool only_odd : {false, true}) {
    const FourierBasis basis(5, only_odd);
    LaneRows x = LaneRows::Random(basis.n_coordinates(), signals::n_lanes);
    if (!only_odd) x.row(1).setZero();
    EXPECT_LT((basis.coordinates(basis.samples(x)) - x).abs().maxCoeff(), 1e-12);
  }
}

TEST(FourierBasisOfAPeriod, AreThoseOfASineAndItsRate) {
  const FourierBasis basis(3, true);
  LaneRows x = LaneRows::Zero(basis.n_coordinates(), signals::n_lanes);
  x.row(2).setConstant(0.3);
  x.row(3).setConstant(-0.4);
  const LaneRows values = basis.samples(x), rates = basis.rates(x);
  const double step = 2. * std::numbers::pi / static_cast<double>(basis.n_samples_of_period());
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const double angle = 3. * step * static_cast<double>(i);
    EXPECT_NEAR(values(i, 2), 0.3 * std::cos(angle) + 0.4 * std::sin(angle), 1e-12);
    EXPECT_NEAR(rates(i, 2), 3. * (0.4 * std::cos(angle) - 0.3 * std::sin(angle)), 1e-12);
  }
}

TEST(FourierBasisOfAPeriod, InOtherHarmonicsKeepTheirOrders) {
  const FourierBasis odd(3, true), all(4, false);
  const Eigen::VectorXd x = Eigen::Vector4d(1., 2., 3., 4.);
  const Eigen::VectorXd there = all.converted(x, odd);
  EXPECT_EQ(there.segment<2>(2), x.head<2>());
  EXPECT_EQ(there.segment<2>(6), x.tail<2>());
  EXPECT_EQ(odd.converted(there, all), x);
}

}  // namespace
}  // namespace vibrissa::diagnosis
