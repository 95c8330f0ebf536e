#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/localisation/gap_properties.h"
#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// Location of the gap, without any hypothesis about its cause.
struct Location {
  double p_value = 1.;  // of the most significant band or of the presence at rest
  std::vector<ChannelGap> map{};
  std::vector<LevelGap> by_level{};  // empty with one level only
  std::vector<GapInTime> in_time{};
  std::vector<std::array<double, 2>> bands_hz{};  // significant neighbouring bands merged
  std::optional<std::size_t> mode{};              // from 1, in ascending frequency
  std::optional<LevelExponent> level_exponent{};
  std::vector<std::string> channels{};  // base, wind, product (both), rest
  Harmonics harmonics = Harmonics::none;
  bool varies_in_time = false;
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

/// Links of the candidates' effects, sorted by the sum of the probabilities; only sums above 0.1.
/// Empty where "none" is most probable.
std::vector<std::string> likely_links(const SearchResult& result);

/// The location as one sentence.
std::string location_sentence(const Location& location);

}  // namespace vibrissa::diagnosis
