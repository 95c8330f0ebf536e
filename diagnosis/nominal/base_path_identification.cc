
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "diagnosis/nominal/base_path_identification.h"
#include "diagnosis/records/response_record.h"
#include "diagnosis/records/spectrum.h"
#include "separation/identification/identify_frequency.h"
#include "separation/identification/output_error.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

using Entries = std::vector<const signals::DatasetRecord*>;
using separation::Bvrm;
namespace channel = signals::channel;

constexpr std::size_t max_order = 12;
/// A further pair of poles must lower the misfit to this share.
constexpr double worthwhile = 0.5;
/// Lowest useful misfit, given records with six digits and remaining transients.
constexpr double exact_misfit = 3e-4;

struct PathCandidate {
  Bvrm model;
  double misfit = 0.;  // relative
  separation::Hold hold = separation::Hold::band_limited;
};

signals::FrequencyResponse base_response_of(const signals::DatasetRecord& entry) {
  const signals::Record& record = entry.record;
  const auto a = record.channel(channel::base_acceleration);
  const auto m = record.channel(channel::base_moment);
  const double rate = record.sampling_rate_hz();
  if (entry.period_samples > 0) return signals::periodic_response(a, m, rate, entry.period_samples);
  return signals::welch_response(a, m, rate, {std::min<std::size_t>(2048, a.size() / 4)});
}

/// Lines of several records. Each line is taken from the first record that has it, and weighted by
/// the size of its response, because a simulation's error is proportional to it.
signals::FrequencyResponse joined_response(const Entries& entries) {
  std::map<double, Complex> lines;
  for (const signals::DatasetRecord* entry : entries) {
    const signals::FrequencyResponse response = base_response_of(*entry);
    for (std::size_t i = 0; i < response.value.size(); ++i)
      if (std::isfinite(std::abs(response.value[i])) && std::abs(response.value[i]) > 0.)
        lines.emplace(response.frequency_hz[i], response.value[i]);
  }
  signals::FrequencyResponse joined;
  for (const auto& [frequency_hz, value] : lines) {
    joined.frequency_hz.push_back(frequency_hz);
    joined.value.push_back(value);
    joined.coherence.push_back(1.);
    joined.standard_deviation.push_back(1e-3 * std::abs(value));
  }
  return joined;
}

/// Lines of responses by their drive, each from the first response that has it.
signals::FrequencyResponse joined_response(
    const std::span<const signals::DatasetResponse* const> responses) {
  std::map<double, std::pair<Complex, double>> lines;
  for (const signals::DatasetResponse* entry : responses) {
    const std::vector<Complex> value = as_deflection(*entry);
    for (std::size_t i = 0; i < value.size(); ++i) {
      const double level = entry->level_m_s2[i],
                   relative = entry->standard_deviation[i] / std::abs(entry->value[i]);
      lines.try_emplace(entry->frequency_hz[i], value[i] / level, std::max(1e-3, relative));
    }
  }
  signals::FrequencyResponse joined;
  for (const auto& [frequency_hz, line] : lines) {
    joined.frequency_hz.push_back(frequency_hz);
    joined.value.push_back(line.first);
    joined.coherence.push_back(1.);
    joined.standard_deviation.push_back(line.second * std::abs(line.first));
  }
  return joined;
}

double relative_misfit(const Bvrm& model, const signals::FrequencyResponse& response) {
  const std::vector<Complex> fitted = separation::response(model, response.frequency_hz);
  double sum = 0.;
  for (std::size_t i = 0; i < fitted.size(); ++i)
    sum += std::norm(fitted[i] / response.value[i] - 1.);
  return std::sqrt(sum / static_cast<double>(fitted.size()));
}

/// The real gain of a simulation without dynamics; nothing when it has dynamics.
std::optional<double> flat_gain(const signals::FrequencyResponse& response) {
  constexpr double flat = 1e-4;
  const double n = static_cast<double>(response.value.size());
  double gain = 0., error = 0.;
  for (const Complex& value : response.value) gain += value.real() / n;
  for (const Complex& value : response.value) error += std::norm(value - gain) / n;
  if (!(std::sqrt(error) <= flat * std::abs(gain))) return std::nullopt;
  return gain;
}

