#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "signals/files/record_io.h"

namespace vibrissa::sensor_case {

/// One recorded channel as an input of a run: file, column and rows, and the operations in this
/// order: scale, remove the mean, scale to the range, resample to the rate of the run.
struct RecordedInput {
  std::filesystem::path file;
  std::string column;  // with its unit, as in --column; empty: the name of the channel
  double scale = 1.;
  std::optional<double> sampling_rate_hz;  // needed when the file has no time_s
  std::size_t first_row = 1;
  std::optional<std::size_t> n_rows;
  bool remove_mean = false;
  std::optional<std::pair<double, double>> range;  // smallest and largest value after scaling
};

/// The rows of the channel as they were recorded, scaled, before the other operations. Throws
/// UserError as read_recording does.
signals::Recording read_input(const RecordedInput& input, const std::string& channel);

/// Samples of the channel at the sampling rate of the run. Throws UserError as read_record and
/// resample do, and when there are fewer than n_samples; a longer input is cut. n_samples = 0
/// returns all samples.
std::vector<double> load_input(const RecordedInput& input, const std::string& channel,
                               double sampling_rate_hz, std::size_t n_samples);

}  // namespace vibrissa::sensor_case
