#include "diagnosis/fit/hypothesis_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/fit/fit_posterior.h"
#include "diagnosis/fit/measured_start.h"
#include "diagnosis/fit/optimiser.h"
#include "diagnosis/fit/pattern_search.h"
#include "diagnosis/prediction/record_nuisances.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// Iterations with the usual level of the discrepancy, before it is free.
constexpr int n_held_iterations = 8;

/// Starting coordinates: noise levels as estimated, nuisances nominal or from start, effects at one
/// of their own starts or from start.
Eigen::VectorXd start_vector(const Experiment& experiment,
                             const std::vector<FitParameter>& fit_parameters,
                             const HypothesisFit* start, bool nominal_nuisances) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(fit_parameters.size()));
  x(index_of_moment_noise) = std::log(experiment.moment_noise);
  x(index_of_acceleration_noise) = std::log(experiment.acceleration_noise);
  x(index_of_flicker) = fit_parameters[index_of_flicker].description.prior.centre;
  x(index_of_joint_share) = experiment.nominal.joint_share;
  x(index_of_joint_loss) = 1.;
  x(index_of_higher_joint_share) = experiment.nominal.higher_joint_share;
  x.segment(index_of_discrepancy, n_discrepancy_levels)
      .setConstant(std::log(experiment.simulation_accuracy));
  x(index_of_incoherence) = fit_parameters[index_of_incoherence].description.prior.centre;
  if (start != nullptr)
    x.head(nominal_nuisances ? n_noise_parameters : n_common_parameters) =
        start->x.head(nominal_nuisances ? n_noise_parameters : n_common_parameters);
  for (std::size_t i = n_common_parameters; i < fit_parameters.size(); ++i) {
    const FitParameter& fit_parameter = fit_parameters[i];
    double& value = x(static_cast<Eigen::Index>(i));
    if (fit_parameter.effect == nullptr) {
      value = fit_parameter.description.name == form_error_level
                  ? fit_parameter.description.prior.centre
                  : std::log(0.02);
      continue;
    }
    const double at = fit_parameter.effect->starts.front()[fit_parameter.parameter];
    value = fit_parameter.nuisance ? fit_parameter.description.prior.centre
                                   : fit_parameter.description.coordinate(at);
    if (start == nullptr || (fit_parameter.nuisance && nominal_nuisances)) continue;
    if (const auto index = start->index(fit_parameter.effect->id, fit_parameter.parameter))
      value = start->x(static_cast<Eigen::Index>(*index));
  }
  clamp(fit_parameters, x);
  return x;
}

/// Moves one effect to these values, within its bounds.
void set_effect(const std::vector<FitParameter>& fit_parameters, const Effect& effect,
                const std::vector<double>& values, Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < fit_parameters.size(); ++i)
    if (fit_parameters[i].effect == &effect)
      x(static_cast<Eigen::Index>(i)) =
          fit_parameters[i].description.coordinate(values[fit_parameters[i].parameter]);
  clamp(fit_parameters, x);
}

void scale_stiffness(const std::vector<FitParameter>& fit_parameters, const double ratio,
                     Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < fit_parameters.size(); ++i)
    if (const Effect* effect = fit_parameters[i].effect;
        effect != nullptr && effect->id == "stiffness" && fit_parameters[i].parameter == 0)
      x(static_cast<Eigen::Index>(i)) += std::log(ratio);
  clamp(fit_parameters, x);
}

/// All combinations of the starts of the effects that the given start does not contain.
std::vector<Eigen::VectorXd> start_vectors(const Experiment& experiment,
                                           const std::vector<FitParameter>& fit_parameters,
                                           const Hypothesis& hypothesis, const HypothesisFit* start,
                                           bool nominal_nuisances) {
  std::vector<Eigen::VectorXd> starts{
      start_vector(experiment, fit_parameters, start, nominal_nuisances)};
  for (const Effect* effect : hypothesis.effects()) {
    if (start != nullptr && start->hypothesis.contains(effect->id)) continue;
    std::vector<Eigen::VectorXd> more;
    for (const Eigen::VectorXd& x : starts)
      for (const std::vector<double>& values : effect->starts) {
        more.push_back(x);
        set_effect(fit_parameters, *effect, values, more.back());
        if (effect->equivalent_stiffness) {
          more.push_back(more.back());
          scale_stiffness(fit_parameters, 1. / effect->equivalent_stiffness(values), more.back());
        }
      }
    starts = std::move(more);
  }
  // An effect that describes the accelerometer's noise replaces the noise parameter.
  for (Eigen::VectorXd& x : starts)
    if (make_chain(experiment, fit_parameters, x).reference_variance > 0.)
      x(index_of_acceleration_noise) =
          std::min(x(index_of_acceleration_noise), std::log(usual_acceleration_noise));
  return starts;
}