/// Records with the sampling rate of the first one.
std::vector<separation::Segment> segments_of(const Entries& entries) {
  std::vector<separation::Segment> segments;
  for (const signals::DatasetRecord* entry : entries)
    if (entry->record.sampling_rate_hz() == entries.front()->record.sampling_rate_hz())
      segments.push_back({entry->record.channel(channel::base_acceleration),
                          entry->record.channel(channel::base_moment)});
  return segments;
}

double mean_square_moment(std::span<const separation::Segment> segments) {
  std::vector<double> all;
  for (const separation::Segment& segment : segments)
    all.insert(all.end(), segment.base_moment.begin(), segment.base_moment.end());
  return mean_square(all);
}

/// Viscous part of the modes' moments relative to the elastic part.
double viscous_share(const Bvrm& model) {
  double viscous = 0., elastic = 0.;
  for (const separation::ModalTerm& term : model.modes) {
    viscous += std::abs(term.b1) / std::sqrt(term.a0);
    elastic += std::abs(term.b0) / term.a0;
  }
  return viscous / elastic;
}

/// Of two holds that fit about equally well, the wrong one delays the modes by half a sample, which
/// looks like a viscous moment (separation/identification/hold_check.h).
bool is_better(const PathCandidate& a, const PathCandidate& b) {
  constexpr double alike = 0.5, exact = 1e-6;
  if (std::max(a.misfit, exact) < alike * std::max(b.misfit, exact)) return true;
  if (std::max(b.misfit, exact) < alike * std::max(a.misfit, exact)) return false;
  return viscous_share(a.model) < viscous_share(b.model);
}

/// Welch's window widens a resonance, so the fit continues with the records themselves, under the
/// behaviour of the input between samples that fits them best.
std::optional<PathCandidate> refined(const Bvrm& start, const Entries& entries, Holds holds) {
  const std::vector<separation::Segment> segments = segments_of(entries);
  std::optional<PathCandidate> best;
  for (const separation::Hold hold : holds) try {
      const separation::FittedBvrm fit = separation::refine_output_error(
          start, segments, entries.front()->record.sampling_rate_hz(), {.hold = hold});
      const PathCandidate candidate{
          fit.model, std::sqrt(fit.residual_variance / mean_square_moment(segments)), hold};
      if (!best || is_better(candidate, *best)) best = candidate;
    } catch (const signals::UserError&) {
      // The order is too high for these records.
    }
  return best;
}

/// One mode more: strongly damped near the strongest mode, as aliases of modes above the sampling
/// frequency are.
Bvrm with_one_mode_more(const Bvrm& model) {
  constexpr double damping_ratio = 0.6, share = 0.1;
  const separation::ModalTerm& first = model.modes.front();
  Bvrm out = model;
  out.modes.push_back(separation::make_modal_term(first.frequency_hz(), damping_ratio,
                                                  share * first.static_gain_kg_m()));
  return out;
}

/// Simulations that hold or interpolate their input: the lines of the response, which are those of
/// a continuous motion, miss modes above the sampling frequency.
PathCandidate with_further_modes(PathCandidate best, const Entries& entries, const Holds holds) {
  while (best.misfit > exact_misfit && holds.size() > 1 &&
         2 * best.model.modes.size() < max_order) {
    const auto further = refined(with_one_mode_more(best.model), entries, holds);
    if (!further || further->misfit > worthwhile * best.misfit) break;
    best = *further;
  }
  return best;
}

