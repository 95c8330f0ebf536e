#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "separation/filters/output_guard.h"
#include "separation/filters/separator.h"
#include "separation/numerics/tap_window.h"

namespace vibrissa::separation {

struct RlsOptions {
  std::size_t filter_length = 64;
  /// lambda per sample, above 0 and at most 1.
  double forgetting = 0.9995;
  /// Regularisation of the taps towards zero, as a share of the mean power of the acceleration so
  /// far.
  double regularisation = 1e-6;
};

/// Recursive least squares from base acceleration to base moment: the taps before each sample
/// minimise sum_i lambda^(n - i) (M_r[i] - w . x[i])^2 exactly. The state is the triangular factor
/// of the weighted data, which Givens rotations update with each sample (Haykin, Adaptive Filter
/// Theory, QR-RLS); there is no covariance matrix that could become indefinite. At each sample one
/// tap, in turn, is regularised towards zero with the weight sqrt(regularisation n_taps mean x^2),
/// so that all taps are determined for a base at rest or a single tone. The cost is proportional to
/// n_taps^2 for each sample; no latency. Proven by tests/separation/filters/rls_test.cc against the
/// normal equations.
class Rls : public Separator {
 public:
  /// Throws UserError for options out of range, with the option's name.
  explicit Rls(const RlsOptions& options);

  void process(std::span<const double> base_acceleration, std::span<const double> base_moment,
               std::span<double> wind_moment) override;
  void reset() override;
  std::string name() const override { return "RLS"; }
  std::size_t latency_samples() const override { return 0; }
  std::vector<double> impulse_response() const { return {taps_.begin(), taps_.end()}; }

 private:
  double step(double x, double d);
  void rotate_in(Eigen::Index first);
  void pull_one_tap();
  void solve();

  RlsOptions options_;
  TapWindow window_;
  OutputGuard guard_;
  /// Column j: row j of the upper triangular factor from its diagonal on, so that rows are
  /// contiguous.
  Eigen::MatrixXd factor_;
  Eigen::VectorXd target_, taps_, row_;
  double row_target_ = 0., sum_of_squares_ = 0., n_samples_ = 0.;
  Eigen::Index next_pulled_ = 0;
};

}  // namespace vibrissa::separation
