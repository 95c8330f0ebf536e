#include "diagnosis/hypothesis_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

/// Places of the figures that belong to no effect.
constexpr std::size_t place_moment_noise = 0, place_acceleration_noise = 1, place_joint_share = 2,
                      place_joint_loss = 3, n_noise_figures = 2, n_own_figures = 4;

/// An ADXL345 or its like at rest, a sample [m/s^2]: paper.md gives 0.008 g as its bound.
constexpr double usual_acceleration_noise = 0.05, usual_spread = 0.3;
/// Misfit of the nominal form that is always allowed for.
constexpr double least_misfit = 1e-4;
/// Upper edges of the bands of a discrepancy, in frequencies of the first mode; the last has none.
constexpr std::array<double, 4> discrepancy_edges{0.5, 0.9, 1.1, 2.};
constexpr std::size_t n_discrepancy_bands = discrepancy_edges.size() + 1;

/// A retune parameter within this of nominal is nominal: the simulation is not known better.
double negligible(const std::string& id) {
  return id == "damping" ? 0.01 : 0.002;
}

std::vector<FreeFigure> make_figures(const Experiment& experiment, const Hypothesis& hypothesis) {
  std::vector<FreeFigure> figures(n_own_figures);
  const double m = std::log(experiment.moment_noise);
  figures[place_moment_noise].description = {
      .name = "moment_noise",
      .unit = "N m",
      .logarithmic = true,
      .prior = {.kind = Prior::Kind::uniform, .low = m - 4., .high = m + 4.}};
  figures[place_acceleration_noise].description = {
      .name = "acceleration_noise",
      .unit = "m/s^2",
      .logarithmic = true,
      .prior = {.kind = Prior::Kind::normal,
                .centre = std::log(usual_acceleration_noise),
                .scale = usual_spread,
                .low = std::log(1e-6),
                .high = std::log(20.)}};
  figures[place_joint_share].description =
      normal("joint_share", "1", experiment.nominal.joint_share,
             experiment.nominal.joint_share_deviation, 0.3, 1., 1.);
  figures[place_joint_loss].description = normal("joint_loss_factor", "1", 1., 0.05, 0.7, 1.3, 1.);
  const auto add = [&](const Effect& effect, bool nuisance) {
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      figures.push_back({&effect, i, effect.parameters[i], nuisance});
      // As a finding of its own a retune parameter may lie anywhere in its range.
      if (effect.retune && !nuisance && i == 0)
        figures.back().description.prior.kind = Prior::Kind::uniform;
    }
  };
  for (const std::string& id : nuisance_ids()) {
    const Effect& effect = find_effect(id);
    if ((effect.needs.base && !experiment.has_base) || (effect.needs.wind && !experiment.has_wind))
      continue;
    if (!hypothesis.contains(id)) add(effect, true);
  }
  for (const Effect* effect : hypothesis.effects()) add(*effect, false);
  if (hypothesis.is_discrepancy())
    for (std::size_t i = 0; i < n_discrepancy_bands; ++i)
      figures.push_back({nullptr, i, log_uniform("discrepancy", "1", 1e-4, 1., 0.), false});
  if (!hypothesis.effects().empty())
    figures.push_back({nullptr, 0, uniform("form_error_share", "1", 0., 1., 0.), false});
  return figures;
}

Chain make_chain(const Experiment& experiment, const std::vector<FreeFigure>& figures,
                 const Eigen::VectorXd& x, const Effect* left_out = nullptr) {
  Chain chain;
  chain.structure = experiment.nominal;
  chain.joint_share = x(place_joint_share);
  chain.joint_loss_factor = x(place_joint_loss);
  for (std::size_t i = n_own_figures; i < figures.size();) {
    const Effect* effect = figures[i].effect;
    if (effect == nullptr) break;  // form error and discrepancy come last
    std::vector<double> values;
    for (; i < figures.size() && figures[i].effect == effect; ++i)
      values.push_back(figures[i].description.value(x(static_cast<Eigen::Index>(i))));
    if (effect != left_out) effect->extend(chain, values, experiment.scales);
  }
  return chain;
}

