#include "diagnosis/location.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <sstream>

#include "diagnosis/chain_simulation.h"
#include "diagnosis/judged_samples.h"
#include "diagnosis/significance_tests.h"
#include "diagnosis/spectrum.h"
#include "diagnosis/words.h"

namespace vibrissa::diagnosis {
namespace {

constexpr double significant = 0.01;
/// Fewest bins of a band: below it the variance ratio's tail is a guess.
constexpr std::size_t fewest_bins = 6;

/// Error of the nominal model in one record.
struct RecordGap {
  const PreparedRecord* record = nullptr;
  std::vector<Complex> predicted, error;
  std::vector<double> variance;
};

std::string kind_of(const PreparedRecord& record) {
  if (record.excitation.base && record.excitation.wind) return "product";
  if (record.excitation.base) return "base";
  return record.excitation.wind ? "wind" : "rest";
}

/// Degrees of freedom of the noise levels: lines where nothing moves, upper half of the spectrum.
double noise_degrees(const Experiment& experiment) {
  double lines = 0.;
  for (const PreparedRecord& record : experiment.records)
    lines += kind_of(record) == "rest"
                 ? static_cast<double>(record.n_bins())
                 : (record.periodic ? static_cast<double>(record.n_acceleration_noise) : 0.);
  // Without any such line the level is a guess of a factor of two.
  return std::max(lines, 8.);
}

/// What records at rest hold beside white noise.
struct RestNoise {
  bool coloured = false;
  double p_value = 1.;
  double bin_hz = 1.;
  std::vector<double> excess;      // at least 1: power of the bins, smoothed, over white noise
  std::vector<double> lines_hz{};  // single lines
};

/// Power of white noise from the median of the upper half, where slow drift does not reach.
double white_power(const std::vector<double>& power) {
  std::vector<double> upper(power.begin() + static_cast<std::ptrdiff_t>(power.size() / 2),
                            power.end());
  const auto middle = upper.begin() + static_cast<std::ptrdiff_t>(upper.size() / 2);
  std::nth_element(upper.begin(), middle, upper.end());
  return *middle / std::numbers::ln2;
}

RestNoise rest_noise(const Experiment& experiment) {
  RestNoise out;
  for (const PreparedRecord& record : experiment.records) {
    if (kind_of(record) != "rest") continue;
    std::vector<double> power = powers(record.moment);
    const double white = white_power(power);
    for (double& p : power) p /= white;
    std::vector<double> tests;
    std::vector<std::size_t> line_bins;
    const double n = static_cast<double>(power.size());
    for (std::size_t b = 0; b < power.size(); ++b)
      if (n * std::exp(-power[b]) < 0.1 * significant) line_bins.push_back(b);
    const double highest = *std::max_element(power.begin(), power.end());
    tests.push_back(std::max(1e-300, std::min(1., n * std::exp(-highest))));
    for (std::size_t low = 0; low + fewest_bins <= power.size(); low = 2 * low + fewest_bins) {
      const std::size_t high = std::min(power.size(), 2 * low + fewest_bins);
      const double mean = std::accumulate(power.begin() + static_cast<std::ptrdiff_t>(low),
                                          power.begin() + static_cast<std::ptrdiff_t>(high), 0.) /
                          static_cast<double>(high - low);
      tests.push_back(variance_ratio_tail(mean, 2. * static_cast<double>(high - low), 0.5 * n));
    }
    const std::vector<double> corrected = holm_corrected(tests);
    const double p = *std::min_element(corrected.begin(), corrected.end());
    if (p >= out.p_value) continue;
    out.p_value = p;
    out.coloured = p < significant;
    out.bin_hz = record.bin_hz();
    out.excess = neighbour_mean(power, 3);
    out.lines_hz.clear();
    for (const std::size_t b : line_bins)
      out.lines_hz.push_back(record.bin_hz() * static_cast<double>(b + 1));
  }
  return out;
}

RecordGap gap_of(const Experiment& experiment, const PreparedRecord& record,
                 const RestNoise& rest) {
  const Prediction prediction = simulate({.structure = experiment.nominal}, record);
  RecordGap gap{
      .record = &record, .predicted = prediction.mean, .error = record.moment, .variance = {}};
  const double misfit =
      record.excitation.wind ? experiment.nominal.wind_misfit : experiment.nominal.base_misfit;
  const std::vector<double> level = neighbour_mean(powers(prediction.mean), 10);
  const double moment = experiment.moment_noise * experiment.moment_noise;
  const double acceleration = experiment.acceleration_noise * experiment.acceleration_noise;
  for (std::size_t b = 0; b < gap.error.size(); ++b) {
    gap.error[b] -= prediction.mean[b];
    double own = moment * prediction.moment_noise[b];
    if (rest.coloured) {
      const auto bin = static_cast<std::size_t>(
          std::lround(record.bin_hz() * static_cast<double>(b + 1) / rest.bin_hz));
      own *= std::max(1., rest.excess[std::clamp<std::size_t>(bin, 1, rest.excess.size()) - 1]);
    }
    gap.variance.push_back(own + acceleration * prediction.acceleration_noise[b] +
                           misfit * misfit * level[b]);
  }
  return gap;
}

/// Does a line that is there at rest fall on this bin?
bool on_rest_line(const RestNoise& rest, const PreparedRecord& record, std::size_t b) {
  const double f = record.bin_hz() * static_cast<double>(b + 1);
  return std::any_of(rest.lines_hz.begin(), rest.lines_hz.end(), [&](double line) {
    return std::abs(f - line) < 3. * std::max(rest.bin_hz, record.bin_hz());
  });
}

/// Edges of third octaves up to half the largest rate, none narrower than the bins allow.
std::vector<double> band_edges_hz(const Experiment& experiment) {
  double nyquist_hz = 0., bin_hz = 0.;
  for (const PreparedRecord& record : experiment.records) {
    nyquist_hz = std::max(nyquist_hz, 0.5 * record.sampling_rate_hz);
    bin_hz = std::max(bin_hz, record.bin_hz());
  }
  std::vector<double> edges{0.};
  for (double f = 1.; f < nyquist_hz; f *= std::cbrt(2.))
    if (f - edges.back() >= static_cast<double>(fewest_bins) * bin_hz) edges.push_back(f);
  if (edges.size() > 1) edges.pop_back();
  edges.push_back(nyquist_hz);
  return edges;
}

ChannelGap channel_gap(const std::string& channel, const std::vector<RecordGap>& gaps,
                       const RestNoise& rest, const std::vector<double>& edges,
                       double noise_degrees) {
  ChannelGap out{.channel = channel};
  double measured = 0.;
  for (const RecordGap& gap : gaps)
    for (const Complex& m : gap.record->moment) measured += std::norm(m);
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    double whitened = 0., error = 0., n = 0.;
    for (const RecordGap& gap : gaps)
      for (std::size_t b = 0; b < gap.error.size(); ++b) {
        const double f = gap.record->bin_hz() * static_cast<double>(b + 1);
        if (f < edges[e] || f >= edges[e + 1] || on_rest_line(rest, *gap.record, b)) continue;
        whitened += std::norm(gap.error[b]) / gap.variance[b];
        error += std::norm(gap.error[b]);
        n += 1.;
      }
    if (n < static_cast<double>(fewest_bins)) continue;
    out.bands.push_back({.low_hz = edges[e],
                         .high_hz = edges[e + 1],
                         .nrmse = std::sqrt(error / measured),
                         .excess = whitened / n,
                         .p_value = variance_ratio_tail(whitened / n, 2. * n, noise_degrees)});
  }
  return out;
}

void correct(std::vector<ChannelGap>& map) {
  std::vector<double> p_values;
  for (const ChannelGap& channel : map)
    for (const BandGap& band : channel.bands) p_values.push_back(band.p_value);
  const std::vector<double> corrected = holm_corrected(p_values);
  std::size_t i = 0;
  for (ChannelGap& channel : map)
    for (BandGap& band : channel.bands) {
      band.p_value = corrected[i++];
      channel.p_value = std::min(channel.p_value, band.p_value);
    }
}

/// Significant bands of all kinds of records, neighbours merged.
std::vector<std::array<double, 2>> merged_bands(const std::vector<ChannelGap>& map) {
  std::map<double, double> bands;
  for (const ChannelGap& channel : map)
    for (const BandGap& band : channel.bands)
      if (band.p_value < significant) bands[band.low_hz] = band.high_hz;
  std::vector<std::array<double, 2>> merged;
  for (const auto& [low, high] : bands) {
    if (!merged.empty() && low <= merged.back()[1])
      merged.back()[1] = std::max(high, merged.back()[1]);
    else
      merged.push_back({low, high});
  }
  return merged;
}

/// Mode nearest to the band with the largest error; none when it is more than an octave away.
std::optional<std::size_t> nearest_mode(const NominalModel& nominal,
                                        const std::vector<ChannelGap>& map) {
  const BandGap* strongest = nullptr;
  for (const ChannelGap& channel : map)
    for (const BandGap& band : channel.bands)
      if (band.p_value < significant && (strongest == nullptr || band.nrmse > strongest->nrmse))
        strongest = &band;
  if (strongest == nullptr) return std::nullopt;
  const double centre_hz = 0.5 * (strongest->low_hz + strongest->high_hz);
  std::vector<double> modes_hz;
  for (const StructuralMode& mode : nominal.modes)
    modes_hz.push_back(mode.frequency_rad_s / (2. * std::numbers::pi));
  std::sort(modes_hz.begin(), modes_hz.end());
  std::optional<std::size_t> best;
  double least = std::numbers::ln2;
  for (std::size_t i = 0; i < modes_hz.size(); ++i)
    if (const double away = std::abs(std::log(modes_hz[i] / centre_hz)); away < least) {
      least = away;
      best = i + 1;
    }
  return best;
}

/// Relative gap at excited lines of one record, noise taken off, against the level of its motion.
struct LevelPoint {
  double log_level = 0., log_gap = 0., variance = 0.;
};

std::optional<LevelPoint> level_point(const RecordGap& gap) {
  const PreparedRecord& record = *gap.record;
  double level = 0., error = 0., noise = 0., noise_square = 0., measured = 0.;
  for (std::size_t b = 0; b < gap.error.size(); ++b) {
    const double a = std::norm(record.acceleration[record.whole_line(b)]);
    if (a == 0.) continue;
    level += a;
    error += std::norm(gap.error[b]);
    noise += gap.variance[b];
    noise_square += gap.variance[b] * (gap.variance[b] + 2. * std::norm(gap.error[b]));
    measured += std::norm(record.moment[b]);
  }
  const double square = error - noise;
  if (!(square > 3. * std::sqrt(noise_square)) || level == 0.) return std::nullopt;
  return LevelPoint{0.5 * std::log(level) - std::log(static_cast<double>(record.n_samples)),
                    0.5 * std::log(square / measured), 0.25 * noise_square / (square * square)};
}

void set_level_exponent(Location& out, const std::vector<RecordGap>& gaps) {
  std::vector<LevelPoint> points;
  for (const RecordGap& gap : gaps)
    if (kind_of(*gap.record) == "base" && gap.record->periodic)
      if (const auto point = level_point(gap)) points.push_back(*point);
  if (points.size() < 2) return;
  const auto [low, high] =
      std::minmax_element(points.begin(), points.end(),
                          [](const auto& a, const auto& b) { return a.log_level < b.log_level; });
  constexpr double least_ratio = 1.3;
  if (high->log_level - low->log_level < std::log(least_ratio)) return;
  // Lines and phases differ between records: the relative gap scatters by this beside the noise.
  constexpr double scatter = 0.05;
  double w = 0., wx = 0., wy = 0., wxx = 0., wxy = 0.;
  for (const LevelPoint& p : points) {
    const double weight = 1. / (p.variance + scatter * scatter);
    w += weight;
    wx += weight * p.log_level;
    wy += weight * p.log_gap;
    wxx += weight * p.log_level * p.log_level;
    wxy += weight * p.log_level * p.log_gap;
  }
  const double spread = wxx - wx * wx / w;
  const double slope = (wxy - wx * wy / w) / spread;
  out.level_exponent_deviation = 1. / std::sqrt(spread);
  out.level_exponent = std::abs(slope) > 2. * out.level_exponent_deviation ? slope : 0.;
}

/// Are the excited lines so far above the accelerometer's noise that none was taken for left out?
bool every_line_stands_out(const PreparedRecord& record) {
  std::vector<double> shares;
  for (std::size_t k = 1; k < record.acceleration.size(); ++k)
    if (std::norm(record.acceleration[k]) > 0.) shares.push_back(record.noise_share[k]);
  if (shares.empty()) return false;
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::nth_element(shares.begin(), middle, shares.end());
  constexpr double clear_share = 0.97;
  return *middle > clear_share;
}

/// p-values of the lines that a multisine left out, [0] odd and [1] even multiples of its base
/// line, against the noise between the lines of its period.
std::array<double, 2> parity_p_values(const RecordGap& gap, const RestNoise& rest) {
  const PreparedRecord& record = *gap.record;
  std::size_t step = 0, first = 0;
  for (std::size_t k = 1; k < record.acceleration.size(); ++k)
    if (std::norm(record.acceleration[k]) > 0.) {
      step = std::gcd(step, k);
      if (first == 0) first = k;
    }
  if (step < 2 || !every_line_stands_out(record)) return {1., 1.};
  std::vector<double> between(gap.error.size(), 0.), counted(gap.error.size(), 0.);
  for (std::size_t b = 0; b < gap.error.size(); ++b)
    if ((b + 1) % step != 0) {
      between[b] = std::norm(gap.error[b]);
      counted[b] = 1.;
    }
  constexpr std::size_t reach = 15;
  const std::vector<double> noise = neighbour_mean(between, reach),
                            share = neighbour_mean(counted, reach);
  std::array<double, 2> sum{}, n{};
  for (std::size_t k = std::max(step, first / 2 / step * step); k <= gap.error.size(); k += step) {
    if (std::norm(record.acceleration[k]) > 0. || on_rest_line(rest, record, k - 1)) continue;
    const std::size_t parity = (k / step) % 2 == 0 ? 1 : 0;
    // The mean of m exponential variates, inverted, is too large by m / (m - 1).
    const double m = share[k - 1] * (2. * reach + 1.);
    sum[parity] += std::norm(gap.error[k - 1]) * share[k - 1] / noise[k - 1] * (m - 1.) / m;
    n[parity] += 1.;
  }
  const double n_between = 2. * std::accumulate(counted.begin(), counted.end(), 0.);
  std::array<double, 2> p{1., 1.};
  for (std::size_t i = 0; i < 2; ++i)
    // A ratio to the mean of some 15 neighbours scatters more than the line itself.
    if (n[i] > 0.) p[i] = variance_ratio_tail(sum[i] / n[i], 2. * n[i] / 1.2, n_between);
  return p;
}

Harmonics harmonics_of(const std::vector<RecordGap>& gaps, const RestNoise& rest) {
  std::vector<double> p_values;
  for (const RecordGap& gap : gaps) {
    if (kind_of(*gap.record) != "base" || !gap.record->periodic) continue;
    const std::array<double, 2> p = parity_p_values(gap, rest);
    p_values.insert(p_values.end(), p.begin(), p.end());
  }
  const std::vector<double> corrected = holm_corrected(p_values);
  bool odd = false, even = false;
  for (std::size_t i = 0; i < corrected.size(); ++i)
    (i % 2 == 0 ? odd : even) |= corrected[i] < 0.1 * significant;
  if (odd && even) return Harmonics::both;
  if (odd) return Harmonics::odd;
  return even ? Harmonics::even : Harmonics::none;
}

/// p-value of the slope of a straight line through blocks in time, both sides, by Student's t
/// turned into a normal deviate (Wallace 1959).
double trend_p_value(const std::vector<double>& y) {
  const double n = static_cast<double>(y.size()), middle = 0.5 * (n - 1.);
  const double mean = std::accumulate(y.begin(), y.end(), 0.) / n;
  double xy = 0., xx = 0., yy = 0.;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double x = static_cast<double>(i) - middle;
    xy += x * (y[i] - mean);
    xx += x * x;
    yy += (y[i] - mean) * (y[i] - mean);
  }
  const double rest = yy - xy * xy / xx, dof = n - 2.;
  if (!(rest > 0.)) return 1.;
  const double t_square = xy * xy / xx / (rest / dof);
  const double z = (8. * dof + 1.) / (8. * dof + 3.) * std::sqrt(dof * std::log1p(t_square / dof));
  return std::min(1., 2. * normal_tail(z));
}

