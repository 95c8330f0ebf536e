#include "diagnosis/records/channel_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibrissa::diagnosis {
namespace {

/// A line more than this above the model is a tone and not noise.
constexpr double most_of_a_line = 12.;
constexpr double least_gain = 8.;  // nats relative to white noise
constexpr double least_lead = 2.;  // nats relative to a random walk

/// Below this frequency a varying mode leaves no power between the excited lines.
constexpr double below_modes_hz = 15.;

/// Powers relative to that of the upper half of the spectrum; nothing when that power is zero.
std::vector<NoiseLine> related(const std::span<const NoiseLine> lines) {
  double upper = 0., n_upper = 0.;
  for (const NoiseLine& line : lines)
    if (line.reference) {
      upper += line.power;
      n_upper += 1.;
    }
  if (upper <= 0.) return {};
  std::vector<NoiseLine> out(lines.begin(), lines.end());
  for (NoiseLine& line : out) line.power *= n_upper / upper;
  return out;
}

template <class Density>
double log_likelihood(const std::vector<NoiseLine>& lines, const Density& density) {
  double sum = 0.;
  for (const NoiseLine& line : lines) {
    const double d = density(line.frequency_hz);
    sum -= std::log(d) + std::min(line.power / d, most_of_a_line);
  }
  return sum;
}

std::vector<double> ladder(const double low, const double high, const int n) {
  std::vector<double> out;
  for (int i = 0; i <= n; ++i)
    out.push_back(low * std::pow(high / low, static_cast<double>(i) / n));
  return out;
}

double best_walk(const std::vector<NoiseLine>& lines) {
  double best = -std::numeric_limits<double>::infinity();
  for (const double at_one_hz : ladder(1e-3, 1e5, 80))
    best =
        std::max(best, log_likelihood(lines, [&](double f) { return 1. + at_one_hz / (f * f); }));
  return best;
}

/// Lines k that are not multiples of step; all lines when it is 1.
void add_lines(std::vector<NoiseLine>& out, const signals::Record& record, const NoiseLines& lines,
               const std::size_t step) {
  const double n = static_cast<double>(record.n_samples());
  for (std::size_t k = 1; k + 1 < lines.end; ++k) {
    const double f = static_cast<double>(k) * record.sampling_rate_hz() / n;
    const bool upper = k >= lines.end / 2;
    if (step > 1 && (k % step == 0 || (f > below_modes_hz && !upper))) continue;
    out.push_back({f, std::norm(lines.spectrum[k]) / n, upper});
  }
}

void add_moment(std::vector<NoiseLine>& out, const signals::Record& record,
                const std::size_t step) {
  if (!record.has(signals::channel::base_moment)) return;
  add_lines(out, record, all_lines(record.channel(signals::channel::base_moment)), step);
}

void add_still_acceleration(std::vector<NoiseLine>& out, const signals::Record& record) {
  if (!record.has(signals::channel::base_acceleration)) return;
  const auto x = record.channel(signals::channel::base_acceleration);
  add_lines(out, record, noise_lines(x, record.sampling_rate_hz(), false), 1);
}

}  // namespace

double NoiseColour::density(const double frequency_hz) const {
  const double ratio = frequency_hz / corner_hz;
  return 1. + excess / (1. + ratio * ratio);
}

NoiseColour noise_colour(const std::span<const NoiseLine> measured) {
  const std::vector<NoiseLine> lines = related(measured);
  if (lines.empty()) return {};
  NoiseColour best;
  double best_likelihood = -std::numeric_limits<double>::infinity();
  for (const double corner_hz : ladder(2., 20., 12))
    for (const double excess : ladder(0.02, 20., 40)) {
      const NoiseColour colour{excess, corner_hz};
      const double value = log_likelihood(lines, [&](double f) { return colour.density(f); });
      if (value > best_likelihood) {
        best_likelihood = value;
        best = colour;
      }
    }
  const double white = log_likelihood(lines, [](double) { return 1.; });
  const bool coloured =
      best_likelihood > white + least_gain && best_likelihood > best_walk(lines) + least_lead;
  return coloured ? best : NoiseColour{};
}

ChannelColours channel_colours(const signals::Dataset& dataset) {
  std::vector<NoiseLine> moment, acceleration;
  double rate_hz = 0.;
  for (const signals::DatasetRecord& entry : dataset.records) {
    const signals::Record& record = entry.record;
    if (entry.split != signals::Split::fit) continue;
    // Only records with the sampling rate of the first one, because others need a different level.
    if (rate_hz == 0.) rate_hz = record.sampling_rate_hz();
    if (record.sampling_rate_hz() != rate_hz) continue;
    const bool still = entry.excitation == signals::Excitation{};
    if (still || (n_periods(entry) > 1 && !entry.excitation.wind))
      add_moment(moment, record, still ? 1 : n_periods(entry));
    if (!entry.excitation.base) add_still_acceleration(acceleration, record);
  }
  return {noise_colour(moment), noise_colour(acceleration)};
}

}  // namespace vibrissa::diagnosis