/// Mean power over the neighbouring bins: a wrong form is wrong beside its lines, too.
std::vector<double> smoothed_power(const std::vector<Complex>& a, const std::vector<Complex>* b) {
  const std::size_t n = a.size();
  std::vector<double> running(n + 1, 0.);
  for (std::size_t k = 0; k < n; ++k)
    running[k + 1] = running[k] + std::norm(b == nullptr ? a[k] : a[k] - (*b)[k]);
  constexpr std::size_t reach = 10;
  std::vector<double> out(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t low = k < reach ? 0 : k - reach, high = std::min(n, k + reach + 1);
    out[k] = (running[high] - running[low]) / static_cast<double>(high - low);
  }
  return out;
}

double nominal_misfit(const NominalModel& nominal, const PreparedRecord& record) {
  const double misfit = record.excitation.wind ? nominal.wind_misfit : nominal.base_misfit;
  return std::max(misfit, least_misfit);
}

/// The straight line between the ends of a record's random walk: a saw tooth of unknown rise,
/// normal with a variance of its own, that is integrated out.
class RampShare {
 public:
  RampShare(const PreparedRecord& record, double variance)
      : n_(static_cast<double>(record.n_judged)), variance_(variance) {}

  bool on() const { return variance_ > 0.; }
  /// DFT at bin b (0 is line 1) of a line that rises by 1 over the record.
  Complex shape(std::size_t b) const {
    const double angle = 2. * std::numbers::pi * static_cast<double>(b + 1) / n_;
    return 1. / (std::exp(Complex(0., -angle)) - 1.);
  }
  void add(std::size_t b, Complex error, double s) {
    if (!on()) return;
    const Complex g = shape(b);
    information_ += 2. * std::norm(g) / s;
    score_ += 2. * (std::conj(g) * error).real() / s;
  }
  /// Posterior variance of the rise.
  double posterior() const { return variance_ / (1. + variance_ * information_); }
  double score() const { return score_; }
  double log_likelihood_gain() const {
    if (!on()) return 0.;
    return 0.5 * score_ * score_ * posterior() - 0.5 * std::log1p(variance_ * information_);
  }

 private:
  double n_, variance_, information_ = 0., score_ = 0.;
};

/// State of a fit at one x: predictions, slow parts of the variance held fixed.
class Evaluation {
 public:
  Evaluation(const Experiment& experiment, const std::vector<FreeFigure>& figures,
             const Hypothesis& hypothesis)
      : experiment_(experiment),
        figures_(figures),
        form_error_(!hypothesis.effects().empty()),
        discrepancy_(hypothesis.is_discrepancy()) {}

  /// Renews what the variance takes from the mean: misfit of the nominal form, form error.
  void renew_slow_variance(const Eigen::VectorXd& x) {
    misfit_.clear();
    power_.clear();
    form_.clear();
    const Chain chain = make_chain(experiment_, figures_, x);
    std::vector<std::pair<const Effect*, Chain>> without;
    for (const FreeFigure& figure : figures_)
      if (figure.effect != nullptr && !figure.nuisance && figure.parameter == 0)
        without.emplace_back(figure.effect, make_chain(experiment_, figures_, x, figure.effect));
    for (const PreparedRecord& record : experiment_.records) {
      const std::vector<Complex> mean = simulate_mean(chain, record);
      power_.push_back(smoothed_power(mean, nullptr));
      misfit_.push_back(power_.back());
      const double share = nominal_misfit(experiment_.nominal, record);
      for (double& value : misfit_.back()) value *= share * share;
      std::vector<double> form(mean.size(), 0.);
      for (const auto& [effect, chain_without] : without) {
        const std::vector<Complex> other = simulate_mean(chain_without, record);
        const std::vector<double> power = smoothed_power(mean, &other);
        const double limit = effect->form_error * effect->form_error;
        for (std::size_t b = 0; b < form.size(); ++b) form[b] += limit * power[b];
      }
      form_.push_back(std::move(form));
    }
  }

  std::vector<Prediction> predict(const Eigen::VectorXd& x) const {
    const Chain chain = make_chain(experiment_, figures_, x);
    std::vector<Prediction> predictions;
    for (const PreparedRecord& record : experiment_.records)
      predictions.push_back(simulate(chain, record));
    return predictions;
  }

  double acceleration_variance(const Eigen::VectorXd& x) const {
    return std::exp(2. * x(place_acceleration_noise)) +
           make_chain(experiment_, figures_, x).reference_variance;
  }

