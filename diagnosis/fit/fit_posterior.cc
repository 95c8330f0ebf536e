#include "diagnosis/fit/fit_posterior.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnosis/prediction/record_nuisances.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// Relative misfit of the nominal model that is always assumed.
constexpr double least_misfit = 1e-4;

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

}  // namespace

std::vector<double> model_form_error_power(const Effect& effect, std::span<const Complex> change) {
  std::vector<double> out = neighbour_mean(powers(change), form_reach);
  for (double& power : out) power *= effect.model_form_error * effect.model_form_error;
  return out;
}

FitPosterior::FitPosterior(const Experiment& experiment,
                           const std::vector<FitParameter>& fit_parameters,
                           const Hypothesis& hypothesis)
    : experiment_(experiment),
      fit_parameters_(fit_parameters),
      model_form_error_(!hypothesis.effects().empty()),
      discrepancy_(hypothesis.is_discrepancy()) {}

std::vector<Prediction> FitPosterior::predict(const Eigen::VectorXd& x) const {
  assert(x.allFinite());
  const Chain chain = make_chain(experiment_, fit_parameters_, x);
  return ChainSimulator(chain).predict(experiment_.records);
}

void FitPosterior::update_slow_variance(const Eigen::VectorXd& x,
                                        const std::vector<Prediction>& at) {
  for (BinVariances* parts : {&misfit_, &power_, &form_}) parts->clear();
  for (std::size_t r = 0; r < at.size(); ++r) {
    const PreparedRecord& record = experiment_.records[r];
    power_.push_back(neighbour_mean(powers(at[r].mean), form_reach));
    const double share = nominal_misfit(experiment_.nominal, record);
    misfit_.push_back(power_.back());
    for (double& value : misfit_.back()) value *= share * share;
    form_.emplace_back(record.n_bins(), 0.);
  }
  for (const FitParameter& fit_parameter : fit_parameters_)
    if (fit_parameter.effect != nullptr && !fit_parameter.nuisance && fit_parameter.parameter == 0)
      add_model_form_error(x, at, *fit_parameter.effect);
}

void FitPosterior::add_model_form_error(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                                        const Effect& effect) {
  const Chain without = make_chain(experiment_, fit_parameters_, x, &effect);
  const std::vector<std::vector<Complex>> mean = ChainSimulator(without).means(experiment_.records);
  for (std::size_t r = 0; r < at.size(); ++r) {
    const std::vector<double> power =
        model_form_error_power(effect, difference(at[r].mean, mean[r]));
    for (std::size_t b = 0; b < power.size(); ++b) form_[r][b] += power[b];
  }
}

double FitPosterior::acceleration_variance(const Eigen::VectorXd& x, const Chain& chain) const {
  return std::exp(2. * x(index_of_acceleration_noise)) + chain.reference_variance;
}

double FitPosterior::acceleration_variance(const Eigen::VectorXd& x) const {
  return acceleration_variance(x, make_chain(experiment_, fit_parameters_, x));
}

Eigen::Index FitPosterior::discrepancy_index(std::size_t record, std::size_t b) const {
  const double ratio = 2. * std::numbers::pi * static_cast<double>(b + 1) *
                       experiment_.records[record].bin_hz() / experiment_.scales.first_mode_rad_s;
  return static_cast<Eigen::Index>(fit_parameters_.size() - n_discrepancy_bands() +
                                   discrepancy_band(ratio));
}

std::vector<double> FitPosterior::variance(const Eigen::VectorXd& x, const Prediction& prediction,
                                           std::size_t record, double acceleration_variance) const {
  const double moment = std::exp(2. * x(index_of_moment_noise));
  const double form = model_form_error_ ? x(x.size() - 1) : 0.;
  std::vector<double> out(prediction.mean.size());
  for (std::size_t b = 0; b < out.size(); ++b)
    out[b] = moment * prediction.moment_noise[b] +
             acceleration_variance * prediction.acceleration_noise[b] +
             prediction.process_noise[b] + misfit_[record][b] + form * form_[record][b];
  if (discrepancy_)
    for (std::size_t b = 0; b < out.size(); ++b) {
      const double share = std::exp(x(discrepancy_index(record, b)));
      out[b] += share * share * power_[record][b];
    }
  return out;
}

double FitPosterior::log_likelihood(const Eigen::VectorXd& x,
                                    const std::vector<Prediction>& at) const {
  const double a_variance = acceleration_variance(x);
  double sum = 0.;
  for (std::size_t r = 0; r < at.size(); ++r) {
    const PreparedRecord& record = experiment_.records[r];
    const std::vector<double> s = variance(x, at[r], r, a_variance);
    const std::vector<Complex> error = difference(record.moment, at[r].mean);
    for (std::size_t b = 0; b < s.size(); ++b) sum -= std::norm(error[b]) / s[b] + std::log(s[b]);
    sum += IntegratedNuisances(at[r].unknowns, error, s).log_likelihood_gain() -
           accelerometer_term(record, a_variance);
  }
  return std::isfinite(sum) ? sum : -std::numeric_limits<double>::infinity();
}

