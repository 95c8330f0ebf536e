#include "diagnosis/fit/fit_posterior.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "diagnosis/prediction/record_nuisances.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// Relative misfit of the nominal model that is always assumed.
constexpr double least_misfit = 1e-4;

/// A half at its own frequencies, a half at all: another law of the same size changes the same
/// frequencies in another way, and puts as much at other ones.
std::vector<double> spread_out(std::vector<double> power) {
  const double mean =
      std::accumulate(power.begin(), power.end(), 0.) / static_cast<double>(power.size());
  for (double& value : power) value = 0.5 * (value + mean);
  return power;
}

/// Density of flicker noise at a bin relative to white noise.
double flicker_at(const PreparedRecord& record, const std::size_t b, const Eigen::VectorXd& x) {
  return std::exp(x(index_of_flicker)) / (record.frequency_hz(b));
}

double nominal_misfit(const NominalModel& nominal, const PreparedRecord& record) {
  const double misfit = record.excitation.wind ? nominal.wind_misfit : nominal.base_misfit;
  return std::max(misfit, least_misfit);
}

/// Negative log likelihood of the accelerometer's readings at rest.
double accelerometer_term(const PreparedRecord& record, double variance) {
  if (record.n_acceleration_noise == 0) return 0.;
  return record.acceleration_noise_power / (static_cast<double>(record.n_samples) * variance) +
         static_cast<double>(record.n_acceleration_noise) * std::log(variance);
}

Eigen::Index count(const std::vector<IntegratedNuisances>& nuisances) {
  Eigen::Index n = 0;
  for (const IntegratedNuisances& of_record : nuisances) n += of_record.size();
  return n;
}

DiscrepancyLevels levels(const Eigen::VectorXd& x, const double form_level) {
  DiscrepancyLevels out{};
  for (std::size_t i = 0; i < n_discrepancy_levels; ++i)
    out[i] = std::exp(x(static_cast<Eigen::Index>(index_of_discrepancy + i)));
  out[index_of_form_level] = form_level;
  return out;
}

}  // namespace

FitPosterior::FitPosterior(const Experiment& experiment,
                           const std::vector<FitParameter>& fit_parameters,
                           const Hypothesis& hypothesis)
    : experiment_(experiment),
      fit_parameters_(fit_parameters),
      effects_(hypothesis.effects()),
      unknown_(hypothesis.is_discrepancy()),
      discrepancy_(experiment) {
  for (std::size_t i = 0; i < fit_parameters.size(); ++i) {
    if (fit_parameters[i].description.prior.is_fixed()) continue;
    const auto index = static_cast<Eigen::Index>(i);
    if (fit_parameters[i].effect != nullptr || i == index_of_joint_share ||
        i == index_of_joint_loss || i == index_of_higher_joint_share)
      of_chain_.push_back(index);
    else
      levels_.push_back(index);
  }
}

std::vector<Prediction> FitPosterior::predict(const Eigen::VectorXd& x) const {
  assert(x.allFinite());
  const Chain chain = make_chain(experiment_, fit_parameters_, x);
  return ChainSimulator(chain).predict(experiment_.records);
}

Eigen::VectorXcd FitPosterior::change_by(const Effect& effect, const Eigen::VectorXd& x,
                                         const Eigen::VectorXcd& mean) const {
  const Chain without = make_chain(experiment_, fit_parameters_, x, &effect);
  Eigen::VectorXcd out = mean;
  Eigen::Index row = 0;
  for (const std::vector<Complex>& there : ChainSimulator(without).means(experiment_.records))
    for (const Complex& value : there) out(row++) -= value;
  return effect.model_form_error * out;
}

