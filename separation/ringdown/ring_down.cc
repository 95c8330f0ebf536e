#include "separation/ringdown/ring_down.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/significant_digits.h"
#include "signals/base/student.h"
#include "signals/spectra/resample.h"

namespace vibrissa::separation {

namespace {

using Pieces = std::vector<std::span<const double>>;

double amplitude_of(const DecayStart& start) {
  return std::hypot(start.moment, start.rate);
}

double period_samples(const DecayLaw& law, double rate_hz) {
  return rate_hz / law.frequency_hz;
}

/// Schwarz's criterion.
double criterion(const FittedDecay& fit) {
  if (!std::isfinite(fit.squares)) return fit.squares;
  double n = 0.;
  for (const std::vector<double>& error : fit.errors) n += static_cast<double>(error.size());
  return n * std::log(fit.squares / n) + static_cast<double>(fit.n_unknowns) * std::log(n);
}

/// Frequency and damping of the first periods of a decay without laws.
FittedDecay first_fit(const Decays& decays, const Pieces& pieces, double rate_hz) {
  constexpr std::array<double, 3> tried{0.005, 0.02, 0.08};
  std::optional<FittedDecay> best;
  for (const double damping : tried) {
    FittedDecay fit = fit_decay({.frequency_hz = decays.frequency_hz, .damping_ratio = damping}, {},
                                pieces, rate_hz);
    if (!best || fit.squares < best->squares) best = std::move(fit);
  }
  if (!std::isfinite(best->squares))
    throw signals::UserError("ring-down: the strongest line, at " +
                             std::to_string(decays.frequency_hz) +
                             " Hz, is too near to half of the sampling rate");
  return std::move(*best);
}

/// The laws from which one part more is fitted.
std::vector<DecayLaw> starts_with(const DecayLaw& law, const LawParts& part, double largest) {
  constexpr double bend = 0.01, share = 0.4;
  constexpr std::array<std::pair<double, double>, 4> frictions{
      {{0.003, 0.3}, {0.01, 0.1}, {0.03, 0.1}, {0.1, 0.3}}};  // slip, stick ratio
  std::vector<DecayLaw> out;
  DecayLaw start = law;
  if (part.cubic)
    for (const double sign : {-1., 1.}) {
      start.cubic = sign * bend / (largest * largest);
      out.push_back(start);
    }
  if (part.drag) {
    start.damping_ratio = (1. - share) * law.damping_ratio;
    start.drag = share * law.damping_ratio / largest;
    out.push_back(start);
  }
  if (part.friction)
    for (const auto& [slip, stick] : frictions) {
      start.slip = slip * largest;
      start.stick_ratio = stick;
      out.push_back(start);
    }
  return out;
}

class LawGrowth {
 public:
  LawGrowth(const Pieces& pieces, double rate_hz) : pieces_(pieces), rate_hz_(rate_hz) {}

  FittedDecay grown(FittedDecay fit) const {
    constexpr double decisive = 10.;  // Kass and Raftery 1995, table in section 3.2
    while (auto next = best_further(fit)) {
      if (criterion(*next) > criterion(fit) - decisive) break;
      fit = std::move(*next);
    }
    return fit;
  }

 private:
  std::optional<FittedDecay> best_further(const FittedDecay& fit) const {
    double largest = 0.;
    for (const DecayStart& start : fit.starts) largest = std::max(largest, amplitude_of(start));
    std::optional<FittedDecay> best;
    for (bool LawParts::*const part : {&LawParts::cubic, &LawParts::drag, &LawParts::friction}) {
      if (fit.parts.*part) continue;
      LawParts alone, parts = fit.parts;
      alone.*part = parts.*part = true;
      for (const DecayLaw& start : starts_with(fit.law, alone, largest)) {
        FittedDecay tried = fit_decay(start, parts, pieces_, rate_hz_);
        if (!best || criterion(tried) < criterion(*best)) best = std::move(tried);
      }
    }
    return best;
  }

  const Pieces& pieces_;
  double rate_hz_;
};

double rms(std::span<const double> x) {
  double sum = 0.;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(x.size(), 1)));
}

/// Leaves out the first period of each piece whose errors are larger there than behind it: other
/// modes have not decayed. Was there any?
bool trim(const FittedDecay& fit, double rate_hz, Pieces& pieces) {
  constexpr double much = 1.4, fewest_periods = 8.;
  const double period = period_samples(fit.law, rate_hz);
  const auto n = static_cast<std::size_t>(std::ceil(period));
  bool any = false;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const std::span<const double> error = fit.errors[p];
    if (static_cast<double>(error.size()) < fewest_periods * period ||
        rms(error.first(n)) < much * rms(error.subspan(n)))
      continue;
    pieces[p] = pieces[p].subspan(n);
    any = true;
  }
  return any;
}

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

