#include "diagnosis/fit/hypothesis_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/fit/calibration_choices.h"
#include "diagnosis/fit/fit_posterior.h"
#include "diagnosis/fit/optimiser.h"
#include "diagnosis/prediction/record_nuisances.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// Starting coordinates: noise levels as estimated, nuisances nominal or from start, effects at one
/// of their own starts or from start.
Eigen::VectorXd start_vector(const Experiment& experiment,
                             const std::vector<FitParameter>& fit_parameters,
                             const HypothesisFit* start, bool nominal_nuisances) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(fit_parameters.size()));
  x(index_of_moment_noise) = std::log(experiment.moment_noise);
  x(index_of_acceleration_noise) = std::log(experiment.acceleration_noise);
  x(index_of_joint_share) = experiment.nominal.joint_share;
  x(index_of_joint_loss) = 1.;
  if (start != nullptr)
    x.head(nominal_nuisances ? n_noise_parameters : n_common_parameters) =
        start->x.head(nominal_nuisances ? n_noise_parameters : n_common_parameters);
  for (std::size_t i = n_common_parameters; i < fit_parameters.size(); ++i) {
    const FitParameter& fit_parameter = fit_parameters[i];
    double& value = x(static_cast<Eigen::Index>(i));
    if (fit_parameter.effect == nullptr) {
      // The share of model form errors begins at a fifth, discrepancies at two percent.
      value = fit_parameter.description.logarithmic ? std::log(0.02) : 0.2;
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
        for (std::size_t i = 0; i < fit_parameters.size(); ++i)
          if (fit_parameters[i].effect == effect)
            more.back()(static_cast<Eigen::Index>(i)) =
                fit_parameters[i].description.coordinate(values[fit_parameters[i].parameter]);
        clamp(fit_parameters, more.back());
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
  for (std::size_t i = 0; i < fit_parameters.size(); ++i)
    if (fit_parameters[i].effect == further.effect)
      x(static_cast<Eigen::Index>(i)) =
          fit_parameters[i].description.coordinate(further.values[fit_parameters[i].parameter]);
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

/// The fit of each record.
std::vector<FormErrors> model_form_errors_of(const std::vector<EffectAction>& actions,
                                             const std::vector<Prediction>& predictions) {
  std::vector<FormErrors> out;
  for (const Prediction& prediction : predictions) {
    const std::vector<double> zero(prediction.mean.size(), 0.);
    out.push_back({zero, zero});
  }
  for (const EffectAction& action : actions) {
    const bool nonlinear = is_nonlinear(*action.effect);
    for (std::size_t r = 0; r < out.size(); ++r) {
      const std::vector<double> power = model_form_error_power(*action.effect, action.change[r]);
      std::vector<double>& sum = nonlinear ? out[r].nonlinear : out[r].linear;
      for (std::size_t b = 0; b < power.size(); ++b) sum[b] += power[b];
    }
  }
  return out;
}

std::vector<FittedRecord> fitted_records(const Experiment& experiment,
                                         const FitPosterior& posterior, const HypothesisFit& fit,
                                         const std::vector<Prediction>& predictions,
                                         const std::vector<EffectAction>& actions) {
  const double a_variance = posterior.acceleration_variance(fit.x);
  const double a_excess = fit.chain(experiment).reference_variance;
  std::vector<FormErrors> model_form_errors = model_form_errors_of(actions, predictions);
  std::vector<FittedRecord> records;
  for (std::size_t r = 0; r < predictions.size(); ++r) {
    FittedRecord record{.mean = predictions[r].mean,
                        .process_noise = predictions[r].process_noise,
                        .variance = posterior.variance(fit.x, predictions[r], r, a_variance),
                        .unknowns = predictions[r].unknowns,
                        .model_form_errors = std::move(model_form_errors[r])};
    for (std::size_t b = 0; b < record.process_noise.size(); ++b)
      record.process_noise[b] += a_excess * predictions[r].acceleration_noise[b];
    records.push_back(std::move(record));
  }
  return records;
}

/// Is a nuisance of the fit outside its tolerance?
bool has_recalibrated(const HypothesisFit& fit) {
  for (std::size_t i = n_common_parameters; i < fit.fit_parameters.size(); ++i) {
    const Prior& prior = fit.fit_parameters[i].description.prior;
    const double moved = fit.x(static_cast<Eigen::Index>(i)) - prior.centre;
    if (fit.fit_parameters[i].nuisance && std::abs(moved) > prior.scale) return true;
  }
  return false;
}

/// Parameters with the nuisances fixed at their nominal values.
std::vector<FitParameter> with_nominal_calibrations(std::vector<FitParameter> fit_parameters) {
  for (FitParameter& fit_parameter : fit_parameters)
    if (fit_parameter.nuisance) {
      Prior& prior = fit_parameter.description.prior;
      prior.low = prior.high = prior.centre;
    }
  return fit_parameters;
}

/// Optimises the other parameters first and the nuisances afterwards.
OptimiserState optimise_before_nuisances(FitPosterior& posterior, const Experiment& experiment,
                                         const std::vector<FitParameter>& fit_parameters,
                                         const Hypothesis& hypothesis, const HypothesisFit* start,
                                         const FitOptions& options) {
  constexpr int n_alone = 12;
  const std::vector<FitParameter> held = with_nominal_calibrations(fit_parameters);
  FitPosterior posterior_of_held(experiment, held, hypothesis);
  OptimiserState state =
      best_start(posterior_of_held, held,
                 start_vectors(experiment, fit_parameters, hypothesis, start, true), options);
  optimise(posterior_of_held, held, state, n_alone, options);
  state.ended = false;
  state.derivatives.reset();
  optimise(posterior, fit_parameters, state, n_alone, options);
  return state;
}

/// Limits calibration ratios to negligible values, and fixes their other parameters.
std::vector<FitParameter> with_negligible_calibrations(const NominalModel& nominal,
                                                       std::vector<FitParameter> fit_parameters) {
  for (FitParameter& fit_parameter : fit_parameters) {
    if (!fit_parameter.nuisance) continue;
    Prior& prior = fit_parameter.description.prior;
    if (fit_parameter.parameter == 0)
      prior.scale = negligible_calibration(nominal, fit_parameter.effect->id);
    else
      prior = {.kind = Prior::Kind::normal,
               .centre = prior.centre,
               .low = prior.centre,
               .high = prior.centre};
  }
  return fit_parameters;
}

/// Widens the calibration priors to the shifts that model form errors may cause. Returns whether
/// any prior was much too narrow.
bool loosen_by_forms(HypothesisFit& fit) {
  constexpr double much = 1.5;
  bool was_narrow = false;
  for (const Eigen::Index i : calibrations_but(fit, {})) {
    FitParameter& fit_parameter = fit.fit_parameters[static_cast<std::size_t>(i)];
    double& scale = fit_parameter.description.prior.scale;
    const double of_data = fit.information(i, i) - 1. / (scale * scale);
    if (!(of_data > 0.)) continue;
    const double wider =
        std::sqrt(scale * scale + fit.shift_by_forms(fit_parameter.effect, of_data));
    was_narrow |= wider > much * scale;
    scale = wider;
  }
  return was_narrow;
}

/// Sets all results of a fit at its optimum, except the choices.
void set_at(HypothesisFit& fit, const Experiment& experiment, FitPosterior& posterior,
            OptimiserState& state) {
  fit.x = state.x;
  fit.n_iterations = state.n_iterations;
  fit.log_posterior = state.log_posterior;
  posterior.update_slow_variance(fit.x, state.predictions);
  if (!state.derivatives) state.derivatives = posterior.derivatives(fit.x, state.predictions);
  Eigen::VectorXd gradient;
  posterior.linearise(fit.x, state.predictions, *state.derivatives, gradient, fit.information);
  const std::vector<EffectAction> actions = posterior.actions(fit.x, state.predictions);
  fit.effect_energy.clear();
  for (const EffectAction& action : actions)
    fit.effect_energy.emplace_back(action.effect, action.energy);
  double log_determinant = 0.;
  fit.covariance = inverse(fit.information, log_determinant);
  fit.log_likelihood = posterior.log_likelihood(fit.x, state.predictions);
  fit.log_evidence = fit.log_likelihood + posterior.log_prior(fit.x) - 0.5 * log_determinant +
                     0.5 * static_cast<double>(fit.x.size()) * std::log(2. * std::numbers::pi);
  if (!std::isfinite(fit.log_evidence)) fit.log_evidence = -std::numeric_limits<double>::infinity();
  fit.records = fitted_records(experiment, posterior, fit, state.predictions, actions);
  fit.goodness = goodness_of_fit(experiment, whitened_residual(experiment, fit));
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

double HypothesisFit::form_energy(const Effect* but) const {
  double sum = 0.;
  for (const auto& [effect, energy] : effect_energy)
    if (effect != but) sum += effect->model_form_error * effect->model_form_error * energy;
  return sum;
}

double HypothesisFit::shift_by_forms(const Effect* calibration, const double information) const {
  return 0.5 * form_energy(calibration) / information;
}

Chain HypothesisFit::chain(const Experiment& experiment) const {
  return make_chain(experiment, fit_parameters, x);
}

HypothesisFit fit_hypothesis(const Experiment& experiment, const Hypothesis& hypothesis,
                             const HypothesisFit* start, const FitOptions& options,
                             const std::optional<FurtherStart>& further) {
  HypothesisFit fit;
  fit.hypothesis = hypothesis;
  fit.fit_parameters = make_fit_parameters(experiment, hypothesis);
  FitPosterior posterior(experiment, fit.fit_parameters, fit.hypothesis);
  const auto optimise_from = [&](bool nominal_nuisances) {
    return best_start(
        posterior, fit.fit_parameters,
        start_vectors(experiment, fit.fit_parameters, hypothesis, start, nominal_nuisances),
        options);
  };
  OptimiserState state = optimise_from(start == nullptr);
  // Calibration parameters of another fit may have absorbed the effect, so both basins are tried.
  if (start != nullptr && options.n_promising > 1 && has_recalibrated(*start)) {
    OptimiserState other = optimise_from(true);
    if (other.log_posterior > state.log_posterior) state = std::move(other);
  }
  // A calibration effect is aliased with the nuisances: when they absorb its influence, it stays
  // near zero. Combined with other effects it would absorb what none of them explains.
  const auto& effects = hypothesis.effects();
  if (effects.size() == 1 && effects.front()->calibration) {
    OptimiserState other = optimise_before_nuisances(posterior, experiment, fit.fit_parameters,
                                                     hypothesis, start, options);
    if (other.log_posterior > state.log_posterior) state = std::move(other);
  }
  if (further) {
    OptimiserState other =
        best_start(posterior, fit.fit_parameters,
                   {further_start(experiment, fit.fit_parameters, *further)}, options);
    // The noise levels are those of a fit without the effect, so more iterations are needed.
    for (OptimiserState* c : {&state, &other})
      optimise(posterior, fit.fit_parameters, *c, options.max_iterations, options);
    if (other.log_posterior > state.log_posterior) state = std::move(other);
  }
  optimise(posterior, fit.fit_parameters, state, options.max_iterations, options);
  set_at(fit, experiment, posterior, state);
  fit.choices = calibration_choices(experiment.nominal, fit);
  return fit;
}

HypothesisFit fit_as_simulated(const Experiment& experiment, const HypothesisFit& free,
                               const FitOptions& options) {
  constexpr int n_with_calibrations = 5;
  HypothesisFit fit;
  fit.hypothesis = free.hypothesis;
  fit.as_simulated = true;
  const std::vector<FitParameter> held = with_nominal_calibrations(free.fit_parameters);
  FitPosterior of_held(experiment, held, fit.hypothesis);
  std::vector<Eigen::VectorXd> starts =
      start_vectors(experiment, held, fit.hypothesis, nullptr, true);
  for (Eigen::VectorXd& x : starts) x.head(n_noise_parameters) = free.x.head(n_noise_parameters);
  starts.push_back(free.x);
  clamp(held, starts.back());
  OptimiserState state = best_start(of_held, held, starts, options);
  optimise(of_held, held, state, options.max_iterations, options);
  fit.fit_parameters = with_negligible_calibrations(experiment.nominal, free.fit_parameters);
  bool ends = false;
  for (int pass = 0; pass < 2 && !ends; ++pass) {
    FitPosterior posterior(experiment, fit.fit_parameters, fit.hypothesis);
    state.derivatives.reset();
    state.ended = false;
    optimise(posterior, fit.fit_parameters, state, n_with_calibrations, options);
    set_at(fit, experiment, posterior, state);
    ends = pass > 0 || !loosen_by_forms(fit);
  }
  fit.choices = {as_simulated_choice(fit)};
  return fit;
}

std::vector<WhitenedRecord> whitened_residual(const Experiment& experiment,
                                              const HypothesisFit& fit) {
  std::vector<WhitenedRecord> records(fit.records.size());
  for (std::size_t r = 0; r < records.size(); ++r) {
    const FittedRecord& fitted = fit.records[r];
    std::vector<Complex> error = difference(experiment.records[r].moment, fitted.mean);
    IntegratedNuisances(fitted.unknowns, error, fitted.variance).remove_from(error);
    for (std::size_t b = 0; b < error.size(); ++b) {
      const double deviation = std::sqrt(fitted.variance[b]);
      records[r].deviation.push_back(deviation);
      records[r].error.push_back(error[b] / deviation);
      records[r].own_share.push_back(fitted.process_noise[b] / fitted.variance[b]);
    }
  }
  return records;
}

}  // namespace vibrissa::diagnosis
