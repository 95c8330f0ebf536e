#include "diagnosis/fit/model_discrepancy.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

class ModelDiscrepancyTest : public testing::Test {
 protected:
  ModelDiscrepancyTest()
      : experiment_(prepare_experiment(
            test::nominal_of(test::OneModeRig{}, true),
            test::rig_dataset(test::noisy_rig(), {.wind = true, .quiet = true, .held_out = false}),
            signals::Split::fit, InputNoise::reduced)),
        discrepancy_(experiment_),
        error_(random(1)),
        per_deviation_(random(2).cwiseAbs().array() + 0.1) {
    DiscrepancyShapes shapes{.mean = random(3), .changes = Eigen::MatrixXcd(n(), 1)};
    shapes.changes.col(0) = random(4);
    discrepancy_.set_shapes(std::move(shapes));
  }

  Eigen::Index n() const { return discrepancy_.n_rows(); }
  Eigen::VectorXcd random(unsigned seed) const {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    Eigen::VectorXcd out(n());
    for (Complex& value : out) value = {normal(generator), normal(generator)};
    return out;
  }
  ModelDiscrepancy::Solution solve(const DiscrepancyLevels& levels) const {
    return discrepancy_.solve(error_, per_deviation_, levels);
  }
  /// The whitened covariance I + U P U', from the terms of each row and their prior covariance.
  Eigen::MatrixXcd covariance(const ModelDiscrepancy::Solution& solution) const {
    Eigen::MatrixXcd out = Eigen::MatrixXcd::Identity(n(), n());
    const Eigen::MatrixXcd& u = solution.terms();
    for (Eigen::Index a = 0; a < n(); ++a)
      for (Eigen::Index b = 0; b < n(); ++b)
        if (const int j = discrepancy_.block(a), k = discrepancy_.block(b); j >= 0 && k >= 0)
          out(a, b) +=
              (u.row(a) * discrepancy_.prior_covariance(j, k, levels_) * u.row(b).adjoint())
                  .value();
    return out;
  }

  const DiscrepancyLevels levels_{0.3, 0.1, 0.2, 0.5, 0.05, 0.4, 0.4, 0.2};
  Experiment experiment_;
  ModelDiscrepancy discrepancy_;
  Eigen::VectorXcd error_;
  Eigen::VectorXd per_deviation_;
};

TEST_F(ModelDiscrepancyTest, IsTheGaussianOfItsWholeCovariance) {
  const auto solution = solve(levels_);
  const Eigen::LLT<Eigen::MatrixXcd> llt(covariance(solution));
  const Eigen::VectorXcd weighed = llt.solve(error_);
  const double whole = -error_.dot(weighed).real() -
                       2. * Eigen::MatrixXcd(llt.matrixL()).diagonal().real().array().log().sum();
  EXPECT_NEAR(solution.log_likelihood_gain(), whole + error_.squaredNorm(), 1e-8);
  EXPECT_LT((solution.apply_inverse(error_) - weighed).norm(), 1e-9 * weighed.norm());
  // What the terms explain, and how much of each row's variance they keep.
  EXPECT_LT((error_ - solution.mean() - weighed).norm(), 1e-9 * weighed.norm());
  const Eigen::VectorXd diagonal =
      llt.solve(Eigen::MatrixXcd::Identity(n(), n())).diagonal().real();
  EXPECT_LT((Eigen::VectorXd::Ones(n()) - solution.leverage() - diagonal).norm(), 1e-9);
}

TEST_F(ModelDiscrepancyTest, ItsGradientIsThatOfTheLikelihood) {
  constexpr double h = 1e-5;
  const auto solution = solve(levels_);
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const auto gain = [&](double step) {
      DiscrepancyLevels moved = levels_;
      moved[level] *= std::exp(step);
      return solve(moved).log_likelihood_gain();
    };
    EXPECT_NEAR(solution.gradient()[level], (gain(h) - gain(-h)) / (2. * h),
                1e-5 * (1. + std::abs(solution.gradient()[level])))
        << level;
  }
}

TEST_F(ModelDiscrepancyTest, ProjectsColumnsByTheInverseOfTheCovariance) {
  const auto solution = solve(levels_);
  const Eigen::VectorXcd column = random(5);
  Eigen::MatrixXd parts(2 * n(), 1);
  for (Eigen::Index row = 0; row < n(); ++row) {
    parts(2 * row, 0) = column(row).real();
    parts(2 * row + 1, 0) = column(row).imag();
  }
  Eigen::VectorXd gradient(1);
  gradient << 2. * column.dot(error_).real();
  Eigen::MatrixXd information(1, 1);
  information << 2. * column.squaredNorm();
  solution.project(parts, gradient, information);
  const Eigen::VectorXcd weighed = solution.apply_inverse(column);
  EXPECT_NEAR(gradient(0), 2. * weighed.dot(error_).real(), 1e-8);
  EXPECT_NEAR(information(0, 0), 2. * weighed.dot(column).real(), 1e-8);
}

TEST_F(ModelDiscrepancyTest, BuysOneValueABlockHoweverManyBinsItHas) {
  // The same relative error of the prediction in all bins is one value in each block.
  DiscrepancyShapes shapes{.mean = 1e3 * random(3), .changes = Eigen::MatrixXcd(n(), 0)};
  const Eigen::VectorXcd mean = shapes.mean;
  discrepancy_.set_shapes(std::move(shapes));
  per_deviation_.setOnes();
  error_ = 0.01 * mean;
  for (Eigen::Index row = 0; row < n(); ++row)
    if (discrepancy_.block(row) < 0) error_(row) = 0.;
  const double left =
      error_.squaredNorm() - solve({0.01, 0.01, 0.01, 1e-3, 1e-3, 1e-3, 1.}).log_likelihood_gain();
  const auto n_blocks = static_cast<double>(discrepancy_.n_blocks());
  EXPECT_LT(left, 12. * n_blocks);
  EXPECT_GT(error_.squaredNorm(), 100. * left);
}

}  // namespace
}  // namespace vibrissa::diagnosis
