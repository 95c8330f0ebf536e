#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/localisation/record_gap.h"
#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// One band of the gap map.
struct BandGap {
  double low_hz = 0., high_hz = 0.;
  double nrmse = 0.;    // rms of the error divided by the rms of the whole measured moment
  double excess = 0.;   // whitened mean square of the error; 1 means noise alone
  double p_value = 1.;  // with Holm's correction over all bands and kinds of records
};

/// Gap of the records with one kind of excitation.
struct ChannelGap {
  std::string channel{};  // base, wind or product (both)
  std::vector<BandGap> bands{};
  double p_value = 1.;  // of the most significant band
};

/// Gap of the base records of one level.
struct LevelGap {
  double level_m_s2 = 0.;  // rms of the base acceleration
  std::vector<BandGap> bands{};
};

/// Exponent of the relative gap, which grows as level^value.
struct LevelExponent {
  double value = 0.;  // 0 where it does not differ significantly from 0
  double deviation = 0.;
};

/// Harmonics of multisines that they do not excite themselves, by parity.
enum class Harmonics { none, odd, even, both };
std::string to_string(Harmonics harmonics);

/// Size of the nominal model's error along one record.
struct GapInTime {
  std::string record{};
  std::vector<double> time_s{};  // middles of equal parts, relative to the start of the record
  std::vector<double> excess{};  // whitened mean square of the error; 1 means noise alone
};

/// Location of the gap, without any hypothesis about its cause.
struct Location {
  double p_value = 1.;  // of the most significant band or of the presence at rest
  std::vector<ChannelGap> map{};
  std::vector<LevelGap> by_level{};  // of periodic records, ascending; empty with one level only
  std::vector<GapInTime> in_time{};
  std::vector<std::array<double, 2>> bands_hz{};  // significant neighbouring bands merged
  /// Nearest to the band with the largest error, from 1, in ascending frequency; nothing when it is
  /// more than an octave away.
  std::optional<std::size_t> mode{};
  std::optional<LevelExponent> level_exponent{};  // nothing with one level, or without a gap
  std::vector<std::string> channels{};            // base, wind, product (both), rest
  Harmonics harmonics = Harmonics::none;
  bool varies_in_time = false;  // gain or phase has a trend in a record
  bool present_at_rest = false;
  std::vector<std::string> links{};  // most probable first; from likely_links
};

/// Error of the nominal model on the fit records, whitened with the noise of both channels, by
/// third-octave band and kind of record; parity at lines of periodic records that are not excited;
/// trend of gain and phase over time; colour and lines of records at rest. A property is reported
/// when its p-value, corrected for all tests of its kind, is below 0.01 (distortion: 0.001).
/// experiment: Split::fit, InputNoise::reduced. Proven by
/// tests/diagnosis/localisation/location_test.cc.
Location locate_gap(const Experiment& experiment);

/// Parts of locate_gap(): the gap by band, kind and level of records; and its other properties.
void set_map(const Experiment& experiment, const std::vector<RecordGap>& gaps,
             const RestNoise& rest, Location& out);
void set_properties(const std::vector<RecordGap>& gaps, const RestNoise& rest, Location& out);

/// Links of the candidates' effects, sorted by the sum of the probabilities; only sums above 0.1.
/// Empty where "none" is most probable.
std::vector<std::string> likely_links(const SearchResult& result);

/// The location as one sentence.
std::string location_sentence(const Location& location);

}  // namespace vibrissa::diagnosis
