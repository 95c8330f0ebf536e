#include "case/recorded_input.h"

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/spectra/resample.h"

namespace vibrissa::sensor_case {

signals::Recording read_input(const RecordedInput& input, const std::string& channel) {
  signals::ReadOptions options;
  const std::string column = input.column.empty() ? channel : input.column;
  const std::string factor = input.scale == 1. ? "" : "*" + signals::to_text(input.scale);
  options.columns = {signals::parse_column_choice(channel + "=" + column + factor)};
  options.sampling_rate_hz = input.sampling_rate_hz;
  options.first_row = input.first_row;
  options.n_rows = input.n_rows;
  return signals::read_recording(input.file, options);
}

std::vector<double> load_input(const RecordedInput& input, const std::string& channel,
                               const double sampling_rate_hz, const std::size_t n_samples) {
  const signals::Recording recording = read_input(input, channel);
  const signals::Record& record = recording.pieces[recording.longest()];
  const auto values = record.channel(channel);
  std::vector<double> samples(values.begin(), values.end());
  if (input.remove_mean) samples = signals::remove_mean(samples);
  if (input.range)
    samples = signals::scale_to_range(samples, input.range->first, input.range->second);
  samples = signals::resample(samples, record.sampling_rate_hz(), sampling_rate_hz);
  if (n_samples == 0) return samples;
  if (samples.size() < n_samples) {
    throw signals::UserError(input.file.string() + ": contains " + std::to_string(samples.size()) +
                             " samples at " + signals::to_text(sampling_rate_hz) + " Hz, but " +
                             std::to_string(n_samples) +
                             " are needed; shorten Records/Duration or take more rows");
  }
  samples.resize(n_samples);
  return samples;
}

}  // namespace vibrissa::sensor_case