double FitPosterior::log_prior(const Eigen::VectorXd& x) const {
  double sum = 0.;
  for (std::size_t i = 0; i < fit_parameters_.size(); ++i)
    sum += fit_parameters_[i].description.prior.log_density(x(static_cast<Eigen::Index>(i)));
  return sum;
}

std::vector<EffectAction> FitPosterior::actions(const Eigen::VectorXd& x,
                                                const std::vector<Prediction>& at) const {
  std::vector<EffectAction> actions;
  const double a_variance = acceleration_variance(x);
  for (const FitParameter& fit_parameter : fit_parameters_) {
    if (fit_parameter.effect == nullptr || fit_parameter.parameter != 0) continue;
    const Chain chain = make_chain(experiment_, fit_parameters_, x, fit_parameter.effect);
    const std::vector<Prediction> without = ChainSimulator(chain).predict(experiment_.records);
    const double a_without = acceleration_variance(x, chain);
    EffectAction action{.effect = fit_parameter.effect};
    for (std::size_t r = 0; r < at.size(); ++r) {
      const std::vector<double> s = variance(x, at[r], r, a_variance);
      const std::vector<double> s_without = variance(x, without[r], r, a_without);
      std::vector<Complex> change = difference(at[r].mean, without[r].mean);
      for (std::size_t b = 0; b < s.size(); ++b)
        action.energy +=
            (std::norm(change[b]) + (fit_parameter.nuisance ? 0. : std::abs(s[b] - s_without[b]))) /
            s[b];
      action.change.push_back(std::move(change));
    }
    actions.push_back(std::move(action));
  }
  return actions;
}

FitPosterior::BinVariances FitPosterior::variances(const Eigen::VectorXd& x,
                                                   const std::vector<Prediction>& at,
                                                   const double acceleration_variance) const {
  BinVariances s;
  for (std::size_t r = 0; r < at.size(); ++r)
    s.push_back(variance(x, at[r], r, acceleration_variance));
  return s;
}

void FitPosterior::set_noise_column(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                                    const BinVariances& s, const double acceleration_variance,
                                    const Eigen::Index index, Derivatives& out) const {
  const bool moment = index == static_cast<Eigen::Index>(index_of_moment_noise);
  const double level = 2. * std::exp(2. * x(index));
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < s.size(); ++r)
    for (std::size_t b = 0; b < s[r].size(); ++b, ++row)
      out.variance(row, index) =
          level * (moment ? at[r].moment_noise[b] : at[r].acceleration_noise[b]) / s[r][b];
  if (!moment) out.acceleration(index) = level / acceleration_variance;
}

void FitPosterior::set_share_column(const Eigen::VectorXd& x, const BinVariances& s,
                                    const Eigen::Index index, Derivatives& out) const {
  const double level = 2. * std::exp(2. * x(index));
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < s.size(); ++r)
    for (std::size_t b = 0; b < s[r].size(); ++b, ++row)
      if (!discrepancy_)
        out.variance(row, index) = form_[r][b] / s[r][b];
      else if (discrepancy_index(r, b) == index)
        out.variance(row, index) = level * power_[r][b] / s[r][b];
}

double FitPosterior::step_of(const Eigen::VectorXd& x, const Eigen::Index index) const {
  const Parameter& parameter = fit_parameters_[static_cast<std::size_t>(index)].description;
  return x(index) + parameter.step > parameter.prior.high ? -parameter.step : parameter.step;
}

void FitPosterior::set_derivative(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                                  const BinVariances& s, const Chain& moved,
                                  const std::vector<Prediction>& there, const double h,
                                  const Eigen::Index index, Derivatives& out) const {
  const double a_moved = acceleration_variance(x, moved);
  out.acceleration(index) = (a_moved - acceleration_variance(x)) / h;
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < s.size(); ++r) {
    const std::vector<double> s_there = variance(x, there[r], r, a_moved);
    for (std::size_t b = 0; b < s[r].size(); ++b, ++row) {
      const Complex d = (there[r].mean[b] - at[r].mean[b]) / h;
      out.mean(2 * row, index) = d.real();
      out.mean(2 * row + 1, index) = d.imag();
      out.variance(row, index) = (s_there[b] - s[r][b]) / h;
    }
  }
}

