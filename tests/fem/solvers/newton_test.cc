#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/solvers/newton.h"

#include <cmath>
#include <functional>

#include "fem/factors/sparse_factors.h"
#include "fem/solvers/secant_memory.h"

namespace vibrissa::fem {
namespace {

/// One unknown: resistance r(u) against a load.
class OneSpring : public BalanceProblem {
 public:
  OneSpring(std::function<double(double)> resistance, std::function<double(double)> stiffness,
            const double load)
      : resistance_(std::move(resistance)), stiffness_(std::move(stiffness)), load_(load) {}
  double forces(const Vector& u, Vector& out_of_balance) override {
    out_of_balance[0] = load_ - resistance_(u[0]);
    out_of_balance.compress(dealii::VectorOperation::insert);
    return std::abs(load_) + std::abs(resistance_(u[0]));
  }
  void factorise(const Vector& u, const Vector&) override {
    factor_ = stiffness_(u[0]);
    if (!(factor_ > 0.)) throw IndefiniteMatrix("indefinite");
    ++n_factorisations;
  }
  bool is_factorised() const override { return factor_ > 0.; }
  void solve(const Vector& out_of_balance, Vector& step) override {
    step[0] = out_of_balance[0] / factor_;
    step.compress(dealii::VectorOperation::insert);
  }
  int n_factorisations = 0;

 private:
  std::function<double(double)> resistance_, stiffness_;
  double load_, factor_ = 0.;
};

Vector one(const double value) {
  Vector u(MPI_COMM_SELF, 1, 1);
  u[0] = value;
  u.compress(dealii::VectorOperation::insert);
  return u;
}

TEST(Newton, FindsTheRootOfAStiffeningSpringFromAfar) {
  OneSpring spring([](double u) { return u + 1e6 * u * u * u; },
                   [](double u) { return 1. + 3e6 * u * u; }, 1e6 + 1.);
  Vector u = one(0.);
  const auto report = solve_balance(spring, u, u);
  EXPECT_TRUE(report.converged) << report.failure;
  EXPECT_NEAR(u[0], 1., 1e-9);
}

TEST(Newton, StepsBackFromWhereThereIsNoState) {
  OneSpring spring([](double u) { return std::log(u); }, [](double u) { return 1. / u; }, -3.);
  Vector u = one(1.);
  const auto report = solve_balance(spring, u, u);
  EXPECT_TRUE(report.converged) << report.failure;
  EXPECT_NEAR(u[0], std::exp(-3.), 1e-9);
}

TEST(Newton, KeepsATangentThatConverges) {
  OneSpring spring([](double u) { return u + 0.01 * u * u; }, [](double) { return 1.; }, 0.1);
  Vector u = one(0.);
  EXPECT_TRUE(solve_balance(spring, u, u).converged);
  EXPECT_EQ(spring.n_factorisations, 1);
  u = one(0.05);
  EXPECT_TRUE(solve_balance(spring, u, u).converged);
  EXPECT_EQ(spring.n_factorisations, 1);
}

TEST(Newton, TellsAnIndefiniteTangentAndAStartOutsideTheBody) {
  OneSpring soft([](double u) { return -u; }, [](double) { return -1.; }, 1.);
  Vector u = one(0.);
  EXPECT_THAT(solve_balance(soft, u, u).failure, testing::HasSubstr("not positive definite"));
  OneSpring log([](double v) { return std::log(v); }, [](double v) { return 1. / v; }, 1.);
  u = one(-1.);
  EXPECT_THAT(solve_balance(log, one(1.), u).failure, testing::HasSubstr("not a valid state"));
}

TEST(Newton, TellsHowTheForcesWentWhenItRunsOut) {
  OneSpring spring([](double u) { return std::cbrt(u); }, [](double) { return 1e3; }, 1.);
  Vector u = one(0.);
  NewtonOptions options;
  options.max_iterations = 3;
  const auto report = solve_balance(spring, u, u, options);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.residuals.size(), 4u);
  EXPECT_THAT(report.history(), testing::HasSubstr("1, "));
}

Vector two(const double x, const double y) {
  Vector u(MPI_COMM_SELF, 2, 2);
  u[0] = x;
  u[1] = y;
  u.compress(dealii::VectorOperation::insert);
  return u;
}

void halve(const Vector& force, Vector& step) {
  step = force;
  step *= 0.5;
}

TEST(SecantMemory, MeetsTheLastPairAndStaysPositive) {
  SecantMemory memory(3);
  Vector x = two(0., 0.);
  memory.solve(halve, two(2., 4.), x);
  EXPECT_DOUBLE_EQ(x[0], 1.);
  EXPECT_DOUBLE_EQ(x[1], 2.);
  memory.add(two(1., 0.), two(7., 1.));
  memory.add(two(1., 3.), two(2., 5.));
  memory.solve(halve, two(2., 5.), x);
  EXPECT_NEAR(x[0], 1., 1e-14);
  EXPECT_NEAR(x[1], 3., 1e-14);
  for (const double angle : {0., 1., 2., 3.}) {
    const Vector f = two(std::cos(angle), std::sin(angle));
    memory.solve(halve, f, x);
    EXPECT_GT(x * f, 0.);
  }
}

// H <- (1 - s y^T / y.s) H (1 - y s^T / y.s) + s s^T / y.s, pair by pair.
TEST(SecantMemory, IsTheInverseThatBfgsGives) {
  const Eigen::Vector2d steps[] = {{1., 0.}, {1., 3.}}, growths[] = {{7., 1.}, {2., 5.}};
  SecantMemory memory(3);
  Eigen::Matrix2d inverse = 0.5 * Eigen::Matrix2d::Identity();
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d &s = steps[i], &y = growths[i];
    memory.add(two(s[0], s[1]), two(y[0], y[1]));
    const Eigen::Matrix2d left = Eigen::Matrix2d::Identity() - s * y.transpose() / y.dot(s);
    inverse = left * inverse * left.transpose() + s * s.transpose() / y.dot(s);
  }
  Vector x = two(0., 0.);
  for (const double angle : {0., 1., 2., 3.}) {
    const Eigen::Vector2d f(std::cos(angle), std::sin(angle)), expected = inverse * f;
    memory.solve(halve, two(f[0], f[1]), x);
    EXPECT_NEAR(x[0], expected[0], 1e-14);
    EXPECT_NEAR(x[1], expected[1], 1e-14);
  }
}

TEST(SecantMemory, LeavesOutWhatNoPositiveStiffnessHas) {
  SecantMemory memory(3);
  Vector x = two(0., 0.);
  memory.add(two(1., 0.), two(-7., 1.));
  memory.solve(halve, two(2., 4.), x);
  EXPECT_DOUBLE_EQ(x[0], 1.);
  EXPECT_DOUBLE_EQ(x[1], 2.);
}

// A fixed tangent takes a digit in three iterations here: 30 of them.
TEST(Newton, SecantsSaveAKeptTangentMostOfItsIterations) {
  OneSpring spring([](double u) { return u; }, [](double) { return 2.; }, 1.);
  NewtonOptions options;
  options.tangent_worth_iterations = 1e9;
  Vector u = one(0.);
  EXPECT_LE(solve_balance(spring, u, u, options).residuals.size(), 4u);
  options.n_secants = 0;
  spring.n_factorisations = 0;
  u = one(0.);
  EXPECT_GT(solve_balance(spring, u, u, options).residuals.size(), 20u);
  EXPECT_LE(spring.n_factorisations, 1);
}

}  // namespace
}  // namespace vibrissa::fem
