#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vibrissa::sensor_case {

/// One recorded channel as an input of a run: which column of which file, which rows, and what is
/// done to it, in this order: scale, mean removed, range, resampled to the run's rate.
struct RecordedInput {
  std::filesystem::path file;
  std::string column;  // with its unit, as in --column; empty: the channel's own name
  double scale = 1.;
  std::optional<double> sampling_rate_hz;  // needed when the file has no time_s
  std::size_t first_row = 1;
  std::optional<std::size_t> n_rows;
  bool remove_mean = false;
  std::optional<std::pair<double, double>> range;  // smallest and largest value after scaling
};

/// Samples of the channel at the run's rate. Throws UserError as read_record and resample do, and
/// when fewer than n_samples come out; longer input is cut. n_samples = 0 takes what there is.
std::vector<double> load_input(const RecordedInput& input, const std::string& channel,
                               double sampling_rate_hz, std::size_t n_samples);

}  // namespace vibrissa::sensor_case
