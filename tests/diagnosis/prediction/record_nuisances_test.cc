#include "diagnosis/prediction/record_nuisances.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

namespace vibrissa::diagnosis {
namespace {

struct Drawn {
  std::vector<RecordNuisance> unknowns;
  std::vector<Complex> error;
  std::vector<double> variance;
};

Drawn drawn(std::size_t n_unknowns) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  constexpr std::size_t n = 12;
  Drawn out;
  for (std::size_t b = 0; b < n; ++b) {
    out.error.emplace_back(normal(random), normal(random));
    out.variance.push_back(0.5 + std::abs(normal(random)));
  }
  for (std::size_t i = 0; i < n_unknowns; ++i) {
    RecordNuisance unknown{0.3 + static_cast<double>(i), {}};
    for (std::size_t b = 0; b < n; ++b) unknown.shape.emplace_back(normal(random), normal(random));
    out.unknowns.push_back(std::move(unknown));
  }
  return out;
}

/// Of real and imaginary parts, each of half a bin's variance.
Eigen::MatrixXd dense_covariance(const Drawn& d, bool with_unknowns) {
  const auto n = static_cast<Eigen::Index>(2 * d.variance.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    out(i, i) = 0.5 * d.variance[static_cast<std::size_t>(i / 2)];
  for (const RecordNuisance& unknown : d.unknowns) {
    if (!with_unknowns) break;
    Eigen::VectorXd shape(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Complex g = unknown.shape[static_cast<std::size_t>(i / 2)];
      shape(i) = i % 2 == 0 ? g.real() : g.imag();
    }
    out += unknown.variance * shape * shape.transpose();
  }
  return out;
}

double log_normal(const Drawn& d, bool with_unknowns) {
  const Eigen::MatrixXd covariance = dense_covariance(d, with_unknowns);
  Eigen::VectorXd e(covariance.rows());
  for (Eigen::Index i = 0; i < e.size(); ++i) {
    const Complex error = d.error[static_cast<std::size_t>(i / 2)];
    e(i) = i % 2 == 0 ? error.real() : error.imag();
  }
  return -0.5 * (e.dot(covariance.ldlt().solve(e)) + std::log(covariance.determinant()));
}

TEST(IntegratedNuisances, GainWhatTheWholeCovarianceDoes) {
  for (const std::size_t n_unknowns : {1u, 2u}) {
    const Drawn d = drawn(n_unknowns);
    const IntegratedNuisances unknowns(d.unknowns, d.error, d.variance);
    EXPECT_NEAR(unknowns.log_likelihood_gain(), log_normal(d, true) - log_normal(d, false), 1e-10)
        << n_unknowns;
  }
}

TEST(IntegratedNuisances, AreFoundWhereTheyAreLoud) {
  Drawn d = drawn(2);
  for (RecordNuisance& unknown : d.unknowns) unknown.variance = 1e8;
  for (std::size_t b = 0; b < d.error.size(); ++b)
    d.error[b] = 70. * d.unknowns[0].shape[b] - 30. * d.unknowns[1].shape[b];
  const IntegratedNuisances unknowns(d.unknowns, d.error, d.variance);
  EXPECT_NEAR(unknowns.mean()(0), 70., 1e-5);
  EXPECT_NEAR(unknowns.mean()(1), -30., 1e-5);
  unknowns.remove_from(d.error);
  for (const Complex& left : d.error) EXPECT_LT(std::abs(left), 1e-4);
}

TEST(IntegratedNuisances, OfNoVarianceAreNothing) {
  Drawn d = drawn(1);
  d.unknowns.front().variance = 0.;
  const std::vector<Complex> before = d.error;
  const IntegratedNuisances unknowns(d.unknowns, d.error, d.variance);
  EXPECT_EQ(unknowns.log_likelihood_gain(), 0.);
  unknowns.remove_from(d.error);
  EXPECT_EQ(d.error, before);
}

/// Central difference of the log likelihood by the logarithm of one variance.
double slope_of_gain(const Drawn& d, const std::size_t i) {
  constexpr double h = 1e-4;
  const auto gain = [&](const double log_factor) {
    Drawn there = d;
    there.unknowns[i].variance *= std::exp(log_factor);
    return IntegratedNuisances(there.unknowns, there.error, there.variance).log_likelihood_gain();
  };
  return (gain(h) - gain(-h)) / (2. * h);
}

TEST(IntegratedNuisances, TellTheSlopeByTheirVariances) {
  const Drawn d = drawn(2);
  const Eigen::VectorXd slope =
      IntegratedNuisances(d.unknowns, d.error, d.variance).slope_of_variance();
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(slope(static_cast<Eigen::Index>(i)), slope_of_gain(d, i), 1e-6) << i;
}

TEST(IntegratedNuisances, DetermineAVarianceThatIsLoudAndNotOneThatIsSilent) {
  Drawn d = drawn(2);
  d.unknowns[0].variance = 1e6;
  d.unknowns[1].variance = 0.;
  const IntegratedNuisances unknowns(d.unknowns, d.error, d.variance);
  EXPECT_NEAR(unknowns.determined_share()(0), 1., 1e-5);
  EXPECT_EQ(unknowns.determined_share()(1), 0.);
  EXPECT_EQ(unknowns.slope_of_variance()(1), 0.);
}

TEST(IntegratedNuisances, FollowOtherShapes) {
  const Drawn d = drawn(2), other = drawn(3);
  const IntegratedNuisances unknowns(d.unknowns, d.error, d.variance);
  const std::vector<RecordNuisance> moved{other.unknowns[1], other.unknowns[2]};
  const std::vector<Complex> change = unknowns.change_to(moved);
  for (std::size_t b = 0; b < change.size(); ++b) {
    const Complex expected = unknowns.mean()(0) * (moved[0].shape[b] - d.unknowns[0].shape[b]) +
                             unknowns.mean()(1) * (moved[1].shape[b] - d.unknowns[1].shape[b]);
    EXPECT_LT(std::abs(change[b] - expected), 1e-12) << b;
  }
}

TEST(UnknownWave, IsTheSpectrumOfACosineAndASine) {
  constexpr std::size_t n = 64;
  // Tones between two bins and on one, and a decay.
  for (const Complex pole :
       {Complex(0., 0.6), Complex(0., 0.125 * 2. * std::numbers::pi), Complex(-0.03, 0.4)}) {
    const auto parts = unknown_wave(2., pole, n, n / 2 - 1);
    EXPECT_EQ(parts[0].variance, 2.);
    EXPECT_EQ(parts[1].variance, 2.);
    for (std::size_t b = 0; b < n / 2 - 1; ++b) {
      Complex cosine = 0., sine = 0.;
      for (std::size_t k = 0; k < n; ++k) {
        const Complex wave = std::exp(static_cast<double>(k) * pole);
        const Complex turn =
            std::polar(1., -2. * std::numbers::pi * static_cast<double>((b + 1) * k) / n);
        cosine += wave.real() * turn;
        sine += wave.imag() * turn;
      }
      EXPECT_LT(std::abs(parts[0].shape[b] - cosine), 1e-9) << pole << " bin " << b;
      EXPECT_LT(std::abs(parts[1].shape[b] - sine), 1e-9) << pole << " bin " << b;
    }
  }
}

TEST(UnknownRamp, IsTheSpectrumOfALine) {
  constexpr std::size_t n = 64;
  const RecordNuisance ramp = unknown_ramp(2., n, n / 2 - 1);
  for (std::size_t b = 0; b < ramp.shape.size(); ++b) {
    Complex sum = 0.;
    for (std::size_t k = 0; k < n; ++k)
      sum += static_cast<double>(k) / n *
             std::polar(1., -2. * std::numbers::pi * static_cast<double>((b + 1) * k) / n);
    EXPECT_LT(std::abs(ramp.shape[b] - sum), 1e-9) << b;
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