/// The form error of an effect is a term of the discrepancy. A part of that of a nonlinear one
/// differs from record to record and from bin to bin.
void FitPosterior::update_slow_variance(const Eigen::VectorXd& x,
                                        const std::vector<Prediction>& at) {
  for (BinVariances* parts : {&misfit_, &power_, &incoherent_, &form_}) parts->clear();
  const auto n_effects = static_cast<Eigen::Index>(effects_.size());
  DiscrepancyShapes shapes{.mean = Eigen::VectorXcd(discrepancy_.n_rows()),
                           .changes = Eigen::MatrixXcd(discrepancy_.n_rows(), n_effects)};
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < at.size(); ++r) {
    const PreparedRecord& record = experiment_.records[r];
    power_.push_back(neighbour_mean(powers(at[r].mean), power_reach));
    const double share = nominal_misfit(experiment_.nominal, record);
    misfit_.push_back(power_.back());
    for (double& value : misfit_.back()) value *= share * share;
    incoherent_.push_back(spread_out(power_.back()));
    form_.emplace_back(record.n_bins(), 0.);
    for (const Complex& mean : at[r].mean) shapes.mean(row++) = mean;
  }
  for (Eigen::Index i = 0; i < n_effects; ++i) {
    const Effect& effect = *effects_[static_cast<std::size_t>(i)];
    const Eigen::VectorXcd change = change_by(effect, x, shapes.mean);
    shapes.changes.col(i) = change;
    if (!is_nonlinear(effect)) continue;
    row = 0;
    for (std::vector<double>& form : form_) {
      const std::vector<double> power = spread_out(
          neighbour_mean(powers(std::span(change.data() + row, form.size())), power_reach));
      for (std::size_t b = 0; b < form.size(); ++b) form[b] += power[b];
      row += static_cast<Eigen::Index>(form.size());
    }
  }
  discrepancy_.set_shapes(std::move(shapes));
}

double FitPosterior::acceleration_variance(const Eigen::VectorXd& x, const Chain& chain) const {
  return std::exp(2. * x(index_of_acceleration_noise)) + chain.reference_variance;
}

double FitPosterior::acceleration_variance(const Eigen::VectorXd& x) const {
  return acceleration_variance(x, make_chain(experiment_, fit_parameters_, x));
}

Eigen::Index FitPosterior::unknown_index(std::size_t record, std::size_t b) const {
  const double ratio = 2. * std::numbers::pi * experiment_.records[record].frequency_hz(b) /
                       experiment_.scales.first_mode_rad_s;
  return static_cast<Eigen::Index>(fit_parameters_.size() - n_unknown_bands() +
                                   unknown_band(ratio));
}

std::vector<double> FitPosterior::variance(const Eigen::VectorXd& x, const Prediction& prediction,
                                           std::size_t record, double acceleration_variance) const {
  const double moment = std::exp(2. * x(index_of_moment_noise)),
               incoherent = std::exp(2. * x(index_of_incoherence)), level = form_level(x);
  std::vector<double> out(prediction.mean.size());
  for (std::size_t b = 0; b < out.size(); ++b) {
    out[b] =
        moment * (1. + flicker_at(experiment_.records[record], b, x)) * prediction.moment_noise[b] +
        acceleration_variance * prediction.acceleration_noise[b] + prediction.process_noise[b] +
        misfit_[record][b] + incoherent * incoherent_[record][b] + level * level * form_[record][b];
    if (!unknown_) continue;
    const double share = std::exp(x(unknown_index(record, b)));
    out[b] += share * share * power_[record][b];
  }
  return out;
}

FitPosterior::WhitenedErrors FitPosterior::whitened_errors(const std::vector<Prediction>& at,
                                                           const BinVariances& s) const {
  WhitenedErrors out{Eigen::VectorXcd(discrepancy_.n_rows()),
                     Eigen::VectorXd(discrepancy_.n_rows()), nuisances_of(at, s)};
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < at.size(); ++r) {
    std::vector<Complex> error = difference(experiment_.records[r].moment, at[r].mean);
    out.nuisances[r].remove_from(error);
    for (std::size_t b = 0; b < error.size(); ++b, ++row) {
      out.per_deviation(row) = 1. / std::sqrt(s[r][b]);
      out.error(row) = error[b] * out.per_deviation(row);
    }
  }
  return out;
}

FitPosterior::WhitenedErrors FitPosterior::whitened_errors(
    const Eigen::VectorXd& x, const std::vector<Prediction>& at) const {
  return whitened_errors(at, variances(x, at, acceleration_variance(x)));
}

ModelDiscrepancy::Solution FitPosterior::discrepancy(const Eigen::VectorXd& x,
                                                     const WhitenedErrors& whitened) const {
  return discrepancy_.solve(whitened.error, whitened.per_deviation, levels(x, form_level(x)));
}

