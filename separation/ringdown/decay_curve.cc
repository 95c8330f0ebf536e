#include "separation/ringdown/decay_curve.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace vibrissa::separation {

namespace {

/// Time [s] and value of a maximum or minimum.
using Peak = std::pair<double, double>;

/// Maxima of sign * x by parabolas.
std::vector<Peak> peaks_of(const std::vector<double>& x, double rate_hz, double sign) {
  std::vector<Peak> out;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    if (sign * x[i] <= sign * x[i - 1] || sign * x[i] < sign * x[i + 1]) continue;
    const double bend = x[i - 1] - 2. * x[i] + x[i + 1], tilt = 0.5 * (x[i + 1] - x[i - 1]);
    out.emplace_back((static_cast<double>(i) - tilt / bend) / rate_hz,
                     x[i] - 0.5 * tilt * tilt / bend);
  }
  return out;
}

/// Samples of a decay by the law, 100 a period.
std::pair<std::vector<double>, double> fine_decay(const DecayLaw& law, const DecayStart& start,
                                                  double duration_s) {
  constexpr double samples_a_period = 100.;
  const double rate_hz = samples_a_period * law.frequency_hz;
  return {decay(law, start, static_cast<std::size_t>(duration_s * rate_hz), rate_hz), rate_hz};
}

/// Logarithm of the amplitude, frequency [Hz] and damping of each period of a decay by the law.
using Period = std::array<double, 3>;
std::vector<Period> periods_of(const DecayLaw& law, DecayStart start, double duration_s) {
  start.offset = start.drift = 0.;
  const auto [x, rate_hz] = fine_decay(law, start, duration_s);
  std::vector<Peak> peaks = peaks_of(x, rate_hz, 1.);
  std::erase_if(peaks, [](const Peak& peak) { return peak.second <= 0.; });
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

bool is_finite(const DecayPoint& point) {
  return std::isfinite(point.frequency_hz.value + point.frequency_hz.standard_deviation) &&
         std::isfinite(point.damping_ratio.value + point.damping_ratio.standard_deviation);
}

}  // namespace

Envelope envelope_of(const FittedCurve& curve) {
  const auto [x, rate_hz] =
      fine_decay(curve.fit.law, curve.fit.starts[curve.piece], curve.duration_s);
  Envelope out;
  for (const auto& [time_s, moment] : peaks_of(x, rate_hz, 1.)) {
    out.upper_s.push_back(time_s);
    out.upper_n_m.push_back(moment);
  }
  for (const auto& [time_s, moment] : peaks_of(x, rate_hz, -1.)) {
    out.lower_s.push_back(time_s);
    out.lower_n_m.push_back(moment);
  }
  return out;
}

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
  constexpr double part = 0.1;  // of a standard deviation
  const FittedDecay& fit = curve.fit;
  const std::vector<Period> here = periods(curve, fit.parameters);
  if (here.empty()) return {};
  const Eigen::MatrixXd root = fit.covariance.llt().matrixL();
  std::vector<std::array<std::vector<Period>, 2>> sides;
  for (Eigen::Index i = 0; i < root.cols(); ++i)
    sides.push_back({periods(curve, fit.parameters + part * root.col(i)),
                     periods(curve, fit.parameters - part * root.col(i))});
  std::vector<DecayPoint> out;
  for (const double log_amplitude : log_amplitudes) {
    const Period at = interpolated(here, log_amplitude);
    Period variance{};
    for (const auto& [above, below] : sides) {
      if (above.empty() || below.empty()) return {};
      const Period high = interpolated(above, log_amplitude),
                   low = interpolated(below, log_amplitude);
      for (std::size_t k = 0; k < variance.size(); ++k)
        variance[k] += std::pow((high[k] - low[k]) / (2. * part), 2);
    }
    out.push_back({.amplitude_n_m = std::exp(log_amplitude),
                   .frequency_hz = {at[1], std::sqrt(variance[1])},
                   .damping_ratio = {at[2], std::sqrt(variance[2])}});
  }
  return out;
}

std::vector<DecayPoint> points_of(const GrownLaw& grown, std::size_t piece, double duration_s,
                                  double noise_rms, std::size_t n) {
  const FittedCurve curve{grown.fit, piece, duration_s};
  const std::vector<double> amplitudes = amplitudes_of(curve, noise_rms, n);
  const std::vector<DecayPoint> chosen = points_of(curve, amplitudes);
  std::vector<std::pair<double, std::vector<DecayPoint>>> laws{{criterion(grown.fit), chosen}};
  for (const FittedDecay& other : grown.others)
    if (std::vector<DecayPoint> points = points_of({other, piece, duration_s}, amplitudes);
        points.size() == chosen.size() && std::ranges::all_of(points, is_finite))
      laws.emplace_back(criterion(other), std::move(points));
  const double least =
      std::ranges::min_element(laws, {}, [](const auto& law) { return law.first; })->first;
  double sum = 0.;
  for (auto& [weight, points] : laws) sum += weight = std::exp(0.5 * (least - weight));
  std::vector<DecayPoint> out = chosen;
  for (std::size_t i = 0; i < out.size(); ++i)
    for (Estimate DecayPoint::*const value :
         {&DecayPoint::frequency_hz, &DecayPoint::damping_ratio}) {
      double variance = 0.;
      for (const auto& [weight, points] : laws) {
        const Estimate& estimate = points[i].*value;
        variance += weight / sum *
                    (std::pow(estimate.standard_deviation, 2) +
                     std::pow(estimate.value - (chosen[i].*value).value, 2));
      }
      (out[i].*value).standard_deviation = std::sqrt(variance);
    }
  return out;
}

}  // namespace vibrissa::separation
