#include "separation/ringdown/decay_growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

constexpr std::array<bool LawParts::*, 3> all_parts{&LawParts::cubic, &LawParts::drag,
                                                    &LawParts::friction};

DecayLaw without(DecayLaw law, bool LawParts::*part) {
  if (part == &LawParts::cubic) law.cubic = 0.;
  if (part == &LawParts::drag) law.drag = 0.;
  if (part == &LawParts::friction) law.slip = law.stick_ratio = law.reversal = 0.;
  return law;
}

/// Are all parameters told better than by a factor of e? A part of unknown size is a smaller law
/// again, with more than its probability.
bool is_told(const FittedDecay& fit) {
  for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i)
    if (fit.parts.is_logarithm(i) && fit.covariance(i, i) > 1.) return false;
  return true;
}

class LawGrowth {
 public:
  LawGrowth(const DecayMoments& pieces, double rate_hz) : pieces_(pieces), rate_hz_(rate_hz) {}

  GrownLaw grown(FittedDecay fit) {
    tried_ = {fit};
    for (auto next = best_further(fit); next && gains(*next, fit); next = best_further(fit))
      fit = std::move(*next);
    for (auto next = best_smaller(fit); next && !gains(fit, *next); next = best_smaller(fit))
      fit = std::move(*next);
    std::erase_if(tried_, [&](const FittedDecay& tried) {
      return is_alike(tried, fit) || !std::isfinite(criterion(tried)) || !is_told(tried);
    });
    return {std::move(fit), std::move(tried_)};
  }

 private:
  static bool gains(const FittedDecay& larger, const FittedDecay& smaller) {
    constexpr double decisive = 10.;  // Kass and Raftery 1995, table in section 3.2
    return criterion(larger) < criterion(smaller) - decisive;
  }
  static bool is_alike(const FittedDecay& a, const FittedDecay& b) {
    return a.parts == b.parts && a.law.reversal == b.law.reversal;
  }

  std::optional<FittedDecay> best_further(const FittedDecay& fit) {
    double largest = 0.;
    for (const DecayStart& start : fit.starts) largest = std::max(largest, start.amplitude());
    std::optional<FittedDecay> best;
    for (bool LawParts::*const part : all_parts) {
      if (fit.parts.*part) continue;
      LawParts alone, parts = fit.parts;
      alone.*part = parts.*part = true;
      take_better(best, best_of(starts_with(fit.law, alone, largest), parts));
    }
    return best;
  }

  /// The best law with one part less; none of a viscous one.
  std::optional<FittedDecay> best_smaller(const FittedDecay& fit) {
    std::optional<FittedDecay> best;
    for (bool LawParts::*const part : all_parts) {
      if (!(fit.parts.*part)) continue;
      LawParts parts = fit.parts;
      parts.*part = false;
      take_better(best, best_of({without(fit.law, part)}, parts));
    }
    return best;
  }

  /// The best fit from these laws, of friction with the better form.
  FittedDecay best_of(const std::vector<DecayLaw>& starts, const LawParts& parts) {
    std::optional<FittedDecay> best;
    for (const DecayLaw& start : starts)
      take_better(best, fit_decay(start, parts, pieces_, rate_hz_));
    keep(*best);
    if (parts.friction && std::isfinite(best->squares)) {
      DecayLaw other = best->law;
      other.reversal = 1. - other.reversal;
      FittedDecay fit = fit_decay(other, parts, pieces_, rate_hz_);
      keep(fit);
      take_better(best, std::move(fit));
    }
    return std::move(*best);
  }

  static void take_better(std::optional<FittedDecay>& best, FittedDecay fit) {
    if (!best || criterion(fit) < criterion(*best)) best = std::move(fit);
  }

  void keep(const FittedDecay& fit) {
    const auto known = std::ranges::find_if(
        tried_, [&](const FittedDecay& tried) { return is_alike(tried, fit); });
    if (known == tried_.end())
      tried_.push_back(fit);
    else if (criterion(fit) < criterion(*known))
      *known = fit;
  }

  const DecayMoments& pieces_;
  double rate_hz_;
  std::vector<FittedDecay> tried_{};  // the best fit of each structure
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
  if (!std::isfinite(criterion(fit)) || fit.squares > most_left * power)
    throw signals::UserError(
        "ring-down: no decaying mode explains half of the moment behind its largest values; record "
        "a flick or a hit and the rest that follows, without motion of the base");
}

}  // namespace

double criterion(const FittedDecay& fit) {
  if (!std::isfinite(fit.squares) || fit.covariance.size() == 0)
    return std::numeric_limits<double>::infinity();
  const double n = fit.n_samples();
  return n * std::log(fit.squares / n) + static_cast<double>(fit.n_unknowns) * std::log(n);
}

GrownLaw grow_law(const double frequency_hz, const double sampling_rate_hz, DecayMoments& pieces) {
  constexpr int most_trims = 6;
  LawGrowth growth(pieces, sampling_rate_hz);
  GrownLaw grown = growth.grown(first_fit(frequency_hz, pieces, sampling_rate_hz));
  bool is_trimmed = false;
  for (int i = 0; i < most_trims && trim(grown.fit, sampling_rate_hz, pieces); ++i) {
    is_trimmed = true;
    FittedDecay again = fit_decay(grown.fit.law, grown.fit.parts, pieces, sampling_rate_hz);
    if (!std::isfinite(again.squares)) break;
    grown.fit = std::move(again);
  }
  if (is_trimmed) grown = growth.grown(first_fit(frequency_hz, pieces, sampling_rate_hz));
  refuse_what_is_no_decay(grown.fit, pieces);
  return grown;
}

}  // namespace vibrissa::separation