  std::vector<double> variance(const Eigen::VectorXd& x, const Prediction& prediction,
                               std::size_t record, double acceleration_variance) const {
    const double moment = std::exp(2. * x(place_moment_noise));
    const double form = form_error_ ? x(x.size() - 1) : 0.;
    std::vector<double> out(prediction.mean.size());
    for (std::size_t b = 0; b < out.size(); ++b)
      out[b] = moment * prediction.moment_noise[b] +
               acceleration_variance * prediction.acceleration_noise[b] + prediction.own_noise[b] +
               misfit_[record][b] + form * form_[record][b];
    if (discrepancy_)
      for (std::size_t b = 0; b < out.size(); ++b) {
        const double share = std::exp(x(discrepancy_place(record, b)));
        out[b] += share * share * power_[record][b];
      }
    return out;
  }

  double log_likelihood(const Eigen::VectorXd& x,
                        const std::vector<Prediction>& predictions) const {
    const double a_variance = acceleration_variance(x);
    double sum = 0.;
    for (std::size_t r = 0; r < predictions.size(); ++r) {
      const PreparedRecord& record = experiment_.records[r];
      const std::vector<double> s = variance(x, predictions[r], r, a_variance);
      RampShare ramp(record, predictions[r].ramp_variance);
      for (std::size_t b = 0; b < s.size(); ++b) {
        const Complex error = record.moment[b] - predictions[r].mean[b];
        sum -= std::norm(error) / s[b] + std::log(s[b]);
        ramp.add(b, error, s[b]);
      }
      sum += ramp.log_likelihood_gain() - accelerometer_term(record, a_variance);
    }
    return std::isfinite(sum) ? sum : -std::numeric_limits<double>::infinity();
  }

  /// Figure of the discrepancy that a bin belongs to.
  Eigen::Index discrepancy_place(std::size_t record, std::size_t b) const {
    const PreparedRecord& prepared = experiment_.records[record];
    const double ratio = 2. * std::numbers::pi * static_cast<double>(b + 1) * prepared.bin_hz() /
                         experiment_.scales.first_mode_rad_s;
    const auto band = std::upper_bound(discrepancy_edges.begin(), discrepancy_edges.end(), ratio) -
                      discrepancy_edges.begin();
    return static_cast<Eigen::Index>(figures_.size() - n_discrepancy_bands) + band;
  }

  double log_prior(const Eigen::VectorXd& x) const {
    double sum = 0.;
    for (std::size_t i = 0; i < figures_.size(); ++i)
      sum += figures_[i].description.prior.log_density(x(static_cast<Eigen::Index>(i)));
    return sum;
  }

  /// Gradient of the log posterior and Fisher information plus the prior's curvature.
  void linearise(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                 Eigen::VectorXd& gradient, Eigen::MatrixXd& information) const;

  std::vector<std::pair<const Effect*, double>> effect_energy(
      const Eigen::VectorXd& x, const std::vector<Prediction>& at) const {
    std::vector<std::pair<const Effect*, double>> energies;
    const double a_variance = acceleration_variance(x);
    for (const FreeFigure& figure : figures_) {
      if (figure.effect == nullptr || figure.parameter != 0) continue;
      const Chain chain = make_chain(experiment_, figures_, x, figure.effect);
      const double a_without =
          std::exp(2. * x(place_acceleration_noise)) + chain.reference_variance;
      double energy = 0.;
      for (std::size_t r = 0; r < at.size(); ++r) {
        const Prediction without = simulate(chain, experiment_.records[r]);
        const std::vector<double> s = variance(x, at[r], r, a_variance);
        const std::vector<double> s_without = variance(x, without, r, a_without);
        for (std::size_t b = 0; b < s.size(); ++b)
          energy += std::norm(at[r].mean[b] - without.mean[b]) / s[b] +
                    (figure.nuisance ? 0. : std::abs(s[b] - s_without[b]) / s[b]);
      }
      energies.emplace_back(figure.effect, energy);
    }
    return energies;
  }

 private:
  void remove_ramps(const std::vector<Prediction>& at, const std::vector<std::vector<double>>& s,
                    const Eigen::MatrixXd& mean_columns, const Eigen::VectorXd& error,
                    Eigen::VectorXd& gradient, Eigen::MatrixXd& information) const;
  static double accelerometer_term(const PreparedRecord& record, double variance) {
    if (record.n_acceleration_noise == 0) return 0.;
    return record.acceleration_noise_power / (static_cast<double>(record.n_samples) * variance) +
           static_cast<double>(record.n_acceleration_noise) * std::log(variance);
  }

