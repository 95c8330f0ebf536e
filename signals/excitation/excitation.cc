#include "signals/excitation/excitation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/unit.h"
#include "signals/excitation/band_noise.h"
#include "signals/excitation/crest_factor.h"
#include "signals/excitation/multisine.h"
#include "signals/files/record_io.h"
#include "signals/record/channel_name.h"
#include "signals/spectra/fft.h"

namespace vibrissa::signals {

namespace {

using std::numbers::pi;
constexpr std::size_t most_samples = 1 << 28;

void require(bool holds, const std::string& message) {
  if (!holds) throw UserError("excitation: " + message);
}

void check_design(const ExcitationDesign& design) {
  require(design.sampling_rate_hz > 0. && std::isfinite(design.sampling_rate_hz),
          "sampling rate " + to_text(design.sampling_rate_hz) + " Hz is not positive and finite");
  require(design.high_hz < 0.5 * design.sampling_rate_hz,
          "highest frequency " + to_text(design.high_hz) +
              " Hz is not below half the sampling rate of " + to_text(design.sampling_rate_hz) +
              " Hz; lower the frequency or raise the sampling rate");
  require(design.period_samples >= 2, "a period of " + std::to_string(design.period_samples) +
                                          " samples is too short; take at least 2");
  require(design.peak > 0. && std::isfinite(design.peak),
          "peak " + to_text(design.peak) + " is not positive and finite");
  require(!design.levels.empty(), "no level is given; level 1 is the peak itself");
  for (const double level : design.levels)
    require(level > 0. && std::isfinite(level),
            "level " + to_text(level) + " is not positive and finite");
  require(design.n_realisations >= 1 && design.n_realisations <= 1000,
          "realisations must be 1 to 1000, not " + std::to_string(design.n_realisations));
  require(design.n_periods >= 1, "at least one period must be kept");
  require(
      design.n_periods < most_samples && design.n_lead_in_periods < most_samples &&
          design.period_samples <= most_samples / (design.n_periods + design.n_lead_in_periods),
      "the drive has more than " + std::to_string(most_samples) + " samples; take fewer periods");
  require(design.fade_s >= 0. && design.fade_s * design.sampling_rate_hz <=
                                     0.5 * static_cast<double>(design.period_samples),
          "a fade of " + to_text(design.fade_s) +
              " s does not fit twice into the sweep; take a shorter fade or a longer period");
  const bool one_alone =
      design.kind == ExcitationKind::sweep ||
      (design.kind == ExcitationKind::multisine && design.phase == PhaseRule::schroeder);
  require(!one_alone || design.n_realisations == 1,
          "sweeps and Schroeder phases have only one realisation; for " +
              std::to_string(design.n_realisations) +
              " realisations take random or optimised phases, or noise");
}

std::uint64_t seed_of(const ExcitationDesign& design, std::size_t realisation) {
  std::seed_seq sequence{design.seed & 0xffffffffu, design.seed >> 32,
                         static_cast<std::uint64_t>(realisation)};
  std::array<std::uint32_t, 2> words{};
  sequence.generate(words.begin(), words.end());
  return (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
}

std::vector<double> schroeder_phases(std::size_t n) {
  std::vector<double> phase(n);
  for (std::size_t i = 0; i < n; ++i)
    phase[i] = -pi * static_cast<double>(i * (i + 1) % (2 * n)) / static_cast<double>(n);
  return phase;
}

std::vector<double> random_phases(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> phase(n);
  for (double& angle : phase)
    angle = 2. * pi * std::ldexp(static_cast<double>(random() >> 11), -53);
  return phase;
}

std::vector<double> phases_of(const ExcitationDesign& design, const std::vector<std::size_t>& order,
                              std::size_t realisation) {
  const std::size_t n = order.size();
  const bool begins_with_schroeder = design.phase != PhaseRule::random && realisation == 1;
  const auto start =
      begins_with_schroeder ? schroeder_phases(n) : random_phases(n, seed_of(design, realisation));
  if (design.phase != PhaseRule::optimised) return start;
  return lower_crest_factor(order, std::vector<double>(n, 1.), start);
}

// One period of the flat sum; the peak includes the values between the samples.
Drive multisine_drive(const ExcitationDesign& design, const std::vector<std::size_t>& order,
                      std::size_t realisation, double& amplitude) {
  Drive drive{.realisation = realisation,
              .crest_factor = 0.,
              .period = {},
              .phase_rad = phases_of(design, order, realisation)};
  const std::vector<double> flat(order.size(), 1.);
  drive.crest_factor = crest_factor_of_period(order, flat, drive.phase_rad);
  amplitude =
      design.peak / (drive.crest_factor * std::sqrt(0.5 * static_cast<double>(order.size())));
  RealFft fft(design.period_samples);
  std::ranges::fill(fft.spectrum(), 0.);
  for (std::size_t i = 0; i < order.size(); ++i)
    fft.spectrum()[order[i]] = std::polar(
        0.5 * amplitude * static_cast<double>(design.period_samples), drive.phase_rad[i]);
  fft.inverse();
  drive.period.assign(fft.time().begin(), fft.time().end());
  return drive;
}

Drive sampled_drive(const ExcitationDesign& design, std::size_t realisation) {
  Drive drive{.realisation = realisation, .crest_factor = 0., .period = {}, .phase_rad = {}};
  if (design.kind == ExcitationKind::sweep) {
    drive.period = sample(
        SweptSine{design.low_hz, design.high_hz, design.sweep_law, design.peak,
                  design.period_samples,
                  static_cast<std::size_t>(std::lround(design.fade_s * design.sampling_rate_hz))},
        design.sampling_rate_hz);
  } else {
    drive.period = sample(BandNoise{design.low_hz, design.high_hz, design.peak,
                                    design.period_samples, seed_of(design, realisation)},
                          design.sampling_rate_hz);
  }
  drive.crest_factor = crest_factor(drive.period);
  return drive;
}

std::vector<DescribedLine> described_lines(const ExcitationDesign& design) {
  const double resolution = design.sampling_rate_hz / static_cast<double>(design.period_samples);
  std::vector<DescribedLine> lines;
  const GridBand band{design.low_hz, design.high_hz, resolution, design.group_size, design.seed};
  for (const GridLine& line : grid_lines(design.grid, band))
    lines.push_back({line.order, static_cast<double>(line.order) * resolution, line.role, 0.});
  return lines;
}

std::vector<std::size_t> excited_orders(const std::vector<DescribedLine>& lines) {
  std::vector<std::size_t> order;
  for (const DescribedLine& line : lines)
    if (line.role == LineRole::excited) order.push_back(line.order);
  return order;
}

}  // namespace

double DesignedExcitation::resolution_hz() const {
  return design.sampling_rate_hz / static_cast<double>(design.period_samples);
}

double DesignedExcitation::full_scale() const {
  return design.peak * std::ranges::max(design.levels);
}

std::vector<double> DesignedExcitation::samples(const Drive& drive) const {
  std::vector<double> result;
  const std::size_t n = design.n_lead_in_periods + design.n_periods;
  result.reserve(n * drive.period.size());
  for (std::size_t p = 0; p < n; ++p)
    result.insert(result.end(), drive.period.begin(), drive.period.end());
  return result;
}

DesignedExcitation design_excitation(const ExcitationDesign& design) {
  check_design(design);
  DesignedExcitation result{design, {}, {}};
  if (design.kind == ExcitationKind::multisine) result.lines = described_lines(design);
  const auto order = excited_orders(result.lines);
  std::vector<Drive> realisations;
  for (std::size_t r = 1; r <= design.n_realisations; ++r) {
    double amplitude = 0.;
    realisations.push_back(design.kind == ExcitationKind::multisine
                               ? multisine_drive(design, order, r, amplitude)
                               : sampled_drive(design, r));
    if (r > 1) continue;
    for (DescribedLine& line : result.lines)
      line.amplitude = line.role == LineRole::excited ? amplitude : 0.;
  }
  for (const double level : design.levels)
    for (Drive drive : realisations) {
      drive.level = level;
      for (double& x : drive.period) x *= level;
      result.drives.push_back(std::move(drive));
    }
  return result;
}

void write_drive_record(const std::filesystem::path& file, const DesignedExcitation& excitation,
                        const Drive& drive, const std::string& channel) {
  std::vector<double> samples = excitation.samples(drive);
  const double scale = convert_unit(excitation.design.unit, unit_of_channel(channel)).scale;
  for (double& x : samples) x *= scale;
  Record record(excitation.design.sampling_rate_hz, samples.size());
  record.set_channel(channel, std::move(samples));
  write_record(file, record);
}

void write_drive_wav(const std::filesystem::path& file, const DesignedExcitation& excitation,
                     const Drive& drive, WavFormat format) {
  const std::vector<double> samples = excitation.samples(drive);
  write_wav(file, {.samples = samples,
                   .sampling_rate_hz = excitation.design.sampling_rate_hz,
                   .full_scale = excitation.full_scale(),
                   .unit = excitation.design.unit,
                   .format = format});
}

}  // namespace vibrissa::signals
