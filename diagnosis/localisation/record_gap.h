#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Bound of p-values, corrected for all tests of a kind, below which a statement about the gap is
/// made.
inline constexpr double significant_gap = 0.01;
/// Fewest bins of a band: below it the variance ratio's tail is a guess.
inline constexpr std::size_t fewest_band_bins = 6;

/// base, wind, product (both) or rest.
std::string kind_of(const PreparedRecord& record);

/// What records at rest hold beside white noise.
struct RestNoise {
  bool coloured = false;
  double p_value = 1.;
  double bin_hz = 1.;
  std::vector<double> excess{};    // at least 1: power of the bins, smoothed, over white noise
  std::vector<double> lines_hz{};  // single lines
};
RestNoise rest_noise(const Experiment& experiment);
/// Does a line that is there at rest fall on this bin?
bool on_rest_line(const RestNoise& rest, const PreparedRecord& record, std::size_t b);

/// Error of the nominal model in one record, and its variance by the noise of both channels, of
/// rest and by what the model cannot follow of its own simulation.
struct RecordGap {
  const PreparedRecord* record = nullptr;
  std::vector<Complex> predicted{}, error{};
  std::vector<double> variance{};
};
/// Rms of the measured base acceleration over the record [m/s^2].
double base_level_m_s2(const PreparedRecord& record);

RecordGap gap_of(const Experiment& experiment, const PreparedRecord& record, const RestNoise& rest);

}  // namespace vibrissa::diagnosis