  const Experiment& experiment_;
  const std::vector<FreeFigure>& figures_;
  bool form_error_, discrepancy_;
  std::vector<std::vector<double>> misfit_, form_, power_;
};

/// Derivatives of mean and variance with respect to one figure, all records.
struct Derivative {
  std::vector<std::vector<Complex>> mean;  // empty: none
  std::vector<std::vector<double>> variance;
  double acceleration_variance = 0.;
};

void Evaluation::linearise(const Eigen::VectorXd& x, const std::vector<Prediction>& at,
                           Eigen::VectorXd& gradient, Eigen::MatrixXd& information) const {
  const std::size_t n_records = at.size();
  const auto n = static_cast<Eigen::Index>(figures_.size());
  const double a_variance = acceleration_variance(x);
  std::vector<std::vector<double>> s(n_records);
  Eigen::Index n_bins = 0;
  for (std::size_t r = 0; r < n_records; ++r) {
    s[r] = variance(x, at[r], r, a_variance);
    n_bins += static_cast<Eigen::Index>(s[r].size());
  }
  // Columns: whitened derivatives of the mean (real and imaginary parts) and of log S.
  Eigen::MatrixXd mean_columns = Eigen::MatrixXd::Zero(2 * n_bins, n);
  Eigen::MatrixXd variance_columns = Eigen::MatrixXd::Zero(n_bins, n);
  Eigen::VectorXd a_columns = Eigen::VectorXd::Zero(n);  // d log(acceleration variance)
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto place = static_cast<std::size_t>(i);
    Eigen::Index row = 0;
    if (place == place_moment_noise || place == place_acceleration_noise) {
      const bool moment = place == place_moment_noise;
      const double level = 2. * std::exp(2. * x(i));
      for (std::size_t r = 0; r < n_records; ++r)
        for (std::size_t b = 0; b < s[r].size(); ++b, ++row)
          variance_columns(row, i) =
              level * (moment ? at[r].moment_noise[b] : at[r].acceleration_noise[b]) / s[r][b];
      if (!moment) a_columns(i) = level / a_variance;
      continue;
    }
    if (figures_[place].effect == nullptr && place >= n_own_figures) {
      const double level = 2. * std::exp(2. * x(i));
      for (std::size_t r = 0; r < n_records; ++r)
        for (std::size_t b = 0; b < s[r].size(); ++b, ++row)
          if (!discrepancy_)
            variance_columns(row, i) = form_[r][b] / s[r][b];
          else if (discrepancy_place(r, b) == i)
            variance_columns(row, i) = level * power_[r][b] / s[r][b];
      continue;
    }
    Eigen::VectorXd moved = x;
    const Prior& prior = figures_[place].description.prior;
    double h = figures_[place].description.step;
    if (x(i) + h > prior.high) h = -h;
    moved(i) += h;
    const Chain chain = make_chain(experiment_, figures_, moved);
    const double a_moved = std::exp(2. * x(place_acceleration_noise)) + chain.reference_variance;
    a_columns(i) = (a_moved - a_variance) / h / a_variance;
    for (std::size_t r = 0; r < n_records; ++r) {
      const Prediction there = simulate(chain, experiment_.records[r]);
      const std::vector<double> s_there = variance(x, there, r, a_moved);
      for (std::size_t b = 0; b < s[r].size(); ++b, ++row) {
        const Complex d = (there.mean[b] - at[r].mean[b]) / h / std::sqrt(s[r][b]);
        mean_columns(2 * row, i) = d.real();
        mean_columns(2 * row + 1, i) = d.imag();
        variance_columns(row, i) = (s_there[b] - s[r][b]) / h / s[r][b];
      }
    }
  }
  Eigen::VectorXd error(2 * n_bins), excess(n_bins);
  Eigen::Index row = 0;
  double a_gradient = 0., a_lines = 0.;
  for (std::size_t r = 0; r < n_records; ++r) {
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
  gradient = 2. * mean_columns.transpose() * error + variance_columns.transpose() * excess +
             a_columns * a_gradient;
  information = 2. * mean_columns.transpose() * mean_columns +
                variance_columns.transpose() * variance_columns +
                a_lines * a_columns * a_columns.transpose();
  remove_ramps(at, s, mean_columns, error, gradient, information);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Prior& prior = figures_[static_cast<std::size_t>(i)].description.prior;
    gradient(i) += prior.slope(x(i));
    information(i, i) += prior.curvature(x(i));
  }
}