double FitPosterior::log_likelihood(const Eigen::VectorXd& x,
                                    const std::vector<Prediction>& at) const {
  const double a_variance = acceleration_variance(x);
  const BinVariances s = variances(x, at, a_variance);
  const WhitenedErrors errors = whitened_errors(at, s);
  double sum = 0.;
  for (std::size_t r = 0; r < at.size(); ++r) {
    const std::vector<Complex> error = difference(experiment_.records[r].moment, at[r].mean);
    for (std::size_t b = 0; b < s[r].size(); ++b)
      sum -= std::norm(error[b]) / s[r][b] + std::log(s[r][b]);
    sum += errors.nuisances[r].log_likelihood_gain() -
           accelerometer_term(experiment_.records[r], a_variance);
  }
  sum += discrepancy(x, errors).log_likelihood_gain();
  return std::isfinite(sum) ? sum : -std::numeric_limits<double>::infinity();
}

double FitPosterior::log_prior(const Eigen::VectorXd& x) const {
  double sum = 0.;
  for (std::size_t i = 0; i < fit_parameters_.size(); ++i)
    sum += fit_parameters_[i].description.prior.log_density(x(static_cast<Eigen::Index>(i)));
  return sum;
}

FitPosterior::BinVariances FitPosterior::variances(const Eigen::VectorXd& x,
                                                   const std::vector<Prediction>& at,
                                                   const double acceleration_variance) const {
  BinVariances s;
  for (std::size_t r = 0; r < at.size(); ++r)
    s.push_back(variance(x, at[r], r, acceleration_variance));
  return s;
}

/// Of the variance, by a noise level or by the level of incoherent errors, of form errors or of the
/// unknown cause; zero for the levels of the discrepancy.
Eigen::VectorXd FitPosterior::level_column(const Eigen::VectorXd& x,
                                           const std::vector<Prediction>& at, const BinVariances& s,
                                           const Eigen::Index index) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(discrepancy_.n_rows());
  if (index >= static_cast<Eigen::Index>(index_of_discrepancy) &&
      index < static_cast<Eigen::Index>(index_of_incoherence))
    return out;
  const double moment = std::exp(2. * x(index_of_moment_noise)),
               level = 2. * std::exp(2. * x(index));
  const auto slope = [&](const std::size_t r, const std::size_t b) {
    const auto flicker = [&] { return flicker_at(experiment_.records[r], b, x); };
    switch (index) {
      case index_of_moment_noise:
        return level * at[r].moment_noise[b] * (1. + flicker());
      case index_of_acceleration_noise:
        return level * at[r].acceleration_noise[b];
      case index_of_flicker:
        return moment * at[r].moment_noise[b] * flicker();
      case index_of_incoherence:
        return level * incoherent_[r][b];
      default:
        if (has_form_errors()) return level * form_[r][b];
        return unknown_index(r, b) == index ? level * power_[r][b] : 0.;
    }
  };
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < s.size(); ++r)
    for (std::size_t b = 0; b < s[r].size(); ++b, ++row) out(row) = slope(r, b) / s[r][b];
  return out;
}

void FitPosterior::set_derivative(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                                  const BinVariances& s, const Nuisances& nuisances,
                                  const Chain& moved, const std::vector<Prediction>& there,
                                  const double h, const Eigen::Index column,
                                  Derivatives& out) const {
  const double a_moved = acceleration_variance(x, moved);
  out.acceleration(column) = (a_moved - acceleration_variance(x)) / h;
  Eigen::Index row = 0, nuisance = 0;
  for (std::size_t r = 0; r < s.size(); ++r) {
    const std::vector<double> s_there = variance(x, there[r], r, a_moved);
    const bool same = there[r].unknowns.size() == at[r].unknowns.size();
    const std::vector<Complex> added = same && nuisances[r].any()
                                           ? nuisances[r].change_to(there[r].unknowns)
                                           : std::vector<Complex>(s[r].size(), 0.);
    for (std::size_t b = 0; b < s[r].size(); ++b, ++row) {
      const Complex d = (there[r].mean[b] - at[r].mean[b] + added[b]) / h;
      out.mean(2 * row, column) = d.real();
      out.mean(2 * row + 1, column) = d.imag();
      out.variance(row, column) = (s_there[b] - s[r][b]) / h;
    }
    for (std::size_t i = 0; i < at[r].unknowns.size(); ++i, ++nuisance)
      if (same)
        out.nuisance_variance(nuisance, column) =
            std::log(there[r].unknowns[i].variance / at[r].unknowns[i].variance) / h;
  }
}