Eigen::VectorXd further_start(const Experiment& experiment,
                              const std::vector<FitParameter>& fit_parameters,
                              const FurtherStart& further) {
  Eigen::VectorXd x = start_vector(experiment, fit_parameters, further.without, false);
  set_effect(fit_parameters, *further.effect, further.values, x);
  return x;
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& matrix, double& log_determinant) {
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  const Eigen::VectorXd values = solver.eigenvalues().cwiseMax(1e-12);
  log_determinant = values.array().log().sum() - 2. * scale.array().log().sum();
  return scale.asDiagonal() * solver.eigenvectors() * values.cwiseInverse().asDiagonal() *
         solver.eigenvectors().transpose() * scale.asDiagonal();
}

std::vector<FittedRecord> fitted_records(const Experiment& experiment,
                                         const FitPosterior& posterior, const HypothesisFit& fit,
                                         const std::vector<Prediction>& predictions) {
  const double a_variance = posterior.acceleration_variance(fit.x);
  const double a_excess = fit.chain(experiment).reference_variance;
  const Eigen::VectorXcd discrepancy =
      posterior.discrepancy(fit.x, posterior.whitened_errors(fit.x, predictions)).mean();
  std::vector<FittedRecord> records;
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < predictions.size(); ++r) {
    FittedRecord record{.mean = predictions[r].mean,
                        .process_noise = predictions[r].process_noise,
                        .variance = posterior.variance(fit.x, predictions[r], r, a_variance),
                        .unknowns = predictions[r].unknowns};
    for (std::size_t b = 0; b < record.process_noise.size(); ++b, ++row) {
      record.process_noise[b] += a_excess * predictions[r].acceleration_noise[b];
      record.noise.push_back(experiment.moment_noise * experiment.moment_noise *
                                 predictions[r].moment_noise[b] +
                             experiment.acceleration_noise * experiment.acceleration_noise *
                                 predictions[r].acceleration_noise[b]);
      record.discrepancy.push_back(discrepancy(row) * std::sqrt(record.variance[b]));
    }
    records.push_back(std::move(record));
  }
  return records;
}

/// The levels of the discrepancy stay at the centres of their priors: far from the optimum they
/// would explain what the parameters should.
std::vector<FitParameter> with_usual_discrepancy(std::vector<FitParameter> fit_parameters) {
  for (std::size_t i = 0; i < fit_parameters.size(); ++i)
    if ((i >= index_of_discrepancy && i < n_common_parameters) ||
        fit_parameters[i].description.name == form_error_level)
      fit_parameters[i].description.prior.fix();
  return fit_parameters;
}

/// Calibration parameters of the chosen effects fixed at their nominal values.
template <typename Chosen>
std::vector<FitParameter> with_nominal(std::vector<FitParameter> fit_parameters,
                                       const Chosen& is_chosen) {
  for (FitParameter& fit_parameter : fit_parameters)
    if (fit_parameter.nuisance && is_chosen(fit_parameter.effect->id))
      fit_parameter.description.prior.fix();
  return fit_parameters;
}

std::vector<FitParameter> with_nominal_calibrations(const std::vector<FitParameter>& all) {
  return with_nominal(all, [](const std::string&) { return true; });
}

/// The effect by which starts move the resonance.
std::string effect_on_resonance(const Hypothesis& hypothesis) {
  return hypothesis.contains("mass") ? "mass" : "stiffness";
}

/// The starts with the resonances of the records; empty where those are not known.
std::vector<Eigen::VectorXd> at_measured_modes(const Experiment& experiment,
                                               const std::vector<FitParameter>& fit_parameters,
                                               const std::string& shifted,
                                               const std::vector<Eigen::VectorXd>& starts) {
  std::vector<Eigen::VectorXd> out;
  for (const Eigen::VectorXd& x : starts)
    if (const auto moved = start_at_measured_modes(experiment, fit_parameters, shifted, x))
      out.push_back(*moved);
  return out;
}

/// Does a resonance that moves with the level show in responses?
bool moves_in_responses(const Experiment& experiment, const Hypothesis& hypothesis) {
  return std::ranges::any_of(experiment.records, &PreparedRecord::is_response) &&
         std::ranges::any_of(hypothesis.effects(),
                             [](const Effect* effect) { return is_nonlinear(*effect); });
}

