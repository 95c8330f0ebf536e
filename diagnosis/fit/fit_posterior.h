#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"
#include "diagnosis/fit/model_discrepancy.h"
#include "diagnosis/prediction/chain_simulation.h"

namespace vibrissa::diagnosis {

/// Bins around one over which the power of a prediction is averaged.
inline constexpr std::size_t power_reach = 10;

/// Derivatives by the free parameters of the chain (FitPosterior::chain_parameters(), a column
/// each): of the mean with the most probable per-record nuisance parameters (real and imaginary
/// parts in turn) [N m], of its variance [(N m)^2], of the logarithms of the nuisance parameters'
/// variances (of all records in turn), and of the accelerometer's variance [(m/s^2)^2].
struct Derivatives {
  Eigen::MatrixXd mean, variance, nuisance_variance;
  Eigen::VectorXd acceleration;
};

/// Log posterior of a fit's parameters by Whittle's likelihood with the simulation's discrepancy
/// (see fit_hypothesis()). The parts of the covariance that depend on the mean (misfit of the
/// nominal model, discrepancy) are constant between updates. experiment and parameters must outlive
/// this object.
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

  using Nuisances = std::vector<IntegratedNuisances>;  // of each record
  /// Errors of all records, divided by the standard deviations of their noise, without the most
  /// probable per-record nuisance parameters.
  struct WhitenedErrors {
    Eigen::VectorXcd error;
    Eigen::VectorXd per_deviation;
    Nuisances nuisances;
  };
  /// at: must outlive the result.
  WhitenedErrors whitened_errors(const Eigen::VectorXd& x, const std::vector<Prediction>& at) const;
  /// The discrepancy given the errors at x.
  ModelDiscrepancy::Solution discrepancy(const Eigen::VectorXd& x,
                                         const WhitenedErrors& whitened) const;

  /// Indices of the free parameters that change predictions.
  const std::vector<Eigen::Index>& chain_parameters() const { return of_chain_; }
  Derivatives derivatives(const Eigen::VectorXd& x, const std::vector<Prediction>& at) const;
  /// Gradient of the log posterior, and Fisher's information plus the prior's curvature.
  /// derivatives: at x, or at a place from which they have hardly changed.
  void linearise(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                 const Derivatives& derivatives, Eigen::VectorXd& gradient,
                 Eigen::MatrixXd& information) const;

 private:
  using BinVariances = std::vector<std::vector<double>>;  // [record][bin]

  /// Does the last parameter scale the form errors of effects?
  bool has_form_errors() const {
    return fit_parameters_.back().description.name == form_error_level;
  }
  double form_level(const Eigen::VectorXd& x) const {
    return has_form_errors() ? std::exp(x(x.size() - 1)) : 0.;
  }
  /// Change of the mean by one effect.
  Eigen::VectorXcd change_by(const Effect& effect, const Eigen::VectorXd& x,
                             const Eigen::VectorXcd& mean) const;

  /// Derivatives from the predictions of a chain after a step h of one parameter.
  void set_derivative(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                      const BinVariances& s, const Nuisances& nuisances, const Chain& moved,
                      const std::vector<Prediction>& there, double h, Eigen::Index column,
                      Derivatives& out) const;
  /// Derivatives of the total variance divided by it, by the parameters of the chain and then by
  /// the levels.
  Eigen::MatrixXd relative_variance(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                                    const BinVariances& s, const Eigen::VectorXd& per_deviation,
                                    const Derivatives& derivatives) const;
  Eigen::VectorXd level_column(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                               const BinVariances& s, Eigen::Index index) const;
  /// Parts of linearise(): what the means and the sizes of the nuisance parameters tell about the
  /// parameters of the chain, and what the variances tell about all free ones.
  void add_means(const WhitenedErrors& errors, const ModelDiscrepancy::Solution& terms,
                 const Derivatives& derivatives, Eigen::VectorXd& gradient,
                 Eigen::MatrixXd& information) const;
  void add_nuisances(const Nuisances& nuisances, const Eigen::MatrixXd& log_variance,
                     Eigen::VectorXd& gradient, Eigen::MatrixXd& information) const;
  void add_variances(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                     const BinVariances& s, const WhitenedErrors& errors,
                     const ModelDiscrepancy::Solution& terms, const Derivatives& derivatives,
                     Eigen::VectorXd& gradient, Eigen::MatrixXd& information) const;
  void add_accelerometer(double acceleration_variance, const Eigen::VectorXd& slope,
                         Eigen::VectorXd& gradient, Eigen::MatrixXd& information) const;
  BinVariances variances(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                         double acceleration_variance) const;
  Nuisances nuisances_of(const std::vector<Prediction>& at, const BinVariances& s) const;
  WhitenedErrors whitened_errors(const std::vector<Prediction>& at, const BinVariances& s) const;
  /// Parameter of the unknown cause for a bin.
  Eigen::Index unknown_index(std::size_t record, std::size_t b) const;
  /// Variance of the accelerometer under a given chain.
  double acceleration_variance(const Eigen::VectorXd& x, const Chain& chain) const;

  const Experiment& experiment_;
  const std::vector<FitParameter>& fit_parameters_;
  std::vector<const Effect*> effects_;
  bool unknown_;
  std::vector<Eigen::Index> of_chain_, levels_;  // free parameters of the chain, and levels
  BinVariances misfit_, power_, incoherent_, form_;
  ModelDiscrepancy discrepancy_;
};

/// Takes the per-record nuisance parameters out of whitened columns (real and imaginary parts in
/// turn) of all records, and out of the columns' information: what they imitate tells nothing.
/// Proven by tests/diagnosis/search/resemblance_test.cc.
void remove_nuisances(const FitPosterior::Nuisances& nuisances, Eigen::Ref<Eigen::MatrixXd> columns,
                      Eigen::MatrixXd* information = nullptr);

}  // namespace vibrissa::diagnosis
