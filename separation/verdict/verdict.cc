#include "separation/verdict/verdict.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <optional>
#include <utility>

#include "separation/identification/order_selection.h"
#include "separation/model/simulation.h"
#include "separation/verdict/coherence.h"
#include "separation/verdict/peak_phase.h"
#include "signals/base/median.h"
#include "signals/base/significant_digits.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

namespace {

using signals::rounded;

std::string hertz(double value) {
  return rounded(value, 4) + " Hz";
}

/// What the band of a verdict is, in words.
std::string band_of_record(const Identification& identification) {
  return identification.n_hits > 0 ? "the band that the hit excites"
                                   : "the band in which the moment follows the base acceleration";
}
std::string band_of_response(const signals::FrequencyResponse& response) {
  return response.coherence.empty() ? "the lines of the response"
                                    : "the lines that the model explains";
}

/// Why this pair of poles cannot be a mode of the band; nothing when it can.
std::optional<std::string> reason_of_place(const ModeEstimate& mode, const Band& band,
                                           const std::string& band_words) {
  const double f = mode.frequency_hz.value, zeta = mode.damping_ratio.value;
  if (zeta >= 1.) return "two real poles, no oscillation";
  if (f * (1. + zeta) < band.low_hz || f * (1. - zeta) > band.high_hz)
    return "outside " + band_words + ", " + hertz(band.low_hz) + " to " + hertz(band.high_hz);
  return std::nullopt;
}

std::optional<std::string> reason_of_damping(const ModeEstimate& mode) {
  const double zeta = mode.damping_ratio.value;
  const double deviation = mode.damping_ratio.standard_deviation;
  if (!std::isfinite(deviation)) return "the data do not determine the damping";
  if (!(zeta > 2. * deviation))
    return "damping ratio " + rounded(zeta, 2) + " +- " + rounded(deviation, 2) +
           " is not told from zero";
  return std::nullopt;
}

template <typename FurtherReason>
void sort_modes(const FittedBvrm& fit, const std::string& band_words, const FurtherReason& further,
                Verdict& verdict) {
  for (std::size_t k = 0; k < fit.modes.size(); ++k) {
    std::optional<std::string> reason = reason_of_place(fit.modes[k], verdict.band, band_words);
    if (!reason) reason = further(k);
    if (!reason) reason = reason_of_damping(fit.modes[k]);
    // A mode at the border of stability ends a fit as unstable; it is not told from zero damping.
    if (!reason && fit.end != FitEnd::converged && fit.end != FitEnd::unstable)
      reason = "the fit did not converge (" + to_string(fit.end) + ")";
    if (reason)
      verdict.undetermined.push_back({k, *reason});
    else
      verdict.determined.push_back(k);
  }
}

/// explained: share of the variance of unseen data.
void conclude(const FittedBvrm& fit, double explained_percent, const std::string& unseen,
              Verdict& verdict) {
  const std::string share =
      rounded(explained_percent, explained_percent > 99. ? 4 : 3) + " % of " + unseen;
  verdict.usable = !verdict.determined.empty() && explained_percent >= 50.;
  if (verdict.usable) {
    verdict.sentence = "Usable from " + hertz(verdict.band.low_hz) + " to " +
                       hertz(verdict.band.high_hz) + ": the model explains " + share + ".";
    return;
  }
  if (verdict.determined.empty() && !verdict.frequency_only.empty()) {
    verdict.sentence =
        "Not usable as a model, only for the frequencies of peaks: no damping is resolved.";
    return;
  }
  verdict.sentence = "Not usable: ";
  if (explained_percent < 50.)
    verdict.sentence += explained_percent > 0. ? "the model explains only " + share
                                               : "the model explains nothing of " + unseen;
  else
    verdict.sentence += "no mode is determined, although the model explains " + share;
  if (fit.end != FitEnd::converged)
    verdict.sentence += "; the fit did not converge (" + to_string(fit.end) + ")";
  verdict.sentence += ".";
}

/// The sensor answers its base without delay but for the filters of its electronics.
std::string delay_sentence(const Estimate& delay_s, double rate_hz) {
  const double ms = 1e3 * delay_s.value;
  return std::string("The moment ") + (ms < 0. ? "leads" : "lags behind") +
         " the base acceleration by " + rounded(std::abs(ms), 4) + " +- " +
         rounded(1e3 * delay_s.standard_deviation, 2) + " ms (" +
         rounded(std::abs(delay_s.value) * rate_hz, 3) + " samples): " +
         (ms < 0. ? "no sensor answers before it is moved, so the channels are on two clocks"
                  : "the channels are on two clocks, or a filter delays the moment") +
         "; the model has this delay.";
}

/// A peak that is narrower than the lines has the shape of the spectral window: what lies on it
/// beside the mode is this shape.
std::optional<std::string> reason_of_lines(const FittedBvrm& fit, const std::size_t k,
                                           const signals::FrequencyResponse& response) {
  const ModeEstimate& mode = fit.modes[k];
  const double f = mode.frequency_hz.value;
  const double half_width = mode.damping_ratio.value * f, step = line_spacing_hz(response, f);
  if (!is_resolved(mode, response)) {
    if (phase_rises(response, f))
      return "the frequency is that of the amplitude: the phase rises through this peak, and falls "
             "through a resonance that answers its base, so the moment vibrates there by itself or "
             "by another source; where the moment was recorded in time, --output-only may tell its "
             "damping";
    return "the damping is not resolved: the peak is " + rounded(2. * half_width, 2) +
           " Hz wide at half power, the lines are " + rounded(step, 3) + " Hz apart";
  }
  for (const ModeEstimate& other : fit.modes)
    if (!is_resolved(other, response) &&
        std::abs(other.frequency_hz.value - f) < half_width + 2. * step)
      return "it lies on the peak at " + hertz(other.frequency_hz.value) +
             ", which is narrower than the lines and so has the shape of the spectral window";
  return std::nullopt;
}

/// Its deviation is that of an equal distribution over one line.
Estimate amplitude_peak(const signals::FrequencyResponse& response, const double at_hz) {
  return {amplitude_peak_hz(response, at_hz), line_spacing_hz(response, at_hz) / std::sqrt(12.)};
}

/// Whether the model explains more of the lines about this one than it leaves. Of so many lines of
/// noise a mode, four parameters, explains 4 of 18 real values.
bool is_explained(const std::vector<std::complex<double>>& measured,
                  const std::vector<std::complex<double>>& modelled, const std::size_t line) {
  constexpr std::size_t reach = 4;
  double whole = 0., left = 0.;
  const std::size_t end = std::min(line + reach + 1, measured.size());
  for (std::size_t i = line < reach ? 0 : line - reach; i < end; ++i) {
    if (!std::isfinite(std::abs(measured[i]))) continue;
    whole += std::norm(measured[i]);
    left += std::norm(measured[i] - modelled[i]);
  }
  return left < 0.5 * whole;
}

/// The band of its lines. Where their coherence is known, without the ends that the model, in which
/// lines of low coherence count for less, does not explain. The coherence alone does not tell the
/// band: after n averages the noise of a line is (1 - g2) / (g2 n) of its power, and no file states
/// n.
Band band_of_lines(const signals::FrequencyResponse& response, const Bvrm& model) {
  const auto& f = response.frequency_hz;
  if (response.coherence.empty()) return {f.front(), f.back()};
  const auto modelled = separation::response(model, f);
  std::size_t first = 0, last = f.size() - 1;
  while (first < last && !is_explained(response.value, modelled, first)) ++first;
  while (last > first && !is_explained(response.value, modelled, last)) --last;
  if (first == last) return {f.front(), f.back()};
  return {f[first], f[last]};
}

/// The coherence of an analyser, which weights the lines.
std::string coherence_sentence(const signals::FrequencyResponse& response) {
  if (response.coherence.empty()) return {};
  return " Coherence of the file: median " + rounded(signals::median(response.coherence), 3) +
         "; a line counts the less, the lower it is.";
}

/// Takes the peaks whose frequency is told from those that are not determined.
void set_frequencies_apart(const FittedBvrm& fit, const signals::FrequencyResponse& response,
                           Verdict& verdict) {
  std::vector<UndeterminedMode> others;
  for (UndeterminedMode& entry : verdict.undetermined) {
    const ModeEstimate& mode = fit.modes[entry.mode];
    const Estimate& f = mode.frequency_hz;
    const bool is_narrow = !reason_of_place(mode, verdict.band, band_of_response(response)) &&
                           !is_resolved(mode, response);
    if (is_narrow && phase_rises(response, f.value))
      entry.peak_hz = amplitude_peak(response, f.value);
    const bool is_told =
        is_narrow && (entry.peak_hz || f.standard_deviation < line_spacing_hz(response, f.value));
    (is_told ? verdict.frequency_only : others).push_back(std::move(entry));
  }
  verdict.undetermined = std::move(others);
  for (auto* entries : {&verdict.frequency_only, &verdict.undetermined})
    for (UndeterminedMode& entry : *entries)
      entry.damping_is_resolved = is_resolved(fit.modes[entry.mode], response);
}

/// A resonance that is narrower than Welch's lines leaks over them and is coherent at none: the
/// lines count, too, at which a model without a lasting mode explains more of the moment than it
/// leaves.
Band told_band(const Identification& identification, const signals::Record& fitted) {
  const std::optional<CoherentLines> found = coherent_lines(fitted);
  Band band = coherent_band(fitted, found);
  if (!found || identification.n_hits > 0 ||
      !lasting_modes_hz(identification.fit.model, identification.duration_s).empty())
    return band;
  const auto moment = fitted.channel(signals::channel::base_moment);
  std::vector<double> left =
      simulate_like(identification.fit.model, fitted.channel(signals::channel::base_acceleration),
                    moment, fitted.sampling_rate_hz(), identification.hold);
  std::ranges::transform(moment, left, left.begin(), std::minus<>());
  const auto whole = signals::welch_spectrum(moment, fitted.sampling_rate_hz(), found->welch),
             rest = signals::welch_spectrum(left, fitted.sampling_rate_hz(), found->welch);
  for (std::size_t i = 1; i < whole.density.size(); ++i) {
    if (!(rest.density[i] < 0.5 * whole.density[i])) continue;
    band.low_hz = std::min(band.low_hz, whole.frequency_hz[i]);
    band.high_hz = std::max(band.high_hz, whole.frequency_hz[i]);
  }
  return band;
}

}  // namespace

