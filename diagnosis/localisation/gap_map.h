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
  double nrmse = 0.;    // rms of the error over rms of the whole measured moment
  double excess = 0.;   // whitened mean square of the error; 1 is noise alone
  double p_value = 1.;  // after Holm's correction over all bands and kinds of records
};

/// Records of one kind of excitation.
struct ChannelGap {
  std::string channel{};  // base, wind or product
  std::vector<BandGap> bands{};
  double p_value = 1.;  // of its most significant band
};

/// By third octave and kind of record.
std::vector<ChannelGap> gap_map(const Experiment& experiment, const std::vector<RecordGap>& gaps,
                                const RestNoise& rest);

/// Base records of one level.
struct LevelGap {
  double level_m_s2 = 0.;  // rms of the base acceleration
  std::vector<BandGap> bands{};
};

/// The same bands of periodic base records by level (within a tenth), ascending; each band with its
/// own p-value, not corrected. Empty with one level only.
std::vector<LevelGap> gap_map_by_level(const Experiment& experiment,
                                       const std::vector<RecordGap>& gaps, const RestNoise& rest);

/// Significant bands of all kinds of records, neighbours merged.
std::vector<std::array<double, 2>> merged_bands(const std::vector<ChannelGap>& map);
/// Mode, from 1 in ascending frequency, nearest to the band with the largest error; none when it is
/// more than an octave away.
std::optional<std::size_t> nearest_mode(const NominalModel& nominal,
                                        const std::vector<ChannelGap>& map);
/// Of base, wind, product (neither alone) and rest.
std::vector<std::string> gap_channels(const std::vector<ChannelGap>& map, bool at_rest);

}  // namespace vibrissa::diagnosis