/// Takes what the unknown rise of each record explains out of gradient and information.
void Evaluation::remove_ramps(const std::vector<Prediction>& at,
                              const std::vector<std::vector<double>>& s,
                              const Eigen::MatrixXd& mean_columns, const Eigen::VectorXd& error,
                              Eigen::VectorXd& gradient, Eigen::MatrixXd& information) const {
  Eigen::Index first = 0;
  for (std::size_t r = 0; r < at.size(); ++r) {
    RampShare ramp(experiment_.records[r], at[r].ramp_variance);
    const auto n_rows = static_cast<Eigen::Index>(2 * s[r].size());
    if (ramp.on()) {
      Eigen::VectorXd shape(n_rows);
      for (std::size_t b = 0; b < s[r].size(); ++b) {
        const Complex g = ramp.shape(b) / std::sqrt(s[r][b]);
        shape(static_cast<Eigen::Index>(2 * b)) = g.real();
        shape(static_cast<Eigen::Index>(2 * b) + 1) = g.imag();
        ramp.add(b, 0., s[r][b]);
      }
      const Eigen::VectorXd overlap =
          2. * mean_columns.middleRows(first, n_rows).transpose() * shape;
      const double score = 2. * shape.dot(error.segment(first, n_rows));
      gradient -= overlap * score * ramp.posterior();
      information -= overlap * overlap.transpose() * ramp.posterior();
    }
    first += n_rows;
  }
}

void clamp(const std::vector<FreeFigure>& figures, Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const Prior& prior = figures[i].description.prior;
    double& value = x(static_cast<Eigen::Index>(i));
    value = std::clamp(value, prior.low, prior.high);
  }
}

bool hypothesis_has_effects(const std::vector<FreeFigure>& figures) {
  return std::any_of(figures.begin(), figures.end(), [](const FreeFigure& figure) {
    return figure.effect != nullptr && !figure.nuisance;
  });
}

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
      value = hypothesis_has_effects(figures) ? 0.2 : std::log(0.02);
      continue;
    }
    const double at = figure.nuisance ? (figure.parameter == 0 ? 1. : 0.5)
                                      : figure.effect->starts.front()[figure.parameter];
    value = figure.description.coordinate(at);
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

/// Step of the figures that are not held at a bound.
Eigen::VectorXd damped_step(const std::vector<FreeFigure>& figures, const Eigen::VectorXd& x,
                            const Eigen::VectorXd& gradient, const Eigen::MatrixXd& information,
                            double damping) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Prior& prior = figures[static_cast<std::size_t>(i)].description.prior;
    const bool at_low = x(i) <= prior.low && gradient(i) < 0.;
    const bool at_high = x(i) >= prior.high && gradient(i) > 0.;
    if (!at_low && !at_high) free.push_back(i);
  }
  Eigen::MatrixXd matrix = information(free, free);
  matrix.diagonal() *= 1. + damping;
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::VectorXd part =
      scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * gradient(free));
  Eigen::VectorXd step = Eigen::VectorXd::Zero(x.size());
  for (std::size_t i = 0; i < free.size(); ++i) step(free[i]) = part(static_cast<Eigen::Index>(i));
  // Fisher scoring far from the optimum overshoots in logarithms.
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Prior& prior = figures[static_cast<std::size_t>(i)].description.prior;
    const double most = 0.25 * (prior.high - prior.low);
    step(i) = std::clamp(step(i), -most, most);
  }
  return step;
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

