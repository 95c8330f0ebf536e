#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Significance level: a property of the gap is reported when its corrected p-value is below this.
inline constexpr double significant_gap = 0.01;
/// Fewest bins of a band; with fewer the tail of the variance ratio is inaccurate.
inline constexpr std::size_t fewest_band_bins = 6;

/// Kind of a record: base, wind, product (both) or rest.
std::string kind_of(const PreparedRecord& record);

/// Coloured noise and lines of the records at rest.
struct RestNoise {
  bool coloured = false;
  double p_value = 1.;
  double bin_hz = 1.;
  std::vector<double> excess{};    // smoothed power of the bins over that of white noise
  std::vector<double> lines_hz{};  // single lines
};
RestNoise rest_noise(const Experiment& experiment);
/// Does this bin contain a line that also exists at rest?
bool on_rest_line(const RestNoise& rest, const PreparedRecord& record, std::size_t b);

/// Error of the nominal model in one record, and its variance: noise of both channels, coloured
/// noise at rest, and misfit of the nominal model to the simulation.
struct RecordGap {
  const PreparedRecord* record = nullptr;
  std::vector<Complex> predicted{}, error{};
  std::vector<double> variance{};
};
/// Rms of the measured base acceleration of the record [m/s^2].
double base_level_m_s2(const PreparedRecord& record);

RecordGap gap_of(const Experiment& experiment, const PreparedRecord& record, const RestNoise& rest);

}  // namespace vibrissa::diagnosis