/// Gain and quadrature of the measured moment against the predicted one, block after block.
std::vector<double> trend_p_values(const RecordGap& gap) {
  constexpr std::size_t n_blocks = 16;
  std::vector<Complex> turned(gap.predicted);
  for (Complex& value : turned) value *= Complex(0., -1.);
  const std::vector<double> p = judged_samples(*gap.record, gap.predicted);
  const std::vector<double> q = judged_samples(*gap.record, turned);
  const std::vector<double> e = judged_samples(*gap.record, gap.error);
  std::vector<double> gain, quadrature;
  for (std::size_t block = 0; block < n_blocks; ++block) {
    const std::size_t from = block * e.size() / n_blocks, to = (block + 1) * e.size() / n_blocks;
    double pp = 0., pe = 0., qq = 0., qe = 0.;
    for (std::size_t i = from; i < to; ++i) {
      pp += p[i] * p[i];
      pe += p[i] * e[i];
      qq += q[i] * q[i];
      qe += q[i] * e[i];
    }
    if (!(pp > 0. && qq > 0.)) return {};
    gain.push_back(pe / pp);
    quadrature.push_back(qe / qq);
  }
  return {trend_p_value(gain), trend_p_value(quadrature)};
}

bool varies_in_time(const std::vector<RecordGap>& gaps) {
  std::vector<double> p_values;
  for (const RecordGap& gap : gaps) {
    if (kind_of(*gap.record) == "rest") continue;
    const std::vector<double> p = trend_p_values(gap);
    p_values.insert(p_values.end(), p.begin(), p.end());
  }
  const std::vector<double> corrected = holm_corrected(p_values);
  return std::any_of(corrected.begin(), corrected.end(), [](double p) { return p < significant; });
}