std::optional<PathCandidate> best_candidate(const signals::FrequencyResponse& response,
                                            const Entries& entries, const Holds holds,
                                            const bool periodic) {
  std::optional<PathCandidate> best;
  for (const auto& fit : separation::identify_frequency_orders(response, {.order = max_order})) {
    if (best && best->misfit < exact_misfit) break;
    const std::optional<PathCandidate> candidate =
        periodic ? PathCandidate{fit.model, relative_misfit(fit.model, response)}
                 : refined(fit.model, entries, holds);
    if (!candidate || (best && candidate->misfit > worthwhile * best->misfit)) continue;
    best = periodic ? candidate : with_further_modes(*candidate, entries, holds);
  }
  return best;
}

/// The lines of periodic records are exact for a continuous motion. A simulation that holds or
/// interpolates its input may fit them, too, with modes that lag.
std::optional<PathCandidate> best_of_periodic(const signals::FrequencyResponse& response,
                                              const Entries& entries, const Holds holds) {
  const std::optional<PathCandidate> continuous =
      best_candidate(response, entries, holds, /*periodic=*/true);
  if (holds.size() == 1) return continuous;
  const std::optional<PathCandidate> sampled =
      best_candidate(response, entries, holds, /*periodic=*/false);
  const bool is_sampled = sampled && sampled->hold != separation::Hold::band_limited &&
                          (!continuous || is_better(*sampled, *continuous));
  return is_sampled ? sampled : continuous;
}

void set_modes(NominalModel& model, const Bvrm& found) {
  for (const separation::ModalTerm& term : found.modes) {
    const double w = std::sqrt(term.a0);
    model.modes.push_back({.frequency_rad_s = w,
                           .damping_ratio = term.damping_ratio(),
                           .base_gain = term.b0 / term.a0,
                           .base_rate = term.b1 / w});
  }
  // Joint laws act on the strongest mode of the band, so it comes first.
  std::ranges::sort(model.modes, std::ranges::greater(),
                    [](const StructuralMode& mode) { return std::abs(mode.base_gain); });
  model.base_direct = found.direct_term_kg_m;
}

/// Sets the gain of a response without dynamics.
bool is_gain_alone(NominalModel& model, const signals::FrequencyResponse& response) {
  const std::optional<double> gain = flat_gain(response);
  if (!gain) return false;
  model.base_direct = *gain;
  model.has_base = true;
  return true;
}

}  // namespace

void identify_base_path(NominalModel& model,
                        const std::span<const signals::DatasetResponse* const> responses) {
  for (const signals::DatasetResponse* entry : responses)
    if (!entry->phase_offset_is_known)
      throw signals::UserError("response '" + entry->name +
                               "': a simulation is identified from responses whose phase is known; "
                               "turn them and say \"phase\": \"known\"");
  const signals::FrequencyResponse response = joined_response(responses);
  if (is_gain_alone(model, response)) return;
  const auto best = best_candidate(response, {}, {}, /*periodic=*/true);
  if (!best) return;
  set_modes(model, best->model);
  model.has_base = true;
  model.base_misfit = best->misfit;
}

separation::Hold identify_base_path(NominalModel& model,
                                    std::span<const signals::DatasetRecord* const> base,
                                    const Holds holds) {
  Entries entries(base.begin(), base.end());
  const auto is_periodic = [](const auto* entry) { return entry->period_samples > 0; };
  const bool periodic = std::any_of(entries.begin(), entries.end(), is_periodic);
  if (periodic) std::erase_if(entries, [&](const auto* entry) { return !is_periodic(entry); });
  const signals::FrequencyResponse response = joined_response(entries);
  if (is_gain_alone(model, response)) return separation::Hold::band_limited;
  if (const std::optional<PathCandidate> best =
          periodic ? best_of_periodic(response, entries, holds)
                   : best_candidate(response, entries, holds, /*periodic=*/false)) {
    set_modes(model, with_modes_above_sampling(best->model, best->hold,
                                               entries.front()->record.sampling_rate_hz()));
    model.has_base = true;
    model.base_misfit = best->misfit;
    return best->hold;
  }
  return separation::Hold::band_limited;
}

}  // namespace vibrissa::diagnosis