/// A decay by a fitted law, from the start of one of its pieces.
struct FittedCurve {
  const FittedDecay& fit;
  std::size_t piece = 0;
  double duration_s = 0.;

  std::vector<Period> periods(const Eigen::VectorXd& parameters) const {
    return periods_of(with_parameters(fit.law, fit.parts, parameters), fit.starts[piece],
                      duration_s);
  }
};

/// Logarithms of amplitudes in equal steps over a decay, as far as they exceed the noise; empty
/// where it has less than two periods.
std::vector<double> amplitudes_of(const FittedCurve& curve, const double noise_rms,
                                  const std::size_t n) {
  constexpr double above_noise = 3.;
  std::vector<Period> periods = curve.periods(curve.fit.parameters);
  std::erase_if(
      periods, [&](const Period& period) { return period[0] < std::log(above_noise * noise_rms); });
  std::vector<double> out;
  if (periods.size() < 2) return out;
  for (std::size_t k = 0; k < n; ++k)
    out.push_back(std::lerp(periods.front()[0], periods.back()[0],
                            (static_cast<double>(k) + 0.5) / static_cast<double>(n)));
  return out;
}

std::vector<DecayPoint> points_of(const FittedCurve& curve,
                                  const std::vector<double>& log_amplitudes) {
  constexpr double step = 1e-4;
  const FittedDecay& fit = curve.fit;
  const std::vector<Period> here = curve.periods(fit.parameters);
  std::vector<std::vector<Period>> there;
  std::vector<double> steps;
  for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i) {
    Eigen::VectorXd moved = fit.parameters;
    steps.push_back(fit.parts.cubic && i == 2 ? step * std::abs(moved[i]) : step);
    moved[i] += steps.back();
    there.push_back(curve.periods(moved));
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

/// The better one of a fit and the same law with the other form of friction; of the other one the
/// probability by Schwarz's criterion.
struct FrictionForms {
  FittedDecay fit;
  std::optional<FittedDecay> other{};
  double probability_of_other = 0.;
};
FrictionForms compare_frictions(FittedDecay fit, const Pieces& pieces, double rate_hz) {
  if (!fit.parts.friction) return {.fit = std::move(fit)};
  DecayLaw law = fit.law;
  law.reversal = 1. - law.reversal;
  FittedDecay other = fit_decay(law, fit.parts, pieces, rate_hz);
  if (!std::isfinite(other.squares)) return {.fit = std::move(fit)};
  if (criterion(other) < criterion(fit)) std::swap(other, fit);
  const double better = criterion(other) - criterion(fit);
  return {std::move(fit), std::move(other), 1. / (1. + std::exp(0.5 * better))};
}

/// Points of the better form; their deviations allow for the other one.
std::vector<DecayPoint> points_of(const FrictionForms& forms, std::size_t piece, double duration_s,
                                  double noise_rms, std::size_t n) {
  const FittedCurve curve{forms.fit, piece, duration_s};
  const std::vector<double> amplitudes = amplitudes_of(curve, noise_rms, n);
  std::vector<DecayPoint> out = points_of(curve, amplitudes);
  if (!forms.other) return out;
  const std::vector<DecayPoint> others =
      points_of(FittedCurve{*forms.other, piece, duration_s}, amplitudes);
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

/// Damped sines one after the other.
std::vector<DecayPoint> measured_points(const RingDown& found, const Pieces& pieces,
                                        double rate_hz) {
  constexpr double fall = 0.5, fewest = 3., most = 12.;
  const double period = period_samples(found.fit.law, rate_hz);
  const double n_periods =
      std::clamp(fall / (2. * std::numbers::pi * found.largest.damping_ratio), fewest, most);
  const auto n = static_cast<std::size_t>(n_periods * period);
  std::vector<DecayPoint> out;
  for (const std::span<const double> piece : pieces)
    for (std::size_t first = 0; first + n <= piece.size(); first += n) {
      const std::span<const double> window = piece.subspan(first, n);
      const FittedDecay fit = fit_decay({.frequency_hz = found.largest.frequency_hz,
                                         .damping_ratio = found.largest.damping_ratio},
                                        {}, {&window, 1}, rate_hz);
      if (fit.covariance.size() == 0) continue;
      const FittedCurve curve{fit, 0, static_cast<double>(n) / rate_hz};
      const std::vector<DecayPoint> middle = points_of(curve, amplitudes_of(curve, 0., 1));
      if (middle.empty()) continue;
      const DecayPoint& point = middle.front();
      const bool is_told = point.frequency_hz.standard_deviation < 0.1 * fit.law.frequency_hz &&
                           point.damping_ratio.standard_deviation < point.damping_ratio.value;
      if (is_told) out.push_back(point);
    }
  std::ranges::sort(out, std::ranges::greater(), &DecayPoint::amplitude_n_m);
  return out;
}

/// At most so many samples are fitted, the first ones of all pieces.
void shorten(Pieces& pieces) {
  constexpr std::size_t most_samples = 12000, fewest_of_a_piece = 100;
  std::size_t left = most_samples;
  std::erase_if(pieces, [&](std::span<const double>& piece) {
    if (piece.size() > left && left < fewest_of_a_piece) return true;
    piece = piece.first(std::min(piece.size(), left));
    left -= piece.size();
    return false;
  });
}

/// Damping of the points that were measured without a law less that of the law, in standard
/// deviations (rms).
double deviation_of_rows(const RingDown& found) {
  double sum = 0.;
  for (const DecayPoint& point : found.measured) {
    const auto nearest = std::ranges::min_element(found.fitted, {}, [&](const DecayPoint& fitted) {
      return std::abs(std::log(fitted.amplitude_n_m / point.amplitude_n_m));
    });
    sum += std::pow((point.damping_ratio.value - nearest->damping_ratio.value) /
                        std::hypot(point.damping_ratio.standard_deviation,
                                   nearest->damping_ratio.standard_deviation,
                                   0.05 * nearest->damping_ratio.value),
                    2);
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(found.measured.size(), 1)));
}

double rms_of(const FittedDecay& fit) {
  double n = 0.;
  for (const std::vector<double>& error : fit.errors) n += static_cast<double>(error.size());
  return std::sqrt(fit.squares / n);
}

void refuse_what_is_no_decay(const FittedDecay& fit, const Pieces& pieces) {
  constexpr double most_left = 0.5;  // of the power
  double power = 0.;
  for (const std::span<const double> piece : pieces)
    for (const double value : signals::remove_mean(piece)) power += value * value;
  if (fit.squares > most_left * power)
    throw signals::UserError(
        "ring-down: no decaying mode explains half of the moment behind its largest values; record "
        "a flick or a hit and the rest that follows, without motion of the base");
}

std::size_t strongest_piece(const FittedDecay& fit) {
  const auto most = std::ranges::max_element(fit.starts, {}, amplitude_of);
  return static_cast<std::size_t>(most - fit.starts.begin());
}

std::string digits(double value, int n) {
  return signals::to_text(signals::with_significant_digits(value, n));
}

std::string with_interval(const Estimate& estimate) {
  const double half = signals::normal_quantile_975 * estimate.standard_deviation;
  const int n =
      half > 0.
          ? std::clamp(1 + static_cast<int>(std::ceil(std::log10(std::abs(estimate.value) / half))),
                       2, 8)
          : 6;
  return digits(estimate.value, n) + " ± " + digits(half, 2);
}

std::string at_amplitude(const DecayPoint& point) {
  return digits(point.amplitude_n_m, 3) + " N m: " + with_interval(point.frequency_hz) +
         " Hz, damping ratio " + with_interval(point.damping_ratio);
}

std::string shares_of(const EquivalentMode& mode) {
  std::string out;
  for (const auto& [name, share] :
       {std::pair("viscous", mode.viscous_share), std::pair("drag", mode.drag_share),
        std::pair("friction", mode.friction_share)})
    if (share >= 0.005)
      out += (out.empty() ? "" : ", ") + std::string(name) + " " + digits(100. * share, 2) + " %";
  return out;
}

std::string words_of(const RingDown& found) {
  std::string laws;
  for (const std::string& law : found.damping_laws) laws += (laws.empty() ? "" : " and ") + law;
  std::string out;
  if (found.is_doubtful())
    out = "Doubtful: the law leaves an error of " + digits(found.error_rms_n_m, 2) +
          " N m (rms), the quietest part of the record has " + digits(found.decays.noise_rms, 2) +
          " N m, and the rows without a law differ from it by " +
          digits(found.deviation_of_rows, 2) +
          " of their standard deviations (rms): another mode near by, a base that moves, or a law "
          "that is not tried. The "
          "intervals are too narrow; believe the rows without a law. ";
  out += "At the largest amplitude that was fitted, " + at_amplitude(found.fitted.front()) +
         "; at the smallest, " + at_amplitude(found.fitted.back()) +
         " (95 % intervals). The damping is " + laws +
         " (at the largest amplitude: " + shares_of(found.largest) +
         "; at the smallest: " + shares_of(found.smallest) + ").";
  if (found.fit.parts.cubic)
    out += found.fit.law.cubic > 0. ? " The spring stiffens with the deflection."
                                    : " The spring softens with the deflection.";
  return out;
}

std::vector<std::string> laws_of(const RingDown& found) {
  constexpr double least_share = 0.05;
  const auto counts = [&](double EquivalentMode::*share) {
    return std::max(found.largest.*share, found.smallest.*share) >= least_share;
  };
  std::vector<std::string> out;
  if (counts(&EquivalentMode::viscous_share)) out.push_back("viscous");
  if (counts(&EquivalentMode::drag_share)) out.push_back("drag");
  if (counts(&EquivalentMode::friction_share)) out.push_back("friction");
  return out;
}

}  // namespace

