#include "diagnosis/noise_colour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnosis/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// A line more than this above its model is one of its own.
constexpr double most_of_a_line = 12.;
constexpr double least_gain = 8.;  // nats over white noise
constexpr double least_lead = 2.;  // nats over a random walk

/// Below it a mode that wanders leaves nothing between the lines of a drive.
constexpr double below_modes_hz = 15.;

/// Powers over that of the upper half of the spectrum; nothing where that is silent.
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

namespace {

/// Lines k of which n_periods is no divisor; all of them where there is one period.
void add_lines(std::vector<NoiseLine>& out, const signals::Record& record, const std::string& name,
               const std::size_t n_periods) {
  if (!record.has(name)) return;
  const std::vector<Complex> spectrum = spectrum_of(record.channel(name));
  const double n = static_cast<double>(record.n_samples());
  for (std::size_t k = 1; k + 1 < spectrum.size(); ++k) {
    const double f = static_cast<double>(k) * record.sampling_rate_hz() / n;
    const bool upper = k >= spectrum.size() / 2;
    if (n_periods > 1 && (k % n_periods == 0 || (f > below_modes_hz && !upper))) continue;
    out.push_back({f, std::norm(spectrum[k]) / n, upper});
  }
}

}  // namespace

ChannelColours channel_colours(const signals::Dataset& dataset) {
  std::vector<NoiseLine> moment, acceleration;
  double rate_hz = 0.;
  for (const signals::DatasetRecord& entry : dataset.records) {
    const signals::Record& record = entry.record;
    if (entry.split != signals::Split::fit) continue;
    // Records of another rate than the first would need a level of their own.
    if (rate_hz == 0.) rate_hz = record.sampling_rate_hz();
    if (record.sampling_rate_hz() != rate_hz) continue;
    const std::size_t period = entry.period_samples;
    const std::size_t n_periods =
        period > 0 && record.n_samples() % period == 0 ? record.n_samples() / period : 1;
    const bool still = entry.excitation == signals::Excitation{};
    if (still || (n_periods > 1 && !entry.excitation.wind))
      add_lines(moment, record, signals::channel::base_moment, still ? 1 : n_periods);
    if (!entry.excitation.base)
      add_lines(acceleration, record, signals::channel::base_acceleration, 1);
  }
  return {noise_colour(moment), noise_colour(acceleration)};
}

}  // namespace vibrissa::diagnosis
