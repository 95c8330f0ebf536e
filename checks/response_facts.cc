#include "checks/response_facts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "checks/response_change.h"
#include "diagnosis/checks/data_checks.h"
#include "diagnosis/model/words.h"
#include "diagnosis/records/spectrum.h"
#include "separation/identification/identify.h"
#include "separation/metrics/coherent_power.h"
#include "separation/verdict/coherence.h"
#include "separation/verdict/verdict.h"
#include "signals/base/error.h"
#include "signals/base/median.h"
#include "signals/spectra/fft.h"
#include "signals/spectra/local_polynomial.h"

namespace vibrissa::checks {
namespace {

using diagnosis::FindingKind;
using diagnosis::percent;
using diagnosis::three_digits;
using separation::CoherentLines;
namespace channel = signals::channel;

/// Largest mean square that a line of hum of mean square 1 leaves at this distance under the Hann
/// window [lines]: 2/3 in its main lobe, below 2/3 / (pi d (d^2 - 1))^2 beyond.
double leakage(double distance) {
  constexpr double main_lobe = 2., centre = 2. / 3.;
  if (distance <= main_lobe) return centre;
  const double falls = std::numbers::pi * distance * (distance * distance - 1.);
  return centre / (falls * falls);
}

/// Share of the power of each line that the hum of a channel may be, at most 1.
std::vector<double> hum_share(std::span<const double> x, double rate_hz,
                              const std::vector<HumLine>& hum, const std::vector<double>& at_hz) {
  const double line_hz = at_hz.front();
  const auto spectrum = signals::welch_spectrum(
      x, rate_hz, {.segment_samples = std::size_t(std::lround(rate_hz / line_hz))});
  constexpr double grid_share = 2e-3;  // by which the mains wander
  std::vector<double> out(at_hz.size(), 0.);
  for (std::size_t i = 0; i < at_hz.size(); ++i) {
    double square = 0.;
    for (const HumLine& line : hum) {
      const double off = std::abs(at_hz[i] - line.frequency_hz) - grid_share * line.frequency_hz;
      square += line.rms * line.rms * leakage(off / line_hz);
    }
    const double measured = spectrum.density[i + 1] * line_hz;
    out[i] = measured > 0. ? std::min(1., square / measured) : 0.;
  }
  return out;
}

/// Coherent lines without that of the mean, and without those whose coherence the hum of both
/// channels may cause: the product of its shares of their power.
std::vector<std::size_t> telling_lines(const CoherentLines& found, const signals::Record& record,
                                       const ChannelHum& hum) {
  const auto& f = found.response.frequency_hz;
  const auto share = [&](const std::string& name, const std::vector<HumLine>& lines) {
    return hum_share(record.channel(name), record.sampling_rate_hz(), lines, f);
  };
  const auto of_base = share(channel::base_acceleration, hum.acceleration),
             of_moment = share(channel::base_moment, hum.moment);
  std::vector<std::size_t> out;
  for (const std::size_t i : found.lines)
    if (i > 0 && of_base[i] * of_moment[i] < 0.25 * found.limit) out.push_back(i);
  return out;
}

/// Share of the moment's variance that a smooth response to the acceleration explains
/// (signals/spectra/local_polynomial.h), which takes no leakage of a sharp resonance for noise.
/// Nothing where the input does not determine it.
std::optional<double> smooth_share(const signals::Record& record) {
  const auto acceleration = record.channel(channel::base_acceleration),
             moment = record.channel(channel::base_moment);
  signals::FrequencyResponse found;
  try {
    found = signals::local_polynomial_response(acceleration, moment, record.sampling_rate_hz())
                .response;
  } catch (const signals::UserError&) {
    return std::nullopt;  // shorter than one window
  }
  const auto input = signals::real_fft(acceleration), output = signals::real_fft(moment);
  double explained = 0., all = 0.;
  for (std::size_t i = 0; i < found.value.size(); ++i) {
    all += std::norm(output[i + 1]);
    const double deviation = found.standard_deviation[i];
    if (std::isfinite(deviation))
      explained += (std::norm(found.value[i]) - deviation * deviation) * std::norm(input[i + 1]);
  }
  if (all == 0.) return std::nullopt;
  return explained / all;
}

class ResponseCheck {
 public:
  ResponseCheck(const signals::Record& record, const DriveFacts& drive,
                std::vector<Finding>& findings)
      : record_(record), drive_(drive), findings_(findings) {}

  ResponseFacts run(const ChannelHum& hum);