Derivatives FitPosterior::derivatives(const Eigen::VectorXd& x,
                                      const std::vector<Prediction>& at) const {
  const BinVariances s = variances(x, at, acceleration_variance(x));
  const Nuisances nuisances = nuisances_of(at, s);
  const auto n_columns = static_cast<Eigen::Index>(of_chain_.size());
  Derivatives out{.mean = Eigen::MatrixXd(2 * discrepancy_.n_rows(), n_columns),
                  .variance = Eigen::MatrixXd(discrepancy_.n_rows(), n_columns),
                  .nuisance_variance = Eigen::MatrixXd::Zero(count(nuisances), n_columns),
                  .acceleration = Eigen::VectorXd(n_columns)};
  const auto step = [&](const Eigen::Index index) {
    return fit_parameters_[static_cast<std::size_t>(index)].description.step_at(x(index));
  };
  std::vector<Chain> moved;
  for (const Eigen::Index index : of_chain_) {
    Eigen::VectorXd there = x;
    there(index) += step(index);
    moved.push_back(make_chain(experiment_, fit_parameters_, there));
  }
  predict_together(moved, experiment_.records, at,
                   [&](const std::size_t i, const std::vector<Prediction>& there) {
                     set_derivative(x, at, s, nuisances, moved[i], there, step(of_chain_[i]),
                                    static_cast<Eigen::Index>(i), out);
                   });
  return out;
}

Eigen::MatrixXd FitPosterior::relative_variance(const Eigen::VectorXd& x,
                                                const std::vector<Prediction>& at,
                                                const BinVariances& s,
                                                const Eigen::VectorXd& per_deviation,
                                                const Derivatives& derivatives) const {
  Eigen::MatrixXd out(derivatives.variance.rows(),
                      derivatives.variance.cols() + static_cast<Eigen::Index>(levels_.size()));
  Eigen::Index column = derivatives.variance.cols();
  out.leftCols(column) = per_deviation.cwiseAbs2().asDiagonal() * derivatives.variance;
  for (const Eigen::Index index : levels_) out.col(column++) = level_column(x, at, s, index);
  return out;
}

void FitPosterior::add_means(const WhitenedErrors& errors, const ModelDiscrepancy::Solution& terms,
                             const Derivatives& derivatives, Eigen::VectorXd& gradient,
                             Eigen::MatrixXd& information) const {
  // Real and imaginary parts in turn.
  const Eigen::VectorXd of_parts = errors.per_deviation.transpose().replicate<2, 1>().reshaped();
  Eigen::MatrixXd columns = of_parts.asDiagonal() * derivatives.mean;
  const Eigen::Map<const Eigen::VectorXd> error(
      reinterpret_cast<const double*>(errors.error.data()), columns.rows());
  Eigen::VectorXd slope = 2. * columns.transpose() * error;
  Eigen::MatrixXd curvature = 2. * columns.transpose() * columns;
  remove_nuisances(errors.nuisances, columns, &curvature);
  terms.project(columns, slope, curvature);
  gradient(of_chain_) += slope;
  information(of_chain_, of_chain_) += curvature;
}

void FitPosterior::add_variances(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                                 const BinVariances& s, const WhitenedErrors& errors,
                                 const ModelDiscrepancy::Solution& terms,
                                 const Derivatives& derivatives, Eigen::VectorXd& gradient,
                                 Eigen::MatrixXd& information) const {
  const Eigen::MatrixXd columns = relative_variance(x, at, s, errors.per_deviation, derivatives);
  const Eigen::VectorXd excess =
      (errors.error - terms.mean()).cwiseAbs2().array() - 1. + terms.leverage().array();
  std::vector<Eigen::Index> parameters = of_chain_;
  parameters.insert(parameters.end(), levels_.begin(), levels_.end());
  gradient(parameters) += columns.transpose() * excess;
  information(parameters, parameters) += columns.transpose() * columns;
}

