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

/// Coordinates to start from: noise as guessed, nuisances nominal or as in start, effects at one of
/// their own starts or as in start.
Eigen::VectorXd start_vector(const Experiment& experiment, const std::vector<FreeFigure>& figures,
                             const HypothesisFit* start, bool nominal_nuisances) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(figures.size()));
  x(place_moment_noise) = std::log(experiment.moment_noise);
  x(place_acceleration_noise) = std::log(experiment.acceleration_noise);
  x(place_joint_share) = experiment.nominal.joint_share;
  x(place_joint_loss) = 1.;
  if (start != nullptr)
    x.head(nominal_nuisances ? n_noise_figures : n_own_figures) =
        start->x.head(nominal_nuisances ? n_noise_figures : n_own_figures);
  for (std::size_t i = n_own_figures; i < figures.size(); ++i) {
    const FreeFigure& figure = figures[i];
    double& value = x(static_cast<Eigen::Index>(i));
    if (figure.effect == nullptr) {
      // Form errors begin at a fifth of their bound, discrepancies at two percent.
      value = figure.description.logarithmic ? std::log(0.02) : 0.2;
      continue;
    }
    const double at = figure.effect->starts.front()[figure.parameter];
    value = figure.nuisance ? figure.description.prior.centre : figure.description.coordinate(at);
    if (start == nullptr || (figure.nuisance && nominal_nuisances)) continue;
    if (const auto place = start->place(figure.effect->id, figure.parameter))
      value = start->x(static_cast<Eigen::Index>(*place));
  }
  clamp(figures, x);
  return x;
}

/// All combinations of the starts of effects that the given start does not hold.
std::vector<Eigen::VectorXd> start_vectors(const Experiment& experiment,
                                           const std::vector<FreeFigure>& figures,
                                           const Hypothesis& hypothesis, const HypothesisFit* start,
                                           bool nominal_nuisances) {
  std::vector<Eigen::VectorXd> starts{start_vector(experiment, figures, start, nominal_nuisances)};
  for (const Effect* effect : hypothesis.effects()) {
    if (start != nullptr && start->hypothesis.contains(effect->id)) continue;
    std::vector<Eigen::VectorXd> more;
    for (const Eigen::VectorXd& x : starts)
      for (const std::vector<double>& values : effect->starts) {
        more.push_back(x);
        for (std::size_t i = 0; i < figures.size(); ++i)
          if (figures[i].effect == effect)
            more.back()(static_cast<Eigen::Index>(i)) =
                figures[i].description.coordinate(values[figures[i].parameter]);
        clamp(figures, more.back());
      }
    starts = std::move(more);
  }
  // What an effect says of the accelerometer's noise is not said twice.
  for (Eigen::VectorXd& x : starts)
    if (make_chain(experiment, figures, x).reference_variance > 0.)
      x(place_acceleration_noise) =
          std::min(x(place_acceleration_noise), std::log(usual_acceleration_noise));
  return starts;
}