bool RingDown::is_doubtful() const {
  constexpr double much = 2.;
  return error_rms_n_m > much * decays.noise_rms || deviation_of_rows > much;
}

RingDown identify_ring_down(std::span<const double> moment, const double sampling_rate_hz) {
  constexpr int most_trims = 6;
  constexpr std::size_t n_points = 12;
  RingDown out;
  out.decays = find_decays(moment, sampling_rate_hz);
  const std::vector<double> centred = signals::remove_mean(moment);
  Pieces pieces;
  for (const DecayPiece& piece : out.decays.pieces)
    pieces.push_back(std::span(centred).subspan(piece.first, piece.end - piece.first));
  shorten(pieces);
  const LawGrowth growth(pieces, sampling_rate_hz);
  out.fit = growth.grown(first_fit(out.decays, pieces, sampling_rate_hz));
  bool is_trimmed = false;
  for (int i = 0; i < most_trims && trim(out.fit, sampling_rate_hz, pieces); ++i) {
    is_trimmed = true;
    FittedDecay again = fit_decay(out.fit.law, out.fit.parts, pieces, sampling_rate_hz);
    if (!std::isfinite(again.squares)) break;
    out.fit = std::move(again);
  }
  if (is_trimmed) out.fit = growth.grown(first_fit(out.decays, pieces, sampling_rate_hz));
  refuse_what_is_no_decay(out.fit, pieces);
  FrictionForms forms = compare_frictions(std::move(out.fit), pieces, sampling_rate_hz);
  const std::size_t piece = strongest_piece(forms.fit);
  out.fitted = points_of(forms, piece, static_cast<double>(pieces[piece].size()) / sampling_rate_hz,
                         out.decays.noise_rms, n_points);
  out.fit = std::move(forms.fit);
  if (out.fitted.empty())
    throw signals::UserError(
        "ring-down: the fit of the decay swings for less than three periods; "
        "record a longer decay");
  out.error_rms_n_m = rms_of(out.fit);
  out.largest = equivalent_mode(out.fit.law, out.fitted.front().amplitude_n_m);
  out.smallest = equivalent_mode(out.fit.law, out.fitted.back().amplitude_n_m);
  out.damping_laws = laws_of(out);
  out.measured = measured_points(out, pieces, sampling_rate_hz);
  out.deviation_of_rows = deviation_of_rows(out);
  out.words = words_of(out);
  return out;
}

