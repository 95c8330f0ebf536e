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

}  // namespace vibrissa::diagnosis
