#include "separation/ringdown/decay_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace vibrissa::separation {

namespace {

/// Logarithm of the amplitude, frequency [Hz] and damping of each period of a decay by the law.
using Period = std::array<double, 3>;
std::vector<Period> periods_of(const DecayLaw& law, DecayStart start, double duration_s) {
  constexpr double samples_a_period = 100.;
  start.offset = start.drift = 0.;
  const double rate_hz = samples_a_period * law.frequency_hz;
  const std::vector<double> x =
      decay(law, start, static_cast<std::size_t>(duration_s * rate_hz), rate_hz);
  std::vector<std::pair<double, double>> peaks;  // time [s], moment
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    if (x[i] <= 0. || x[i] <= x[i - 1] || x[i] < x[i + 1]) continue;
    const double bend = x[i - 1] - 2. * x[i] + x[i + 1], tilt = 0.5 * (x[i + 1] - x[i - 1]);
    peaks.emplace_back((static_cast<double>(i) - tilt / bend) / rate_hz,
                       x[i] - 0.5 * tilt * tilt / bend);
  }
  std::vector<Period> out;
  for (std::size_t i = 0; i + 1 < peaks.size(); ++i) {
    const double fall = std::log(peaks[i].second / peaks[i + 1].second) / (2. * std::numbers::pi),
                 damping = fall / std::hypot(1., fall),
                 hz = 1. / (peaks[i + 1].first - peaks[i].first);
    out.push_back({0.5 * std::log(peaks[i].second * peaks[i + 1].second),
                   hz / std::sqrt(1. - damping * damping), damping});
  }
  return out;
}

/// At the logarithm of an amplitude, between two periods.
Period interpolated(const std::vector<Period>& falling, double log_amplitude) {
  const auto below = std::ranges::find_if(
      falling, [&](const Period& period) { return period[0] <= log_amplitude; });
  if (below == falling.begin()) return falling.front();
  if (below == falling.end()) return falling.back();
  const Period &above = *(below - 1), &under = *below;
  const double part = (log_amplitude - above[0]) / (under[0] - above[0]);
  return {log_amplitude, std::lerp(above[1], under[1], part), std::lerp(above[2], under[2], part)};
}

std::vector<Period> periods(const FittedCurve& curve, const Eigen::VectorXd& parameters) {
  const FittedDecay& fit = curve.fit;
  return periods_of(with_parameters(fit.law, fit.parts, parameters), fit.starts[curve.piece],
                    curve.duration_s);
}

}  // namespace

std::vector<double> amplitudes_of(const FittedCurve& curve, const double noise_rms,
                                  const std::size_t n) {
  constexpr double above_noise = 3.;
  std::vector<Period> all = periods(curve, curve.fit.parameters);
  std::erase_if(
      all, [&](const Period& period) { return period[0] < std::log(above_noise * noise_rms); });
  std::vector<double> out;
  if (all.size() < 2) return out;
  for (std::size_t k = 0; k < n; ++k)
    out.push_back(std::lerp(all.front()[0], all.back()[0],
                            (static_cast<double>(k) + 0.5) / static_cast<double>(n)));
  return out;
}

std::vector<DecayPoint> points_of(const FittedCurve& curve,
                                  const std::vector<double>& log_amplitudes) {
  constexpr double step = 1e-4;
  const FittedDecay& fit = curve.fit;
  const std::vector<Period> here = periods(curve, fit.parameters);
  if (here.empty()) return {};
  std::vector<std::vector<Period>> there;
  std::vector<double> steps;
  for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i) {
    Eigen::VectorXd moved = fit.parameters;
    steps.push_back(fit.parts.cubic && i == 2 ? step * std::abs(moved[i]) : step);
    moved[i] += steps.back();
    there.push_back(periods(curve, moved));
    if (there.back().empty()) there.back() = here;
  }
  std::vector<DecayPoint> out;
  for (const double log_amplitude : log_amplitudes) {
    const Period at = interpolated(here, log_amplitude);
    Eigen::MatrixXd slopes(fit.covariance.rows(), 2);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Period moved = interpolated(there[i], log_amplitude);
      slopes.row(static_cast<Eigen::Index>(i)) << (moved[1] - at[1]) / steps[i],
          (moved[2] - at[2]) / steps[i];
    }
    const Eigen::Matrix2d covariance = slopes.transpose() * fit.covariance * slopes;
    out.push_back({.amplitude_n_m = std::exp(log_amplitude),
                   .frequency_hz = {at[1], std::sqrt(covariance(0, 0))},
                   .damping_ratio = {at[2], std::sqrt(covariance(1, 1))}});
  }
  return out;
}

FrictionForms compare_frictions(FittedDecay fit, const DecayMoments& pieces, double rate_hz) {
  if (!fit.parts.friction) return {.fit = std::move(fit)};
  DecayLaw law = fit.law;
  law.reversal = 1. - law.reversal;
  FittedDecay other = fit_decay(law, fit.parts, pieces, rate_hz);
  if (!std::isfinite(other.squares)) return {.fit = std::move(fit)};
  if (criterion(other) < criterion(fit)) std::swap(other, fit);
  const double better = criterion(other) - criterion(fit);
  return {std::move(fit), std::move(other), 1. / (1. + std::exp(0.5 * better))};
}

std::vector<DecayPoint> points_of(const FrictionForms& forms, std::size_t piece, double duration_s,
                                  double noise_rms, std::size_t n) {
  const FittedCurve curve{forms.fit, piece, duration_s};
  const std::vector<double> amplitudes = amplitudes_of(curve, noise_rms, n);
  std::vector<DecayPoint> out = points_of(curve, amplitudes);
  if (!forms.other) return out;
  const std::vector<DecayPoint> others =
      points_of(FittedCurve{*forms.other, piece, duration_s}, amplitudes);
  if (others.size() != out.size()) return out;
  const double part = std::sqrt(forms.probability_of_other);
  for (std::size_t i = 0; i < out.size(); ++i)
    for (Estimate DecayPoint::*const value :
         {&DecayPoint::frequency_hz, &DecayPoint::damping_ratio}) {
      Estimate& estimate = out[i].*value;
      estimate.standard_deviation = std::hypot(estimate.standard_deviation,
                                               part * ((others[i].*value).value - estimate.value));
    }
  return out;
}

}  // namespace vibrissa::separation
