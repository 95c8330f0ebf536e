#include "separation/ringdown/decay_growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "signals/base/error.h"
#include "signals/spectra/resample.h"

namespace vibrissa::separation {

namespace {

/// Frequency and damping of the first periods of a decay without laws.
FittedDecay first_fit(double frequency_hz, const DecayMoments& pieces, double rate_hz) {
  constexpr std::array<double, 3> tried{0.005, 0.02, 0.08};
  std::optional<FittedDecay> best;
  for (const double damping : tried) {
    FittedDecay fit =
        fit_decay({.frequency_hz = frequency_hz, .damping_ratio = damping}, {}, pieces, rate_hz);
    if (!best || fit.squares < best->squares) best = std::move(fit);
  }
  if (!std::isfinite(best->squares))
    throw signals::UserError("ring-down: the strongest line, at " + std::to_string(frequency_hz) +
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
  LawGrowth(const DecayMoments& pieces, double rate_hz) : pieces_(pieces), rate_hz_(rate_hz) {}

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
    for (const DecayStart& start : fit.starts) largest = std::max(largest, start.amplitude());
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

  const DecayMoments& pieces_;
  double rate_hz_;
};

double rms(std::span<const double> x) {
  double sum = 0.;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(x.size(), 1)));
}

/// Leaves out the first period of each piece whose errors are larger there than behind it: other
/// modes have not decayed. Was there any?
bool trim(const FittedDecay& fit, double rate_hz, DecayMoments& pieces) {
  constexpr double much = 1.4, fewest_periods = 8.;
  const double period = rate_hz / fit.law.frequency_hz;
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

void refuse_what_is_no_decay(const FittedDecay& fit, const DecayMoments& pieces) {
  constexpr double most_left = 0.5;  // of the power
  double power = 0.;
  for (const std::span<const double> piece : pieces)
    for (const double value : signals::remove_mean(piece)) power += value * value;
  if (fit.squares > most_left * power)
    throw signals::UserError(
        "ring-down: no decaying mode explains half of the moment behind its largest values; record "
        "a flick or a hit and the rest that follows, without motion of the base");
}

}  // namespace

double criterion(const FittedDecay& fit) {
  if (!std::isfinite(fit.squares)) return fit.squares;
  const double n = fit.n_samples();
  return n * std::log(fit.squares / n) + static_cast<double>(fit.n_unknowns) * std::log(n);
}

FittedDecay grow_law(const double frequency_hz, const double sampling_rate_hz,
                     DecayMoments& pieces) {
  constexpr int most_trims = 6;
  const LawGrowth growth(pieces, sampling_rate_hz);
  FittedDecay fit = growth.grown(first_fit(frequency_hz, pieces, sampling_rate_hz));
  bool is_trimmed = false;
  for (int i = 0; i < most_trims && trim(fit, sampling_rate_hz, pieces); ++i) {
    is_trimmed = true;
    FittedDecay again = fit_decay(fit.law, fit.parts, pieces, sampling_rate_hz);
    if (!std::isfinite(again.squares)) break;
    fit = std::move(again);
  }
  if (is_trimmed) fit = growth.grown(first_fit(frequency_hz, pieces, sampling_rate_hz));
  refuse_what_is_no_decay(fit, pieces);
  return fit;
}

}  // namespace vibrissa::separation
