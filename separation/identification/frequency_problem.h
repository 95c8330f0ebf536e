#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "separation/model/fitted_bvrm.h"
#include "separation/model/input_hold.h"
#include "separation/model/mode_step.h"
#include "separation/numerics/levenberg_marquardt.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

/// Sampling of a frequency response that was measured as the ratio of spectra of samples.
struct Sampling {
  double rate_hz = 0.;
  Hold hold = Hold::first_order;
};

/// Weighted differences between a measured frequency response and a model: e = sqrt(weight) (H -
/// G(j w)), real parts first, then imaginary parts. Lines without a finite value are ignored.
/// weight = 2 / variance, where the variance of a line is averaged with the variances of its
/// neighbours (few periods give a poor estimate for one line); equal weights when a line has no
/// variance. Throws UserError for inconsistent lines and frequencies.
class FrequencyProblem {
 public:
  FrequencyProblem(const signals::FrequencyResponse& response, std::optional<Sampling> sampling,
                   bool direct_term, double delay_s);

  Eigen::Index n_lines() const { return s_.size(); }
  Eigen::Index n_residuals() const { return 2 * n_lines(); }
  bool direct_term() const { return direct_term_; }
  double delay_s() const { return delay_s_; }
  const Eigen::ArrayXcd& s() const { return s_; }  // j w of the lines
  const Eigen::ArrayXd& root_weight() const { return root_weight_; }
  const Eigen::ArrayXcd& measured() const { return measured_; }
  double highest_rad_s() const { return s_[s_.size() - 1].imag(); }
  /// Whether the mode is stable and below the frequency where aliases begin.
  bool admissible(const ModalTerm& mode) const;
  /// sum of weight |H|^2.
  double total() const { return total_; }

  /// For minimise().
  bool linearise(const Eigen::VectorXd& parameters, NormalEquations& equations) const;
  /// e at these parameters.
  Eigen::VectorXd residual(const Eigen::VectorXd& parameters) const;
  /// Weighted columns of the linear parameters b1, b0 of a mode with these poles.
  Eigen::MatrixXd gain_columns(double a1, double a0) const;
  /// Weighted column of the direct term.
  Eigen::VectorXd direct_column() const;
  /// The model with these poles whose gains fit best (linear least squares).
  Eigen::VectorXd with_best_gains(const std::vector<ModalTerm>& poles) const;

 private:
  struct ModeResponse;

  void take_lines(const signals::FrequencyResponse& response);
  void weigh(const std::vector<double>& standard_deviation);
  ModeResponse mode_response(const ModalTerm& mode, bool derivatives) const;
  void evaluate(const Eigen::VectorXd& parameters, Eigen::VectorXd& residual,
                Eigen::MatrixXd* jacobian) const;

  std::optional<Sampling> sampling_;
  bool direct_term_;
  double delay_s_;
  SampledDelay delay_;
  double highest_damped_rad_s_ = std::numeric_limits<double>::infinity();
  Eigen::ArrayXcd s_, measured_;
  Eigen::ArrayXd root_weight_;
  Eigen::ArrayXcd gain_weight_, direct_weight_;  // root_weight times the effect of the delay
  std::array<Eigen::ArrayXcd, 3> late_;          // exp(-j w n / rate), n = 1, 2, 3
  double total_ = 0.;
};

}  // namespace vibrissa::separation