/// slope: of the accelerometer's variance.
void FitPosterior::add_accelerometer(const double acceleration_variance,
                                     const Eigen::VectorXd& slope, Eigen::VectorXd& gradient,
                                     Eigen::MatrixXd& information) const {
  double of_variance = 0., n_lines = 0.;
  for (const PreparedRecord& record : experiment_.records) {
    const double lines = static_cast<double>(record.n_acceleration_noise);
    n_lines += lines;
    if (lines > 0.)
      of_variance += record.acceleration_noise_power /
                         (static_cast<double>(record.n_samples) * acceleration_variance) -
                     lines;
  }
  const Eigen::VectorXd relative = slope / acceleration_variance;
  gradient += relative * of_variance;
  information += n_lines * relative * relative.transpose();
}

void FitPosterior::linearise(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                             const Derivatives& derivatives, Eigen::VectorXd& gradient,
                             Eigen::MatrixXd& information) const {
  const double a_variance = acceleration_variance(x);
  const BinVariances s = variances(x, at, a_variance);
  const WhitenedErrors errors = whitened_errors(at, s);
  const ModelDiscrepancy::Solution terms = discrepancy(x, errors);
  gradient.setZero(x.size());
  information.setZero(x.size(), x.size());
  add_means(errors, terms, derivatives, gradient, information);
  add_nuisances(errors.nuisances, derivatives.nuisance_variance, gradient, information);
  add_variances(x, at, s, errors, terms, derivatives, gradient, information);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(x.size());
  slope(of_chain_) = derivatives.acceleration;
  slope(index_of_acceleration_noise) = 2. * std::exp(2. * x(index_of_acceleration_noise));
  add_accelerometer(a_variance, slope, gradient, information);
  const auto add_level = [&](const Eigen::Index i, const std::size_t level) {
    gradient(i) += terms.gradient()[level];
    information(i, i) += terms.information()[level];
  };
  for (std::size_t level = 0; level < n_discrepancy_levels; ++level)
    add_level(static_cast<Eigen::Index>(index_of_discrepancy + level), level);
  if (has_form_errors()) add_level(x.size() - 1, index_of_form_level);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Prior& prior = fit_parameters_[static_cast<std::size_t>(i)].description.prior;
    gradient(i) += prior.slope(x(i));
    information(i, i) += prior.curvature(x(i));
  }
}

FitPosterior::Nuisances FitPosterior::nuisances_of(const std::vector<Prediction>& at,
                                                   const BinVariances& s) const {
  Nuisances out;
  for (std::size_t r = 0; r < at.size(); ++r)
    out.emplace_back(at[r].unknowns, difference(experiment_.records[r].moment, at[r].mean), s[r]);
  return out;
}

void FitPosterior::add_nuisances(const Nuisances& nuisances, const Eigen::MatrixXd& log_variance,
                                 Eigen::VectorXd& gradient, Eigen::MatrixXd& information) const {
  if (log_variance.rows() != count(nuisances)) return;
  Eigen::Index first = 0;
  for (const IntegratedNuisances& of_record : nuisances) {
    if (!of_record.any()) continue;
    const Eigen::VectorXd share = of_record.determined_share();
    const auto columns = log_variance.middleRows(first, share.size());
    gradient(of_chain_) += columns.transpose() * of_record.slope_of_variance();
    information(of_chain_, of_chain_) +=
        0.5 * columns.transpose() * share.cwiseAbs2().asDiagonal() * columns;
    first += share.size();
  }
}

void remove_nuisances(const FitPosterior::Nuisances& nuisances, Eigen::Ref<Eigen::MatrixXd> columns,
                      Eigen::MatrixXd* const information) {
  Eigen::Index first = 0;
  for (const IntegratedNuisances& unknowns : nuisances) {
    const Eigen::Index n_rows = unknowns.n_rows();
    if (unknowns.any()) {
      const Eigen::MatrixXd overlap =
          2. * columns.middleRows(first, n_rows).transpose() * unknowns.whitened_shapes();
      const Eigen::MatrixXd weighed = unknowns.covariance() * overlap.transpose();
      if (information != nullptr) *information -= overlap * weighed;
      columns.middleRows(first, n_rows) -= unknowns.whitened_shapes() * weighed;
    }
    first += n_rows;
  }
}

}  // namespace vibrissa::diagnosis