/// Log density at zero of the marginal of the chosen figures, widened by what is negligible.
double log_density_at_nominal(const HypothesisFit& fit, const std::vector<Eigen::Index>& places) {
  const auto n = static_cast<Eigen::Index>(places.size());
  if (n == 0) return 0.;
  Eigen::MatrixXd covariance = fit.covariance(places, places);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FreeFigure& figure = fit.figures[static_cast<std::size_t>(places[i])];
    const double width = negligible(figure.effect->id);
    // A shift that moves the prediction no more than the effects' form errors may stem from them.
    const double information = fit.information(places[i], places[i]);
    covariance(i, i) += width * width + 0.5 * fit.form_energy(figure.effect) / information;
  }
  const Eigen::VectorXd x = fit.x(places);
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(covariance);
  const double log_determinant = ldlt.vectorD().array().abs().log().sum();
  return -0.5 * (x.dot(ldlt.solve(x)) + log_determinant +
                 static_cast<double>(n) * std::log(2. * std::numbers::pi));
}

/// Savage's and Dickey's ratio for every set of nuisances that may be nominal.
std::vector<RetuneChoice> retune_choices(const HypothesisFit& fit) {
  std::vector<Eigen::Index> ratios;
  for (std::size_t i = 0; i < fit.figures.size(); ++i)
    if (fit.figures[i].nuisance && fit.figures[i].parameter == 0)
      ratios.push_back(static_cast<Eigen::Index>(i));
  std::vector<RetuneChoice> choices;
  for (std::size_t set = 0; set < (std::size_t{1} << ratios.size()); ++set) {
    RetuneChoice choice{.log_evidence = fit.log_evidence};
    std::vector<Eigen::Index> nominal;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      const FreeFigure& figure = fit.figures[static_cast<std::size_t>(ratios[i])];
      if ((set >> i & 1) != 0) {
        choice.named.push_back(figure.effect->id);
        continue;
      }
      nominal.push_back(ratios[i]);
      choice.log_evidence -= figure.description.prior.log_density(0.);
    }
    choice.log_evidence += log_density_at_nominal(fit, nominal);
    choices.push_back(std::move(choice));
  }
  std::sort(choices.begin(), choices.end(), [](const RetuneChoice& a, const RetuneChoice& b) {
    return a.log_evidence > b.log_evidence;
  });
  return choices;
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

double HypothesisFit::form_energy(const std::vector<std::string>& ids) const {
  double sum = 0.;
  for (const auto& [effect, energy] : effect_energy)
    if (std::find(ids.begin(), ids.end(), effect->id) != ids.end())
      sum += effect->form_error * effect->form_error * energy;
  return sum;
}

Chain HypothesisFit::chain(const Experiment& experiment) const {
  return make_chain(experiment, figures, x);
}

namespace {

/// Where a climb stands.
struct Climb {
  Eigen::VectorXd x;
  std::vector<Prediction> predictions;
  double log_posterior = -std::numeric_limits<double>::infinity();
  double damping = 1e-3;
  bool ended = false;
  int n_iterations = 0;
};

Climb begin_climb(Evaluation& evaluation, const Eigen::VectorXd& x) {
  evaluation.renew_slow_variance(x);
  Climb climb{.x = x, .predictions = evaluation.predict(x)};
  climb.log_posterior = evaluation.log_likelihood(x, climb.predictions) + evaluation.log_prior(x);
  return climb;
}

void climb_on(Evaluation& evaluation, const std::vector<FreeFigure>& figures, Climb& climb,
              int n_iterations, const FitOptions& options) {
  // This many further gains like the last one would not do.
  constexpr double n_hopeful_gains = 15.;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
  for (int i = 0; i < n_iterations && !climb.ended; ++i, ++climb.n_iterations) {
    evaluation.renew_slow_variance(climb.x);
    climb.log_posterior =
        evaluation.log_likelihood(climb.x, climb.predictions) + evaluation.log_prior(climb.x);
    evaluation.linearise(climb.x, climb.predictions, gradient, information);
    climb.ended = true;
    for (int attempt = 0; attempt < 5; ++attempt) {
      Eigen::VectorXd x =
          climb.x + damped_step(figures, climb.x, gradient, information, climb.damping);
      clamp(figures, x);
      std::vector<Prediction> there = evaluation.predict(x);
      const double posterior = evaluation.log_likelihood(x, there) + evaluation.log_prior(x);
      if (posterior <= climb.log_posterior) {
        climb.damping = std::max(1e-2, climb.damping * 8.);
        continue;
      }
      const double gain = posterior - climb.log_posterior;
      const bool hopeless =
          climb.n_iterations >= 3 && posterior + n_hopeful_gains * gain < options.to_beat;
      climb.ended = gain < options.tolerance || hopeless;
      climb.x = x;
      climb.predictions = std::move(there);
      climb.log_posterior = posterior;
      climb.damping = std::max(1e-6, climb.damping * 0.2);
      break;
    }
  }
}

/// A few iterations from the most promising starts tell which basin is the best.
Climb best_start(Evaluation& evaluation, const std::vector<FreeFigure>& figures,
                 const std::vector<Eigen::VectorXd>& starts, const FitOptions& options) {
  constexpr std::size_t n_promising = 2;
  constexpr int n_first_iterations = 3;
  std::vector<Climb> climbs;
  for (const Eigen::VectorXd& x : starts) climbs.push_back(begin_climb(evaluation, x));
  const auto better = [](const Climb& a, const Climb& b) {
    return a.log_posterior > b.log_posterior;
  };
  std::sort(climbs.begin(), climbs.end(), better);
  climbs.resize(std::min(climbs.size(), n_promising));
  for (Climb& climb : climbs) climb_on(evaluation, figures, climb, n_first_iterations, options);
  std::sort(climbs.begin(), climbs.end(), better);
  return std::move(climbs.front());
}

}  // namespace