 private:
  void add(FindingKind kind, const std::string& name, std::optional<double> value,
           const std::string& unit, const std::string& sentence, Severity severity) {
    findings_.push_back({kind, name, value, unit, sentence, severity});
  }
  bool check_coherence();
  bool is_driven_at_coherent_lines() const;
  bool follows_by_model();
  void check_gain();
  void check_sign();
  bool is_coherent_above() const;
  void check_aliasing();
  void check_model();
  void report_delay(const separation::Estimate& delay_s);
  void check_change();

  const signals::Record& record_;
  const DriveFacts& drive_;
  std::vector<Finding>& findings_;
  CoherentLines found_;
  std::vector<std::size_t> lines_;
  ResponseFacts facts_;
};

// More modes and the whole record take long, and can give more.
struct PartModel {
  separation::Identification found;
  separation::Verdict verdict;
  double duration_s;
};

PartModel model_of_part(const signals::Record& record) {
  constexpr std::size_t most_samples = 30000, few_poles = 6;
  const signals::Record part = record.slice(0, std::min(record.n_samples(), most_samples));
  auto found = separation::identify_record(part, {.max_order = few_poles});
  auto verdict = separation::judge(found, part);
  // The response to a hit is short, and a structure rings in many modes.
  if (!verdict.usable && found.n_hits > 0) {
    found = separation::identify_record(part);
    verdict = separation::judge(found, part);
  }
  return {std::move(found), std::move(verdict), part.duration_s()};
}

/// Do the coherent lines hold most of the drive? Then they are the drive's own: tones.
bool ResponseCheck::is_driven_at_coherent_lines() const {
  const signals::PowerSpectrum drive = signals::welch_spectrum(
      record_.channel(channel::base_acceleration), record_.sampling_rate_hz(), found_.welch);
  double coherent = 0.;
  for (const std::size_t i : found_.lines) coherent += drive.density[i + 1];  // without zero
  return coherent > 0.5 * std::accumulate(drive.density.begin(), drive.density.end(), 0.);
}

/// A resonance that is narrower than Welch's lines leaks over them, and few or none are coherent,
/// though the drive is wide. A model of tones would explain tones.
bool ResponseCheck::follows_by_model() {
  if (is_driven_at_coherent_lines()) return false;
  try {
    const PartModel model = model_of_part(record_);
    if (!model.verdict.usable) return false;
    const double share = model.found.held_out_vaf_percent / 100.;
    facts_.coherent_share = separation::Estimate{share, 0.};
    add(FindingKind::no_coherence, channel::base_moment, share, "1",
        "the averaged spectra are hardly coherent, because the resonance is narrower than their "
        "lines (" +
            three_digits(found_.response.frequency_hz.front()) + " Hz apart); a model explains " +
            percent(share) + " of the variance of unseen data",
        Severity::note);
    return true;
  } catch (const signals::UserError&) {
    return false;  // nothing to model
  }
}

/// Says whether the moment follows the acceleration.
bool ResponseCheck::check_coherence() {
  const std::string& moment = channel::base_moment;
  if (lines_.empty()) {
    add(FindingKind::no_coherence, moment, 0., "1",
        "base_moment_N_m does not follow base_acceleration_m_s2 at any frequency (coherence "
        "below " +
            three_digits(found_.limit) +
            "): check that both are connected, and drive the base above its noise",
        Severity::stops);
    return false;
  }
  if (lines_.size() < fewest_coherent_lines) {
    add(FindingKind::few_lines, moment, double(lines_.size()), "1",
        "base_moment_N_m follows base_acceleration_m_s2 at " + std::to_string(lines_.size()) +
            " frequencies only, and a resonance needs " + std::to_string(fewest_coherent_lines) +
            ": drive a band (noise, sweep, multisine), not a tone",
        Severity::stops);
    return false;
  }
  if (drive_.kind == DriveKind::hits) return true;
  const auto coherent =
      separation::coherent_power(record_.channel(channel::base_acceleration),
                                 record_.channel(moment), record_.sampling_rate_hz());
  const double rms = diagnosis::rms_about_mean(record_.channel(moment));
  // Either is too low where a resonance is sharper than its lines.
  const double share_of_lines = coherent.value_n2_m2 / (rms * rms);
  facts_.coherent_share = separation::Estimate{
      std::clamp(std::max(share_of_lines, smooth_share(record_).value_or(0.)), 0., 1.),
      coherent.deviation_n2_m2 / (rms * rms)};
  // A model that explains less of the variance than it leaves is not usable (verdict.h).
  const separation::Estimate& share = *facts_.coherent_share;
  if (share.value - 2. * share.standard_deviation < 0.5)
    add(FindingKind::poor_coherence, moment, share.value, "1",
        "only " + percent(share.value) +
            " of the variance of base_moment_N_m follows base_acceleration_m_s2: record without "
            "wind, at a higher level, with less noise",
        share.value + 2. * share.standard_deviation < 0.5 ? Severity::stops : Severity::limits);
  return true;
}

/// The inverse of a response with a resonance has a dip where the response has its peak.
void ResponseCheck::check_gain() {
  std::vector<double> gains;
  for (const std::size_t i : lines_) gains.push_back(std::abs(found_.response.value[i]));
  facts_.gain_kg_m = signals::median(gains);
  // A moment of 10 N m at the acceleration of gravity: more has no sensor on a bench
  // (signals/record/plausibility.h).
  constexpr double most_kg_m = 1.;
  if (facts_.gain_kg_m < most_kg_m) return;
  const auto [low, high] = std::ranges::minmax(gains);
  const bool has_dip = facts_.gain_kg_m / low > high / facts_.gain_kg_m;
  if (has_dip)
    add(FindingKind::swapped_columns, "", facts_.gain_kg_m, "kg m",
        "base_acceleration_m_s2 and base_moment_N_m seem to be exchanged: the moment is " +
            three_digits(facts_.gain_kg_m) +
            " times the acceleration and has a dip where a sensor has its resonance",
        Severity::stops);
  else
    add(FindingKind::wrong_unit, channel::base_moment, facts_.gain_kg_m, "kg m",
        "base_moment_N_m is " + three_digits(facts_.gain_kg_m) +
            " times the acceleration, more than a sensor's mass times its height: it is not in "
            "N m; give its unit or calibration, as in --column 'base_moment=M[mN mm]'",
        Severity::limits);
}

/// Well below the resonance the moment is opposite to the acceleration (docs/records.md).
void ResponseCheck::check_sign() {
  const auto& h = found_.response;
  const auto peak =
      *std::ranges::max_element(lines_, {}, [&](std::size_t i) { return std::abs(h.value[i]); });
  constexpr double slow = 0.4;  // as in the comparison with a simulation
  double sum = 0., variance = 0.;
  for (const std::size_t i : lines_) {
    if (h.frequency_hz[i] > slow * h.frequency_hz[peak]) continue;
    if (std::abs(h.value[i]) > 0.5 * std::abs(h.value[peak])) return;  // no resonance stands out
    const double weight = 1. / (h.standard_deviation[i] * h.standard_deviation[i]);
    sum += weight * h.value[i].real();
    variance += 0.5 * weight;
  }
  constexpr double significant = 4.;  // standard deviations
  if (variance > 0. && sum > significant * std::sqrt(variance))
    add(FindingKind::reversed_sign, channel::base_moment, sum / std::sqrt(variance), "1",
        "base_moment_N_m has the sign of base_acceleration_m_s2 well below the resonance; "
        "by the convention of docs/records.md it is opposite: multiply one of them by -1",
        Severity::limits);
}

/// What is folded into the upper half of the band does not belong to the response there: the
/// coherence falls by its share.
bool ResponseCheck::is_coherent_above() const {
  constexpr double from = 0.5, to = 0.8, folded = 0.1;  // close to half the rate both are alike
  const double half_hz = record_.sampling_rate_hz() / 2.;
  std::vector<double> coherence;
  for (std::size_t i = 0; i < found_.response.frequency_hz.size(); ++i) {
    const double f = found_.response.frequency_hz[i] / half_hz;
    if (f > from && f < to && i < found_.response.coherence.size())
      coherence.push_back(found_.response.coherence[i]);
  }
  return !coherence.empty() && signals::median(coherence) > 1. / (1. + folded);
}

/// Behind a low-pass, the power at half the rate is far below that of the excited band. A drive
/// that is white up to there looks the same, but the moment follows it.
void ResponseCheck::check_aliasing() {
  const double half_hz = record_.sampling_rate_hz() / 2.;
  constexpr double top = 0.95, low_pass = 0.1;
  double share = 0.;
  if (drive_.kind == DriveKind::hits) {
    share = facts_.band.high_hz >= top * half_hz ? 1. : 0.;
  } else {
    const auto spectrum = signals::welch_spectrum(
        record_.channel(channel::base_acceleration), record_.sampling_rate_hz(),
        {.segment_samples =
             std::size_t(std::lround(2. * half_hz / found_.response.frequency_hz[0]))});
    // Mean density of the drive, weighted by its power: lines of noise do not count.
    double power = 0., weighted = 0.;
    std::vector<double> highest;
    for (const std::size_t i : lines_) {
      power += spectrum.density[i + 1];
      weighted += spectrum.density[i + 1] * spectrum.density[i + 1];
    }
    for (std::size_t k = 1; k + 1 < spectrum.density.size(); ++k)
      if (spectrum.frequency_hz[k] > top * half_hz) highest.push_back(spectrum.density[k]);
    if (highest.empty()) return;
    share = signals::median(highest) * power / weighted;
  }
  if (share > low_pass && !is_coherent_above())
    add(FindingKind::possible_aliasing, channel::base_acceleration, share, "1",
        "base_acceleration_m_s2 has power up to half the sampling rate (" + three_digits(half_hz) +
            " Hz), and base_moment_N_m does not follow all of it: no low-pass acted before "
            "sampling, so what lies above may be folded into the record; sample faster or filter "
            "before",
        Severity::limits);
}

void ResponseCheck::report_delay(const separation::Estimate& delay_s) {
  facts_.delay_s = delay_s;
  const double ms = 1e3 * delay_s.value;
  const bool is_of_one_chain = ms > 0. && delay_s.value <= diagnosis::longest_delay_s;
  add(FindingKind::channel_delay, channel::base_moment, delay_s.value, "s",
      std::string("base_moment_N_m ") + (ms < 0. ? "leads" : "lags behind") +
          " base_acceleration_m_s2 by " + three_digits(std::abs(ms)) + " ms" +
          (is_of_one_chain ? ": a filter or a conversion time"
                           : ": two clocks; record both channels by one converter"),
      is_of_one_chain ? Severity::note : Severity::limits);
}

/// What `identify` says of the first part of the record, with few modes.
void ResponseCheck::check_model() {
  try {
    const auto& [found, verdict, duration_s] = model_of_part(record_);
    // Noise hides much of the moment, not the delay of what is left.
    const auto& delay_s = found.found_delay_s;
    const bool is_told = delay_s && !verdict.determined.empty() &&
                         std::abs(delay_s->value) > 2. * delay_s->standard_deviation;
    if (delay_s && (verdict.usable || is_told)) report_delay(*delay_s);
    if (!verdict.usable)
      add(FindingKind::no_usable_model, channel::base_moment, found.held_out_vaf_percent, "%",
          "a model of " + std::string(found.n_hits > 0 ? "" : "up to three modes of ") +
              three_digits(duration_s) + " s is not usable: " + verdict.sentence +
              " Drive a wide band at a steady level to the end of the record",
          Severity::limits);
  } catch (const signals::UserError& error) {
    add(FindingKind::no_usable_model, channel::base_moment, std::nullopt, "", error.what(),
        Severity::limits);
  }
}

void ResponseCheck::check_change() {
  if (drive_.kind == DriveKind::hits || drive_.end_s) return;
  const auto change = response_change(record_, drive_.period_samples);
  if (!change) return;
  add(FindingKind::changing_response, channel::base_moment, change->share, "1",
      "the response of base_moment_N_m to base_acceleration_m_s2 changes during the record by " +
          percent(change->share) + " (rms; chance " + three_digits(change->p_value) +
          "): check mount, cables, temperature and clocks, and record again",
      Severity::limits);
}

ResponseFacts ResponseCheck::run(const ChannelHum& hum) {
  const auto found = separation::coherent_lines(record_);
  facts_.band = separation::coherent_band(record_, found);
  if (!found) return facts_;
  found_ = *found;
  lines_ = telling_lines(found_, record_, hum);
  facts_.n_lines = found_.response.value.size();
  facts_.n_coherent = lines_.size();
  const auto n_before = std::ssize(findings_);
  const bool has_lines = check_coherence();
  const auto n_coherence = std::ssize(findings_);
  const bool stops =
      std::any_of(findings_.begin() + n_before, findings_.end(),
                  [](const Finding& finding) { return finding.severity == Severity::stops; });
  if (stops && follows_by_model()) {
    findings_.erase(findings_.begin() + n_before, findings_.begin() + n_coherence);
    return facts_;
  }
  if (!has_lines) return facts_;
  check_gain();
  check_sign();
  check_aliasing();
  check_model();
  check_change();
  return facts_;
}

}  // namespace

ResponseFacts response_facts(const signals::Record& record, const DriveFacts& drive,
                             const ChannelHum& hum, std::vector<Finding>& findings) {
  return ResponseCheck(record, drive, findings).run(hum);
}

}  // namespace vibrissa::checks