Derivatives FitPosterior::derivatives(const Eigen::VectorXd& x,
                                      const std::vector<Prediction>& at) const {
  // More chains at a time exceed the caches.
  constexpr std::size_t n_together = 4;
  const BinVariances s = variances(x, at, acceleration_variance(x));
  Eigen::Index n_bins = 0;
  for (const std::vector<double>& bins : s) n_bins += static_cast<Eigen::Index>(bins.size());
  Derivatives out{.mean = Eigen::MatrixXd::Zero(2 * n_bins, x.size()),
                  .variance = Eigen::MatrixXd::Zero(n_bins, x.size()),
                  .acceleration = Eigen::VectorXd::Zero(x.size())};
  std::vector<Eigen::Index> indices;
  for (std::size_t i = n_noise_parameters; i < fit_parameters_.size(); ++i) {
    const FitParameter& fit_parameter = fit_parameters_[i];
    const bool is_of_chain = fit_parameter.effect != nullptr || i < n_common_parameters;
    if (is_of_chain && fit_parameter.description.prior.low < fit_parameter.description.prior.high)
      indices.push_back(static_cast<Eigen::Index>(i));
  }
  for (std::size_t first = 0; first < indices.size(); first += n_together) {
    const std::size_t n = std::min(n_together, indices.size() - first);
    std::vector<Chain> moved;
    for (const Eigen::Index index : std::span(indices).subspan(first, n)) {
      Eigen::VectorXd there = x;
      there(index) += step_of(x, index);
      moved.push_back(make_chain(experiment_, fit_parameters_, there));
    }
    const auto predictions = predict_together(moved, experiment_.records);
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Index index = indices[first + i];
      set_derivative(x, at, s, moved[i], predictions[i], step_of(x, index), index, out);
    }
  }
  return out;
}

Derivatives FitPosterior::whitened(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                                   const BinVariances& s, const double acceleration_variance,
                                   const Derivatives& derivatives) const {
  Eigen::VectorXd per_deviation(derivatives.mean.rows()), per_variance(derivatives.variance.rows());
  Eigen::Index row = 0;
  for (const std::vector<double>& bins : s)
    for (const double variance : bins) {
      per_variance(row) = 1. / variance;
      per_deviation(2 * row) = per_deviation(2 * row + 1) = 1. / std::sqrt(variance);
      ++row;
    }
  Derivatives out{.mean = per_deviation.asDiagonal() * derivatives.mean,
                  .variance = per_variance.asDiagonal() * derivatives.variance,
                  .acceleration = derivatives.acceleration / acceleration_variance};
  for (std::size_t i = 0; i < fit_parameters_.size(); ++i) {
    const auto index = static_cast<Eigen::Index>(i);
    if (i < n_noise_parameters)
      set_noise_column(x, at, s, acceleration_variance, index, out);
    else if (fit_parameters_[i].effect == nullptr && i >= n_common_parameters)
      set_share_column(x, s, index, out);
  }
  return out;
}

void FitPosterior::linearise(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                             const Derivatives& derivatives, Eigen::VectorXd& gradient,
                             Eigen::MatrixXd& information) const {
  const double a_variance = acceleration_variance(x);
  const BinVariances s = variances(x, at, a_variance);
  const Derivatives d = whitened(x, at, s, a_variance, derivatives);
  Eigen::VectorXd error(d.mean.rows()), excess(d.variance.rows());
  Eigen::Index row = 0;
  double a_gradient = 0., a_lines = 0.;
  for (std::size_t r = 0; r < s.size(); ++r) {
    const PreparedRecord& record = experiment_.records[r];
    for (std::size_t b = 0; b < s[r].size(); ++b, ++row) {
      const Complex e = (record.moment[b] - at[r].mean[b]) / std::sqrt(s[r][b]);
      error(2 * row) = e.real();
      error(2 * row + 1) = e.imag();
      excess(row) = std::norm(e) - 1.;
    }
    const double lines = static_cast<double>(record.n_acceleration_noise);
    a_lines += lines;
    if (lines > 0.)
      a_gradient +=
          record.acceleration_noise_power / (static_cast<double>(record.n_samples) * a_variance) -
          lines;
  }
  gradient = 2. * d.mean.transpose() * error + d.variance.transpose() * excess +
             d.acceleration * a_gradient;
  information = 2. * d.mean.transpose() * d.mean + d.variance.transpose() * d.variance +
                a_lines * d.acceleration * d.acceleration.transpose();
  remove_unknowns(at, s, d.mean, gradient, information);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Prior& prior = fit_parameters_[static_cast<std::size_t>(i)].description.prior;
    gradient(i) += prior.slope(x(i));
    information(i, i) += prior.curvature(x(i));
  }
}

/// Projects the per-record nuisance parameters out of gradient and information.
void FitPosterior::remove_unknowns(const std::vector<Prediction>& at, const BinVariances& s,
                                   const Eigen::MatrixXd& mean_columns, Eigen::VectorXd& gradient,
                                   Eigen::MatrixXd& information) const {
  Eigen::Index first = 0;
  for (std::size_t r = 0; r < at.size(); ++r) {
    const auto n_rows = static_cast<Eigen::Index>(2 * s[r].size());
    const IntegratedNuisances unknowns(at[r].unknowns,
                                       difference(experiment_.records[r].moment, at[r].mean), s[r]);
    if (unknowns.any()) {
      const Eigen::MatrixXd overlap =
          2. * mean_columns.middleRows(first, n_rows).transpose() * unknowns.whitened_shapes();
      gradient -= overlap * unknowns.mean();
      information -= overlap * unknowns.covariance() * overlap.transpose();
    }
    first += n_rows;
  }
}

}  // namespace vibrissa::diagnosis