HypothesisFit fit_hypothesis(const Experiment& experiment, const Hypothesis& hypothesis,
                             const HypothesisFit* start, const FitOptions& options) {
  HypothesisFit fit;
  fit.hypothesis = hypothesis;
  fit.figures = make_figures(experiment, hypothesis);
  Evaluation evaluation(experiment, fit.figures, fit.hypothesis);
  // Retunes of another fit may have taken up what an effect does: both basins are looked at.
  const auto climb_from = [&](bool nominal_nuisances) {
    return best_start(evaluation, fit.figures,
                      start_vectors(experiment, fit.figures, hypothesis, start, nominal_nuisances),
                      options);
  };
  Climb climb = climb_from(true);
  if (start != nullptr) {
    Climb other = climb_from(false);
    if (other.log_posterior > climb.log_posterior) climb = std::move(other);
  }
  climb_on(evaluation, fit.figures, climb, options.max_iterations, options);
  fit.x = climb.x;
  fit.n_iterations = climb.n_iterations;
  fit.log_posterior = climb.log_posterior;
  evaluation.renew_slow_variance(fit.x);
  Eigen::VectorXd gradient;
  evaluation.linearise(fit.x, climb.predictions, gradient, fit.information);
  fit.effect_energy = evaluation.effect_energy(fit.x, climb.predictions);
  double log_determinant = 0.;
  fit.covariance = inverse(fit.information, log_determinant);
  fit.log_likelihood = evaluation.log_likelihood(fit.x, climb.predictions);
  fit.log_evidence = fit.log_likelihood + evaluation.log_prior(fit.x) - 0.5 * log_determinant +
                     0.5 * static_cast<double>(fit.x.size()) * std::log(2. * std::numbers::pi);
  fit.choices = retune_choices(fit);
  return fit;
}

std::vector<double> bin_variance(const Experiment& experiment, const HypothesisFit& fit,
                                 const PreparedRecord& record, const Prediction& prediction) {
  Evaluation evaluation(experiment, fit.figures, fit.hypothesis);
  evaluation.renew_slow_variance(fit.x);
  for (std::size_t r = 0; r < experiment.records.size(); ++r)
    if (&experiment.records[r] == &record)
      return evaluation.variance(fit.x, prediction, r, evaluation.acceleration_variance(fit.x));
  return {};
}

WhitenedResidual whitened_residual(const Experiment& experiment, const HypothesisFit& fit) {
  Evaluation evaluation(experiment, fit.figures, fit.hypothesis);
  evaluation.renew_slow_variance(fit.x);
  const std::vector<Prediction> predictions = evaluation.predict(fit.x);
  const double a_variance = evaluation.acceleration_variance(fit.x);
  WhitenedResidual residual;
  for (std::size_t r = 0; r < predictions.size(); ++r) {
    const std::vector<double> s = evaluation.variance(fit.x, predictions[r], r, a_variance);
    for (std::size_t b = 0; b < s.size(); ++b) {
      residual.deviation.push_back(std::sqrt(s[b]));
      residual.error.push_back((experiment.records[r].moment[b] - predictions[r].mean[b]) /
                               residual.deviation.back());
    }
  }
  return residual;
}

}  // namespace vibrissa::diagnosis