const Estimate& frequency_of(const UndeterminedMode& entry, const FittedBvrm& fit) {
  return entry.peak_hz ? *entry.peak_hz : fit.modes[entry.mode].frequency_hz;
}

Verdict judge(const Identification& identification, const signals::Record& fitted) {
  Verdict verdict;
  verdict.band = told_band(identification, fitted);
  const FittedBvrm& fit = identification.fit;
  sort_modes(
      fit, band_of_record(identification),
      [&](std::size_t k) -> std::optional<std::string> {
        Bvrm alone;
        alone.modes = {fit.model.modes[k]};
        if (identification.n_hits > 0 || lasting_modes_hz(alone, identification.duration_s).empty())
          return std::nullopt;
        return "it does not decay within the record";
      },
      verdict);
  conclude(fit, identification.held_out_vaf_percent,
           identification.n_hits == 1
               ? "the variance of the end of the decay after the only hit; record a second hit to "
                 "score the model"
               : "the variance of data that it has not seen (free simulation)",
           verdict);
  if (verdict.usable && identification.found_delay_s)
    verdict.sentence = delay_sentence(*identification.found_delay_s, fitted.sampling_rate_hz()) +
                       " " + verdict.sentence;
  return verdict;
}

Verdict judge(const IdentifiedResponse& identified, const signals::FrequencyResponse& measured) {
  const auto response = identified.conjugated ? conjugate_of(measured) : measured;
  Verdict verdict;
  verdict.band = band_of_lines(response, identified.fit.model);
  const bool exact = identified.held_out_fit_percent > 100. * (1. - exact_share);
  const FittedBvrm& fit = identified.fit;
  sort_modes(
      fit, band_of_response(response),
      [&](std::size_t k) -> std::optional<std::string> {
        if (exact) return std::nullopt;
        return reason_of_lines(fit, k, response);
      },
      verdict);
  if (!exact) set_frequencies_apart(fit, response, verdict);
  const double left = 1. - identified.held_out_fit_percent / 100.;
  conclude(fit, 100. * (1. - left * left), "the variance of lines that it has not seen", verdict);
  verdict.sentence += coherence_sentence(response);
  if (identified.conjugated)
    verdict.sentence +=
        " The response has the sign convention exp(-j w t); its conjugate was "
        "fitted.";
  return verdict;
}

}  // namespace vibrissa::separation
