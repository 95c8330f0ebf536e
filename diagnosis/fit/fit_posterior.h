#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"
#include "diagnosis/prediction/chain_simulation.h"

namespace vibrissa::diagnosis {

/// Influence of an effect or nuisance.
struct EffectAction {
  const Effect* effect = nullptr;
  /// Whitened energy, sum |mean - mean without it|^2 / S; for effects including the change of S.
  double energy = 0.;
  std::vector<std::vector<Complex>> change{};  // of the mean [record][bin], N m
};

/// A model form error also appears in neighbouring bins, up to this distance.
inline constexpr std::size_t form_reach = 10;

/// Power of an effect's model form error around each bin, given its change of the mean.
std::vector<double> model_form_error_power(const Effect& effect, std::span<const Complex> change);

/// Derivatives by the parameters: of the mean (real and imaginary parts in turn) [N m], of its
/// variance [(N m)^2], and of the accelerometer's variance [(m/s^2)^2].
struct Derivatives {
  Eigen::MatrixXd mean, variance;
  Eigen::VectorXd acceleration;
};

/// Log posterior of a fit's parameters by Whittle's likelihood (see fit_hypothesis()). The parts of
/// the variance that depend on the mean (misfit of the nominal model, model form errors) are
/// constant between updates. experiment and parameters must outlive this object.
class FitPosterior {
 public:
  FitPosterior(const Experiment& experiment, const std::vector<FitParameter>& fit_parameters,
               const Hypothesis& hypothesis);

  std::vector<Prediction> predict(const Eigen::VectorXd& x) const;
  /// Updates the parts of the variance that depend on the mean; at: the predictions at x.
  void update_slow_variance(const Eigen::VectorXd& x, const std::vector<Prediction>& at);

  /// Variance per sample of the accelerometer [(m/s^2)^2].
  double acceleration_variance(const Eigen::VectorXd& x) const;
  /// Variance of each bin of a record [(N m)^2].
  std::vector<double> variance(const Eigen::VectorXd& x, const Prediction& prediction,
                               std::size_t record, double acceleration_variance) const;
  double log_likelihood(const Eigen::VectorXd& x, const std::vector<Prediction>& at) const;
  double log_prior(const Eigen::VectorXd& x) const;

  /// Derivatives by the free parameters; those by the noise parameters are left at zero.
  Derivatives derivatives(const Eigen::VectorXd& x, const std::vector<Prediction>& at) const;
  /// Gradient of the log posterior, and Fisher's information plus the prior's curvature.
  /// derivatives: at x, or at a place from which they have hardly changed.
  void linearise(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                 const Derivatives& derivatives, Eigen::VectorXd& gradient,
                 Eigen::MatrixXd& information) const;

  /// Whitened energies in the order of the parameters.
  std::vector<EffectAction> actions(const Eigen::VectorXd& x,
                                    const std::vector<Prediction>& at) const;

 private:
  using BinVariances = std::vector<std::vector<double>>;  // [record][bin]

  /// Finite-difference step of a parameter.
  double step_of(const Eigen::VectorXd& x, Eigen::Index index) const;
  /// Derivatives from the predictions of a chain after a step h of one parameter.
  void set_derivative(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                      const BinVariances& s, const Chain& moved,
                      const std::vector<Prediction>& there, double h, Eigen::Index index,
                      Derivatives& out) const;
  /// Derivatives of the total variance divided by it; sets those by the noise parameters.
  Derivatives whitened(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                       const BinVariances& s, double acceleration_variance,
                       const Derivatives& derivatives) const;
  void set_noise_column(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                        const BinVariances& s, double acceleration_variance, Eigen::Index index,
                        Derivatives& out) const;
  void set_share_column(const Eigen::VectorXd& x, const BinVariances& s, Eigen::Index index,
                        Derivatives& out) const;
  BinVariances variances(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                         double acceleration_variance) const;
  void remove_unknowns(const std::vector<Prediction>& at, const BinVariances& s,
                       const Eigen::MatrixXd& mean_columns, Eigen::VectorXd& gradient,
                       Eigen::MatrixXd& information) const;
  void add_model_form_error(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                            const Effect& effect);
  /// Parameter of the discrepancy for a bin.
  Eigen::Index discrepancy_index(std::size_t record, std::size_t b) const;
  /// Variance of the accelerometer under a given chain.
  double acceleration_variance(const Eigen::VectorXd& x, const Chain& chain) const;

  const Experiment& experiment_;
  const std::vector<FitParameter>& fit_parameters_;
  bool model_form_error_, discrepancy_;
  BinVariances misfit_, form_, power_;
};

}  // namespace vibrissa::diagnosis
