#include "diagnosis/localisation/location.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "diagnosis/localisation/significance_tests.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// Degrees of freedom of the noise levels: lines of the upper half of the spectrum in records at
/// rest.
double noise_degrees(const Experiment& experiment) {
  double lines = 0.;
  for (const PreparedRecord& record : experiment.records)
    lines += kind_of(record) == "rest"
                 ? static_cast<double>(record.n_bins())
                 : (record.periodic ? static_cast<double>(record.n_acceleration_noise) : 0.);
  // Without such lines the level is uncertain by a factor of two.
  return std::max(lines, 8.);
}

/// Edges of third-octave bands up to half the largest sampling rate; bands are not narrower than
/// the bins allow.
std::vector<double> band_edges_hz(const Experiment& experiment) {
  double nyquist_hz = 0., bin_hz = 0.;
  for (const PreparedRecord& record : experiment.records) {
    nyquist_hz = std::max(nyquist_hz, 0.5 * record.sampling_rate_hz);
    bin_hz = std::max(bin_hz, record.bin_hz());
  }
  std::vector<double> edges{0.};
  for (double f = 1.; f < nyquist_hz; f *= std::cbrt(2.))
    if (f - edges.back() >= static_cast<double>(fewest_band_bins) * bin_hz) edges.push_back(f);
  if (edges.size() > 1) edges.pop_back();
  edges.push_back(nyquist_hz);
  return edges;
}

ChannelGap channel_gap(const std::string& channel, const std::vector<RecordGap>& gaps,
                       const RestNoise& rest, const std::vector<double>& edges,
                       double noise_degrees) {
  ChannelGap out{.channel = channel};
  double measured = 0.;
  for (const RecordGap& gap : gaps) measured += total_power(gap.record->moment);
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    double whitened = 0., error = 0., n = 0.;
    for (const RecordGap& gap : gaps)
      for (std::size_t b = 0; b < gap.error.size(); ++b) {
        const double f = gap.record->frequency_hz(b);
        if (f < edges[e] || f >= edges[e + 1] || on_rest_line(rest, *gap.record, b)) continue;
        whitened += std::norm(gap.error[b]) / gap.variance[b];
        error += std::norm(gap.error[b]);
        n += 1.;
      }
    if (n < static_cast<double>(fewest_band_bins)) continue;
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

/// The gap by third-octave band and kind of record.
std::vector<ChannelGap> gap_map(const Experiment& experiment, const std::vector<RecordGap>& gaps,
                                const RestNoise& rest) {
  std::map<std::string, std::vector<RecordGap>> by_kind;
  for (const RecordGap& gap : gaps) by_kind[kind_of(*gap.record)].push_back(gap);
  const std::vector<double> edges = band_edges_hz(experiment);
  const double degrees = noise_degrees(experiment);
  std::vector<ChannelGap> map;
  for (const auto& [kind, kind_gaps] : by_kind)
    map.push_back(channel_gap(kind, kind_gaps, rest, edges, degrees));
  correct(map);
  return map;
}

/// The gap of periodic base records in the same bands by level (equal within a tenth); p-values are
/// not corrected.
std::vector<LevelGap> gap_map_by_level(const Experiment& experiment,
                                       const std::vector<RecordGap>& gaps, const RestNoise& rest) {
  constexpr double same_level = 1.1;
  std::map<double, std::vector<RecordGap>> by_level;
  for (const RecordGap& gap : gaps) {
    if (kind_of(*gap.record) != "base" || !gap.record->is_steady()) continue;
    const double level = base_level_m_s2(*gap.record);
    auto index = by_level.lower_bound(level / same_level);
    if (index == by_level.end() || index->first > level * same_level)
      index = by_level.emplace(level, std::vector<RecordGap>{}).first;
    index->second.push_back(gap);
  }
  if (by_level.size() < 2) return {};
  const std::vector<double> edges = band_edges_hz(experiment);
  const double degrees = noise_degrees(experiment);
  std::vector<LevelGap> map;
  for (const auto& [level, level_gaps] : by_level)
    map.push_back({level, channel_gap("base", level_gaps, rest, edges, degrees).bands});
  return map;
}

/// Significant bands of all kinds of records; neighbouring bands are merged.
std::vector<std::array<double, 2>> merged_bands(const std::vector<ChannelGap>& map) {
  std::map<double, double> bands;
  for (const ChannelGap& channel : map)
    for (const BandGap& band : channel.bands)
      if (band.p_value < significant_gap) bands[band.low_hz] = band.high_hz;
  std::vector<std::array<double, 2>> merged;
  for (const auto& [low, high] : bands) {
    if (!merged.empty() && low <= merged.back()[1])
      merged.back()[1] = std::max(high, merged.back()[1]);
    else
      merged.push_back({low, high});
  }
  return merged;
}

/// Mode nearest to the band with the largest error, within an octave.
std::optional<std::size_t> nearest_mode(const NominalModel& nominal,
                                        const std::vector<ChannelGap>& map) {
  BandGap strongest;
  for (const ChannelGap& channel : map)
    for (const BandGap& band : channel.bands)
      if (band.p_value < significant_gap && band.nrmse > strongest.nrmse) strongest = band;
  if (strongest.nrmse == 0.) return std::nullopt;
  const double centre_hz = 0.5 * (strongest.low_hz + strongest.high_hz);
  std::vector<double> modes_hz;
  for (const StructuralMode& mode : nominal.modes)
    modes_hz.push_back(mode.frequency_rad_s / (2. * std::numbers::pi));
  std::sort(modes_hz.begin(), modes_hz.end());
  const auto octaves = [&](const double hz) { return std::abs(std::log2(hz / centre_hz)); };
  const auto nearest = std::ranges::min_element(modes_hz, {}, octaves);
  if (nearest == modes_hz.end() || octaves(*nearest) >= 1.) return std::nullopt;
  return static_cast<std::size_t>(nearest - modes_hz.begin()) + 1;
}

/// Kinds of records with a gap; product only when neither base nor wind alone has one.
std::vector<std::string> gap_channels(const std::vector<ChannelGap>& map, bool at_rest) {
  const auto has = [&](const std::string& name) {
    const auto found = std::ranges::find(map, name, &ChannelGap::channel);
    return found != map.end() && found->p_value < significant_gap;
  };
  std::vector<std::string> channels;
  for (const char* name : {"base", "wind"})
    if (has(name)) channels.push_back(name);
  if (channels.empty() && has("product")) channels.push_back("product");
  if (at_rest) channels.push_back("rest");
  return channels;
}

}  // namespace

void set_map(const Experiment& experiment, const std::vector<RecordGap>& gaps,
             const RestNoise& rest, Location& out) {
  out.map = gap_map(experiment, gaps, rest);
  out.by_level = gap_map_by_level(experiment, gaps, rest);
  out.bands_hz = merged_bands(out.map);
  out.mode = nearest_mode(experiment.nominal, out.map);
  out.channels = gap_channels(out.map, rest.coloured);
}

}  // namespace vibrissa::diagnosis