Eigen::VectorXd further_start(const Experiment& experiment, const std::vector<FreeFigure>& figures,
                              const FurtherStart& further) {
  Eigen::VectorXd x = start_vector(experiment, figures, further.without, false);
  for (std::size_t i = 0; i < figures.size(); ++i)
    if (figures[i].effect == further.effect)
      x(static_cast<Eigen::Index>(i)) =
          figures[i].description.coordinate(further.values[figures[i].parameter]);
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

/// Of each record.
std::vector<FormErrors> form_errors_of(const std::vector<EffectAction>& actions,
                                       const std::vector<Prediction>& predictions) {
  std::vector<FormErrors> out;
  for (const Prediction& prediction : predictions) {
    const std::vector<double> zero(prediction.mean.size(), 0.);
    out.push_back({zero, zero});
  }
  for (const EffectAction& action : actions) {
    const bool nonlinear = is_nonlinear(*action.effect);
    for (std::size_t r = 0; r < out.size(); ++r) {
      const std::vector<double> power = form_error_power(*action.effect, action.change[r]);
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
  std::vector<FormErrors> form_errors = form_errors_of(actions, predictions);
  std::vector<FittedRecord> records;
  for (std::size_t r = 0; r < predictions.size(); ++r) {
    FittedRecord record{.mean = predictions[r].mean,
                        .own_noise = predictions[r].own_noise,
                        .variance = posterior.variance(fit.x, predictions[r], r, a_variance),
                        .unknowns = predictions[r].unknowns,
                        .form_errors = std::move(form_errors[r])};
    for (std::size_t b = 0; b < record.own_noise.size(); ++b)
      record.own_noise[b] += a_excess * predictions[r].acceleration_noise[b];
    records.push_back(std::move(record));
  }
  return records;
}

/// Has a fit moved a nuisance out of its tolerance?
bool has_retuned(const HypothesisFit& fit) {
  for (std::size_t i = n_own_figures; i < fit.figures.size(); ++i) {
    const Prior& prior = fit.figures[i].description.prior;
    const double moved = fit.x(static_cast<Eigen::Index>(i)) - prior.centre;
    if (fit.figures[i].nuisance && std::abs(moved) > prior.scale) return true;
  }
  return false;
}

/// Figures with the nuisances fixed where they are nominal.
std::vector<FreeFigure> with_nominal_retunes(std::vector<FreeFigure> figures) {
  for (FreeFigure& figure : figures)
    if (figure.nuisance) {
      Prior& prior = figure.description.prior;
      prior.low = prior.high = prior.centre;
    }
  return figures;
}

/// A climb on which the nuisances move last.
Climb climb_before_nuisances(FitPosterior& posterior, const Experiment& experiment,
                             const std::vector<FreeFigure>& figures, const Hypothesis& hypothesis,
                             const HypothesisFit* start, const FitOptions& options) {
  constexpr int n_alone = 12;
  const std::vector<FreeFigure> held = with_nominal_retunes(figures);
  FitPosterior posterior_of_held(experiment, held, hypothesis);
  Climb climb = best_start(posterior_of_held, held,
                           start_vectors(experiment, figures, hypothesis, start, true), options);
  climb_on(posterior_of_held, held, climb, n_alone, options);
  climb.ended = false;
  climb.derivatives.reset();
  climb_on(posterior, figures, climb, n_alone, options);
  return climb;
}

/// Retunes within what is negligible, and what they do beside their ratio left alone.
std::vector<FreeFigure> with_negligible_retunes(const NominalModel& nominal,
                                                std::vector<FreeFigure> figures) {
  for (FreeFigure& figure : figures) {
    if (!figure.nuisance) continue;
    Prior& prior = figure.description.prior;
    if (figure.parameter == 0)
      prior.scale = negligible_retune(nominal, figure.effect->id);
    else
      prior = {.kind = Prior::Kind::normal,
               .centre = prior.centre,
               .low = prior.centre,
               .high = prior.centre};
  }
  return figures;
}

/// The retunes' priors become as wide as form errors shift them. Was any much too narrow?
bool loosen_by_forms(HypothesisFit& fit) {
  constexpr double much = 1.5;
  bool was_narrow = false;
  for (const Eigen::Index i : retunes_but(fit, {})) {
    FreeFigure& figure = fit.figures[static_cast<std::size_t>(i)];
    double& scale = figure.description.prior.scale;
    const double of_data = fit.information(i, i) - 1. / (scale * scale);
    if (!(of_data > 0.)) continue;
    const double wider = std::sqrt(scale * scale + fit.shift_by_forms(figure.effect, of_data));
    was_narrow |= wider > much * scale;
    scale = wider;
  }
  return was_narrow;
}

/// What a fit is where its climb has ended; the choices are left.
void set_at(HypothesisFit& fit, const Experiment& experiment, FitPosterior& posterior,
            Climb& climb) {
  fit.x = climb.x;
  fit.n_iterations = climb.n_iterations;
  fit.log_posterior = climb.log_posterior;
  posterior.renew_slow_variance(fit.x, climb.predictions);
  if (!climb.derivatives) climb.derivatives = posterior.derivatives(fit.x, climb.predictions);
  Eigen::VectorXd gradient;
  posterior.linearise(fit.x, climb.predictions, *climb.derivatives, gradient, fit.information);
  const std::vector<EffectAction> actions = posterior.actions(fit.x, climb.predictions);
  fit.effect_energy.clear();
  for (const EffectAction& action : actions)
    fit.effect_energy.emplace_back(action.effect, action.energy);
  double log_determinant = 0.;
  fit.covariance = inverse(fit.information, log_determinant);
  fit.log_likelihood = posterior.log_likelihood(fit.x, climb.predictions);
  fit.log_evidence = fit.log_likelihood + posterior.log_prior(fit.x) - 0.5 * log_determinant +
                     0.5 * static_cast<double>(fit.x.size()) * std::log(2. * std::numbers::pi);
  if (!std::isfinite(fit.log_evidence)) fit.log_evidence = -std::numeric_limits<double>::infinity();
  fit.records = fitted_records(experiment, posterior, fit, climb.predictions, actions);
  fit.goodness = goodness_of_fit(experiment, whitened_residual(experiment, fit));
}

}  // namespace

std::optional<std::size_t> HypothesisFit::place(const std::string& effect,
                                                const std::size_t parameter) const {
  for (std::size_t i = 0; i < figures.size(); ++i)
    if (figures[i].effect != nullptr && figures[i].effect->id == effect &&
        figures[i].parameter == parameter)
      return i;
  return std::nullopt;
}

double HypothesisFit::form_energy(const Effect* but) const {
  double sum = 0.;
  for (const auto& [effect, energy] : effect_energy)
    if (effect != but) sum += effect->form_error * effect->form_error * energy;
  return sum;
}

double HypothesisFit::shift_by_forms(const Effect* retune, const double information) const {
  return 0.5 * form_energy(retune) / information;
}

Chain HypothesisFit::chain(const Experiment& experiment) const {
  return make_chain(experiment, figures, x);
}

HypothesisFit fit_hypothesis(const Experiment& experiment, const Hypothesis& hypothesis,
                             const HypothesisFit* start, const FitOptions& options,
                             const std::optional<FurtherStart>& further) {
  HypothesisFit fit;
  fit.hypothesis = hypothesis;
  fit.figures = make_figures(experiment, hypothesis);
  FitPosterior posterior(experiment, fit.figures, fit.hypothesis);
  const auto climb_from = [&](bool nominal_nuisances) {
    return best_start(posterior, fit.figures,
                      start_vectors(experiment, fit.figures, hypothesis, start, nominal_nuisances),
                      options);
  };
  Climb climb = climb_from(start == nullptr);
  // Retunes of another fit may have taken up what an effect does: both basins are looked at.
  if (start != nullptr && options.n_promising > 1 && has_retuned(*start)) {
    Climb other = climb_from(true);
    if (other.log_posterior > climb.log_posterior) climb = std::move(other);
  }
  // An effect that recalibrates, as nuisances do, is aliased with them: where they take up what it
  // does, it stays near nothing. Beside others it would take up what none of them explains.
  const auto& effects = hypothesis.effects();
  if (effects.size() == 1 && effects.front()->retune) {
    Climb other =
        climb_before_nuisances(posterior, experiment, fit.figures, hypothesis, start, options);
    if (other.log_posterior > climb.log_posterior) climb = std::move(other);
  }
  if (further) {
    Climb other = best_start(posterior, fit.figures,
                             {further_start(experiment, fit.figures, *further)}, options);
    // Its noise levels are those of a fit without the effect: it takes longer to show its worth.
    for (Climb* c : {&climb, &other})
      climb_on(posterior, fit.figures, *c, options.max_iterations, options);
    if (other.log_posterior > climb.log_posterior) climb = std::move(other);
  }
  climb_on(posterior, fit.figures, climb, options.max_iterations, options);
  set_at(fit, experiment, posterior, climb);
  fit.choices = retune_choices(experiment.nominal, fit);
  return fit;
}

HypothesisFit fit_as_simulated(const Experiment& experiment, const HypothesisFit& free,
                               const FitOptions& options) {
  constexpr int n_with_retunes = 5;
  HypothesisFit fit;
  fit.hypothesis = free.hypothesis;
  fit.as_simulated = true;
  const std::vector<FreeFigure> held = with_nominal_retunes(free.figures);
  FitPosterior of_held(experiment, held, fit.hypothesis);
  std::vector<Eigen::VectorXd> starts =
      start_vectors(experiment, held, fit.hypothesis, nullptr, true);
  for (Eigen::VectorXd& x : starts) x.head(n_noise_figures) = free.x.head(n_noise_figures);
  starts.push_back(free.x);
  clamp(held, starts.back());
  Climb climb = best_start(of_held, held, starts, options);
  climb_on(of_held, held, climb, options.max_iterations, options);
  fit.figures = with_negligible_retunes(experiment.nominal, free.figures);
  bool ends = false;
  for (int pass = 0; pass < 2 && !ends; ++pass) {
    FitPosterior posterior(experiment, fit.figures, fit.hypothesis);
    climb.derivatives.reset();
    climb.ended = false;
    climb_on(posterior, fit.figures, climb, n_with_retunes, options);
    set_at(fit, experiment, posterior, climb);
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
    IntegratedUnknowns(fitted.unknowns, error, fitted.variance).remove_from(error);
    for (std::size_t b = 0; b < error.size(); ++b) {
      const double deviation = std::sqrt(fitted.variance[b]);
      records[r].deviation.push_back(deviation);
      records[r].error.push_back(error[b] / deviation);
      records[r].own_share.push_back(fitted.own_noise[b] / fitted.variance[b]);
    }
  }
  return records;
}

}  // namespace vibrissa::diagnosis
