#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/localisation/record_gap.h"

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

/// The gap by third-octave band and kind of record.
std::vector<ChannelGap> gap_map(const Experiment& experiment, const std::vector<RecordGap>& gaps,
                                const RestNoise& rest);

/// Gap of the base records of one level.
struct LevelGap {
  double level_m_s2 = 0.;  // rms of the base acceleration
  std::vector<BandGap> bands{};
};

/// The gap of periodic base records in the same bands by level (equal within a tenth), ascending;
/// p-values are not corrected. Empty with one level only.
std::vector<LevelGap> gap_map_by_level(const Experiment& experiment,
                                       const std::vector<RecordGap>& gaps, const RestNoise& rest);

/// Significant bands of all kinds of records; neighbouring bands are merged.
std::vector<std::array<double, 2>> merged_bands(const std::vector<ChannelGap>& map);
/// Number of the mode (from 1, by ascending frequency) nearest to the band with the largest error;
/// nothing when it is more than an octave away.
std::optional<std::size_t> nearest_mode(const NominalModel& nominal,
                                        const std::vector<ChannelGap>& map);
/// Kinds of records with a gap: base, wind, product (only when both act) and rest.
std::vector<std::string> gap_channels(const std::vector<ChannelGap>& map, bool at_rest);

/// Exponent of the relative gap, which grows as level^value.
struct LevelExponent {
  double value = 0.;  // 0 where it does not differ significantly from 0
  double deviation = 0.;
};

/// Exponent from the excited lines of periodic base records, minus noise; nothing when there is one
/// level only or no gap under base motion.
std::optional<LevelExponent> level_exponent(const std::vector<RecordGap>& gaps);

enum class Harmonics { none, odd, even, both };
std::string to_string(Harmonics harmonics);

/// Distortion at the lines that the multisines of base records do not excite, by the parity of
/// their multiple of the base frequency.
Harmonics harmonics_of(const std::vector<RecordGap>& gaps, const RestNoise& rest);

/// Does the gain or phase of the measured moment relative to the predicted one have a trend in any
/// record?
bool varies_in_time(const std::vector<RecordGap>& gaps);

/// Size of the nominal model's error along one record.
struct GapInTime {
  std::string record{};
  std::vector<double> time_s{};  // middles of equal parts, relative to the start of the record
  std::vector<double> excess{};  // whitened mean square of the error; 1 means noise alone
};

/// The error along every record with an excitation.
std::vector<GapInTime> gap_in_time(const std::vector<RecordGap>& gaps);

}  // namespace vibrissa::diagnosis