std::vector<std::string> gap_channels(const std::vector<ChannelGap>& map, bool at_rest) {
  const auto has = [&](const std::string& name) {
    return std::any_of(map.begin(), map.end(), [&](const ChannelGap& c) {
      return c.channel == name && c.p_value < significant;
    });
  };
  std::vector<std::string> channels;
  for (const char* name : {"base", "wind"})
    if (has(name)) channels.push_back(name);
  if (channels.empty() && has("product")) channels.push_back("product");
  if (at_rest) channels.push_back("rest");
  return channels;
}

}  // namespace

std::string to_string(const Harmonics harmonics) {
  switch (harmonics) {
    case Harmonics::none:
      return "none";
    case Harmonics::odd:
      return "odd";
    case Harmonics::even:
      return "even";
    case Harmonics::both:
      return "both";
  }
  return "";
}

Location locate_gap(const Experiment& experiment) {
  Location out;
  const RestNoise rest = rest_noise(experiment);
  std::map<std::string, std::vector<RecordGap>> by_kind;
  std::vector<RecordGap> gaps;
  for (const PreparedRecord& record : experiment.records) {
    if (kind_of(record) == "rest") continue;
    gaps.push_back(gap_of(experiment, record, rest));
    by_kind[kind_of(record)].push_back(gaps.back());
  }
  const std::vector<double> edges = band_edges_hz(experiment);
  const double degrees = noise_degrees(experiment);
  for (const auto& [kind, kind_gaps] : by_kind)
    out.map.push_back(channel_gap(kind, kind_gaps, rest, edges, degrees));
  correct(out.map);
  out.present_at_rest = rest.coloured;
  out.p_value = rest.p_value;
  for (const ChannelGap& channel : out.map) out.p_value = std::min(out.p_value, channel.p_value);
  out.p_value = std::min(1., 2. * out.p_value);  // bands, and presence at rest
  out.bands_hz = merged_bands(out.map);
  out.mode = nearest_mode(experiment.nominal, out.map);
  out.channels = gap_channels(out.map, out.present_at_rest);
  set_level_exponent(out, gaps);
  out.harmonics = harmonics_of(gaps, rest);
  out.varies_in_time = varies_in_time(gaps);
  return out;
}