/// Coarse grid of resonances, because a narrow resonance has a narrow basin of attraction: by the
/// mass where the hypothesis holds it, otherwise by the stiffness; and the resonances of the
/// records.
std::vector<Eigen::VectorXd> with_shifted_resonances(
    const Experiment& experiment, const std::vector<FitParameter>& fit_parameters,
    const Hypothesis& hypothesis, const std::vector<Eigen::VectorXd>& starts) {
  const std::string shifted = effect_on_resonance(hypothesis);
  std::vector<Eigen::VectorXd> out = starts;
  for (std::size_t i = 0; i < fit_parameters.size(); ++i) {
    const FitParameter& parameter = fit_parameters[i];
    if (parameter.effect == nullptr || parameter.effect->id != shifted || parameter.parameter != 0)
      continue;
    for (const Eigen::VectorXd& x : starts)
      for (const double ratio : {0.5, 0.6, 0.7, 0.8, 0.9, 1.1, 1.2, 1.35}) {
        out.push_back(x);
        out.back()(static_cast<Eigen::Index>(i)) = std::log(ratio);
        clamp(fit_parameters, out.back());
      }
  }
  const auto measured = at_measured_modes(experiment, fit_parameters, shifted, {starts[0]});
  out.insert(out.end(), measured.begin(), measured.end());
  return out;
}

/// Sets all results of a fit at its optimum.
void set_at(HypothesisFit& fit, const Experiment& experiment, FitPosterior& posterior,
            OptimiserState& state) {
  fit.x = state.x;
  fit.n_iterations = state.n_iterations;
  fit.log_posterior = state.log_posterior;
  posterior.update_slow_variance(fit.x, state.predictions);
  if (!state.derivatives) state.derivatives = posterior.derivatives(fit.x, state.predictions);
  Eigen::VectorXd gradient;
  posterior.linearise(fit.x, state.predictions, *state.derivatives, gradient, fit.information);
  double log_determinant = 0.;
  fit.covariance = inverse(fit.information, log_determinant);
  fit.log_likelihood = posterior.log_likelihood(fit.x, state.predictions);
  fit.log_evidence = fit.log_likelihood + posterior.log_prior(fit.x) - 0.5 * log_determinant +
                     0.5 * static_cast<double>(fit.x.size()) * std::log(2. * std::numbers::pi);
  if (!std::isfinite(fit.log_evidence)) fit.log_evidence = -std::numeric_limits<double>::infinity();
  fit.records = fitted_records(experiment, posterior, fit, state.predictions);
}

/// Optimisations of one hypothesis from several starts; keeps the best result.
class Attempts {
 public:
  Attempts(const Experiment& experiment, const Hypothesis& hypothesis,
           const std::vector<FitParameter>& fit_parameters, const FitOptions& options)
      : experiment_(experiment),
        hypothesis_(hypothesis),
        fit_parameters_(fit_parameters),
        options_(options),
        posterior_(experiment, fit_parameters, hypothesis) {}

  /// First with the usual discrepancy, then with all parameters free.
  void from(const std::vector<Eigen::VectorXd>& starts) {
    // Free levels of the errors gain at most the squares of the whitened errors, one for each bin.
    double n_bins = 0.;
    for (const PreparedRecord& record : experiment_.records)
      n_bins += static_cast<double>(record.n_bins());
    from(starts, fit_parameters_, options_.to_beat - n_bins);
  }
  /// First with calibration parameters at their nominal values, too. They keep the posterior low,
  /// which does not make the basin hopeless.
  void from_nominal(const std::vector<Eigen::VectorXd>& starts) {
    from(starts, with_nominal_calibrations(fit_parameters_),
         -std::numeric_limits<double>::infinity());
  }
  /// From the best of the starts after a pattern search over the joint's share and the first
  /// parameters of the hypothesis's effects, of the damping and of the stiffness. A joint with all
  /// the compliance is tried, too: with less its laws saturate.
  void from_searched(std::vector<Eigen::VectorXd> starts) {
    constexpr auto share = static_cast<Eigen::Index>(index_of_joint_share);
    std::vector<Eigen::Index> coordinates;
    if (!fit_parameters_[index_of_joint_share].description.prior.is_fixed()) {
      coordinates.push_back(share);
      for (std::size_t i = 0, n = starts.size(); i < n; ++i) {
        starts.push_back(starts[i]);
        starts.back()(share) = 1.;
        clamp(fit_parameters_, starts.back());
      }
    }
    for (std::size_t i = 0; i < fit_parameters_.size(); ++i) {
      const FitParameter& parameter = fit_parameters_[i];
      if (parameter.effect == nullptr || parameter.description.prior.is_fixed()) continue;
      const std::string& id = parameter.effect->id;
      if (parameter.parameter == 0 &&
          (hypothesis_.contains(id) || id == "damping" || id == "stiffness"))
        coordinates.push_back(static_cast<Eigen::Index>(i));
    }
    const std::vector<FitParameter> held = with_usual_discrepancy(fit_parameters_);
    FitPosterior of_held(experiment_, held, hypothesis_);
    FitOptions none = options_;
    none.n_promising = 1;
    const OptimiserState best = best_start(of_held, held, starts, none);
    from({pattern_search(of_held, held, coordinates, best.x, options_)});
  }