nlohmann::json ring_down_json(const RingDown& found) {
  const auto points = [](const std::vector<DecayPoint>& list) {
    nlohmann::json out = nlohmann::json::array();
    for (const DecayPoint& point : list)
      out.push_back({{"amplitude_n_m", point.amplitude_n_m},
                     {"frequency_hz", point.frequency_hz.value},
                     {"frequency_sd_hz", point.frequency_hz.standard_deviation},
                     {"damping_ratio", point.damping_ratio.value},
                     {"damping_sd", point.damping_ratio.standard_deviation}});
    return out;
  };
  nlohmann::json pieces = nlohmann::json::array();
  for (const DecayPiece& piece : found.decays.pieces)
    pieces.push_back({{"first_sample", piece.first}, {"end_sample", piece.end}});
  const DecayLaw& law = found.fit.law;
  return {{"words", found.words},
          {"doubtful", found.is_doubtful()},
          {"error_rms_n_m", found.error_rms_n_m},
          {"noise_rms_n_m", found.decays.noise_rms},
          {"deviation_of_rows", found.deviation_of_rows},
          {"damping_laws", found.damping_laws},
          {"law",
           {{"frequency_hz", law.frequency_hz},
            {"damping_ratio", law.damping_ratio},
            {"cubic_per_n_m2", law.cubic},
            {"drag_per_n_m", law.drag},
            {"slip_n_m", law.slip},
            {"stick_ratio", law.stick_ratio}}},
          {"pieces", pieces},
          {"measured", points(found.measured)},
          {"fitted", points(found.fitted)}};
}

}  // namespace vibrissa::separation