std::vector<std::string> likely_links(const SearchResult& result) {
  constexpr double least = 0.1;
  std::map<std::string, double> sums;
  for (const Candidate& candidate : result.candidates) {
    std::map<std::string, bool> links;
    for (const std::string& id : effect_ids(candidate.name))
      for (const Effect& effect : effect_catalogue())
        if (effect.id == id) links[to_string(effect.link)] = true;
    for (const auto& [link, named] : links) sums[link] += candidate.probability;
  }
  std::vector<std::pair<double, std::string>> sorted;
  for (const auto& [link, sum] : sums)
    if (sum > least) sorted.emplace_back(-sum, link);
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::string> links;
  for (const auto& [sum, link] : sorted) links.push_back(link);
  return links;
}

std::string location_sentence(const Location& location) {
  if (location.channels.empty()) return "No gap beyond noise.";
  std::ostringstream text;
  text.precision(3);
  text << "The gap shows ";
  std::vector<std::string> when;
  for (const std::string& channel : location.channels)
    when.push_back(channel == "rest"      ? "at rest"
                   : channel == "product" ? "only when base and wind act together"
                                          : "under " + channel);
  text << joined(when, ", ");
  if (!location.bands_hz.empty())
    text << ", " << location.bands_hz.front()[0] << ".." << location.bands_hz.back()[1] << " Hz";
  if (location.mode) text << ", strongest near mode " << *location.mode;
  if (location.level_exponent && *location.level_exponent != 0.)
    text << ", grows as level^" << *location.level_exponent;
  if (location.harmonics != Harmonics::none)
    text << ", with "
         << (location.harmonics == Harmonics::both ? "odd and even" : to_string(location.harmonics))
         << " distortion";
  if (location.varies_in_time) text << ", changes in time";
  text << ".";
  return text.str();
}

}  // namespace vibrissa::diagnosis