  /// With all parameters free at once, from near the optimum.
  void from_near(const Eigen::VectorXd& x) {
    go_on(best_start(posterior_, fit_parameters_, {x}, options_));
  }

  FitPosterior& posterior() { return posterior_; }
  OptimiserState& best() { return *best_; }

 private:
  void from(const std::vector<Eigen::VectorXd>& starts, const std::vector<FitParameter>& held,
            const double to_beat) {
    if (best_ && options_.is_late()) return;
    const std::vector<FitParameter> first = with_usual_discrepancy(held);
    FitPosterior of_first(experiment_, first, hypothesis_);
    // Only the basin matters here, not its optimum.
    FitOptions of_basin = options_;
    of_basin.to_beat = to_beat;
    of_basin.tolerance = 1.;
    OptimiserState state = best_start(of_first, first, starts, of_basin);
    optimise(of_first, first, state, n_held_iterations, of_basin);
    state.ended = false;
    state.derivatives.reset();
    go_on(std::move(state));
  }

  void go_on(OptimiserState state) {
    // A start that stays hopelessly below a previous one is given up.
    FitOptions of_all = options_;
    if (best_) of_all.to_beat = std::max(of_all.to_beat, best_->log_posterior);
    optimise(posterior_, fit_parameters_, state, options_.max_iterations, of_all,
             best_ ? &*best_ : nullptr);
    if (!best_ || state.log_posterior > best_->log_posterior) best_ = std::move(state);
  }

  const Experiment& experiment_;
  const Hypothesis& hypothesis_;
  const std::vector<FitParameter>& fit_parameters_;
  const FitOptions& options_;
  FitPosterior posterior_;
  std::optional<OptimiserState> best_;
};

/// The optimum of a fit of the same hypothesis, with the parameters held that are held now; nothing
/// where this costs more than a few nats by the quadratic approximation: then the optimum may be
/// far.
std::optional<Eigen::VectorXd> near_start(const Hypothesis& hypothesis,
                                          const std::vector<FitParameter>& fit_parameters,
                                          const HypothesisFit* start, const FitOptions& options) {
  constexpr double few_nats = 5.;
  if (start == nullptr || options.nominal.empty() || start->hypothesis.name() != hypothesis.name())
    return std::nullopt;
  Eigen::VectorXd x = start->x;
  clamp(fit_parameters, x);
  const Eigen::VectorXd way = x - start->x;
  return 0.5 * way.dot(start->information * way) < few_nats ? std::optional(x) : std::nullopt;
}

}  // namespace

std::optional<std::size_t> HypothesisFit::index(const std::string& effect,
                                                const std::size_t parameter) const {
  for (std::size_t i = 0; i < fit_parameters.size(); ++i)
    if (fit_parameters[i].effect != nullptr && fit_parameters[i].effect->id == effect &&
        fit_parameters[i].parameter == parameter)
      return i;
  return std::nullopt;
}

std::vector<const Effect*> HypothesisFit::changes() const {
  std::vector<const Effect*> out;
  for (const FitParameter& parameter : fit_parameters)
    if (parameter.effect != nullptr && parameter.parameter == 0) out.push_back(parameter.effect);
  return out;
}

std::vector<std::string> HypothesisFit::nominal_calibrations() const {
  std::vector<std::string> out;
  for (const FitParameter& parameter : fit_parameters)
    if (parameter.nuisance && parameter.parameter == 0 && parameter.description.prior.is_fixed())
      out.push_back(parameter.effect->id);
  return out;
}

Chain HypothesisFit::chain(const Experiment& experiment) const {
  return make_chain(experiment, fit_parameters, x);
}

bool has_recalibrated(const HypothesisFit& fit) {
  for (std::size_t i = n_common_parameters; i < fit.fit_parameters.size(); ++i) {
    const Prior& prior = fit.fit_parameters[i].description.prior;
    const double moved = fit.x(static_cast<Eigen::Index>(i)) - prior.centre;
    if (fit.fit_parameters[i].nuisance && std::abs(moved) > prior.scale) return true;
  }
  return false;
}

HypothesisFit fit_hypothesis(const Experiment& experiment, const Hypothesis& hypothesis,
                             const HypothesisFit* start, const FitOptions& options,
                             const std::optional<FurtherStart>& further) {
  HypothesisFit fit;
  fit.hypothesis = hypothesis;
  fit.fit_parameters =
      with_nominal(make_fit_parameters(experiment, hypothesis), [&](const std::string& id) {
        return std::ranges::find(options.nominal, id) != options.nominal.end();
      });
  Attempts attempts(experiment, hypothesis, fit.fit_parameters, options);
  const std::vector<Eigen::VectorXd> nominal =
      start_vectors(experiment, fit.fit_parameters, hypothesis, start, /*nominal_nuisances=*/true);
  if (const auto x = near_start(hypothesis, fit.fit_parameters, start, options)) {
    attempts.from_near(*x);
  } else if (start != nullptr) {
    auto starts = start_vectors(experiment, fit.fit_parameters, hypothesis, start, false);
    if (further) starts.push_back(further_start(experiment, fit.fit_parameters, *further));
    attempts.from(starts);
  } else {
    attempts.from(with_shifted_resonances(experiment, fit.fit_parameters, hypothesis, nominal));
  }
  // A narrow resonance far from where it is measured tells a fit little. A start with effects has
  // been moved there.
  const bool is_moved = start != nullptr && !start->hypothesis.effects().empty();
  if (!is_moved && moves_in_responses(experiment, hypothesis))
    if (const auto measured = at_measured_modes(experiment, fit.fit_parameters,
                                                effect_on_resonance(hypothesis), nominal);
        !measured.empty())
      attempts.from_searched(measured);
  // Calibration parameters may absorb an effect: the other basins of attraction are reached with
  // them held.
  const bool is_refit = start != nullptr && start->hypothesis.name() == hypothesis.name();
  if (start != nullptr && has_recalibrated(*start) && !is_refit)
    attempts.from_nominal(
        hypothesis.contains("mass")
            ? with_shifted_resonances(experiment, fit.fit_parameters, hypothesis, nominal)
            : nominal);
  if (start == nullptr && !hypothesis.effects().empty()) attempts.from_nominal(nominal);
  set_at(fit, experiment, attempts.posterior(), attempts.best());
  return fit;
}

HypothesisFit fit_as_simulated(const Experiment& experiment) {
  HypothesisFit fit;
  fit.fit_parameters = make_fit_parameters(experiment, fit.hypothesis);
  const std::vector<FitParameter> held = with_nominal_calibrations(fit.fit_parameters);
  FitPosterior of_held(experiment, held, fit.hypothesis);
  OptimiserState state =
      best_start(of_held, held, start_vectors(experiment, held, fit.hypothesis, nullptr, true), {});
  optimise(of_held, held, state, n_held_iterations, {});
  state.derivatives.reset();
  FitPosterior posterior(experiment, fit.fit_parameters, fit.hypothesis);
  set_at(fit, experiment, posterior, state);
  return fit;
}

double error_left(const PreparedRecord& record, const FittedRecord& fitted) {
  double noise = 0.;
  for (const double variance : fitted.noise) noise += variance;
  return (total_power(difference(record.moment, fitted.mean)) - noise) / total_power(record.moment);
}

double largest_error_left(const Experiment& experiment, const HypothesisFit& fit,
                          const std::optional<std::size_t> but_one) {
  double most = 0.;
  for (std::size_t r = 0; r < experiment.records.size(); ++r)
    if (r != but_one && !experiment.records[r].is_still())
      most = std::max(most, error_left(experiment.records[r], fit.records[r]));
  return most;
}

std::vector<WhitenedRecord> whitened_residual(const Experiment& experiment,
                                              const HypothesisFit& fit) {
  std::vector<WhitenedRecord> records(fit.records.size());
  for (std::size_t r = 0; r < records.size(); ++r) {
    const FittedRecord& fitted = fit.records[r];
    std::vector<Complex> error = difference(experiment.records[r].moment, fitted.mean);
    IntegratedNuisances(fitted.unknowns, error, fitted.variance).remove_from(error);
    error = difference(error, fitted.discrepancy);
    for (std::size_t b = 0; b < error.size(); ++b) {
      const double deviation = std::sqrt(fitted.variance[b]);
      records[r].deviation.push_back(deviation);
      records[r].error.push_back(error[b] / deviation);
    }
  }
  return records;
}

}  // namespace vibrissa::diagnosis
