#include "apps/command_line/record_options.h"

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "signals/base/error.h"
#include "signals/files/row_range.h"
#include "signals/record/plausibility.h"

namespace vibrissa::apps {

void refuse_overwriting(const FileNames& inputs, const FileNames& outputs) {
  std::error_code missing;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!outputs[i]) continue;
    for (const auto& input : inputs)
      if (input && std::filesystem::equivalent(*input, *outputs[i], missing))
        throw signals::UserError(
            *outputs[i] +
            ": this file is an input and is not overwritten; name another file to write");
    for (std::size_t j = 0; j < i; ++j)
      if (outputs[j] && std::filesystem::weakly_canonical(*outputs[j], missing) ==
                            std::filesystem::weakly_canonical(*outputs[i], missing))
        throw signals::UserError(*outputs[i] +
                                 ": this file would be written twice; name two different files");
  }
}

nlohmann::json written_record_json(const std::string& file, const signals::Record& record) {
  return {{"record", file},
          {"samples", record.n_samples()},
          {"sampling_rate_hz", record.sampling_rate_hz()},
          {"channels", record.channel_names()}};
}

std::string written_record_text(const std::string& file, const signals::Record& record) {
  std::ostringstream text;
  text << "wrote " << file << ": " << record.n_samples() << " samples at "
       << record.sampling_rate_hz() << " Hz\n";
  return text.str();
}

void RecordOptions::add_to(CLI::App& command) {
  command.add_option(
      "--column", columns,
      "Says which column of the file is which channel: CHANNEL=COLUMN. Channels: time, "
      "base_acceleration, base_moment, wind_speed and others (docs/records.md). The unit of the "
      "column stands in square brackets, a factor behind it: 'base_acceleration=ax[g]', "
      "'time=t[ms]', "
      "'base_moment=B[uT]*0.18[N m/T]'. Without units the values are in SI. Other channels are "
      "columns that have the channel's name; repeatable");
  command.add_option("--rate", rate_hz, "Sampling rate [Hz], for a file without time");
  command.add_option("--rows", rows,
                     "FIRST:LAST: rows that are used; row 1 is the first behind the column names");
  command.add_option("--remove-mean", remove_mean,
                     "Channel whose mean is subtracted, e.g. base_acceleration; repeatable");
}

signals::ReadOptions RecordOptions::read_options() const {
  signals::ReadOptions options;
  options.sampling_rate_hz = rate_hz;
  options.remove_mean = remove_mean;
  if (rows) {
    const signals::RowRange range = signals::parse_rows(*rows, "--rows");
    options.first_row = range.first;
    options.n_rows = range.count;
  }
  for (const auto& text : columns) options.columns.push_back(signals::parse_column_choice(text));
  return options;
}

signals::Record RecordOptions::read(const std::string& file) const {
  signals::Record record = signals::read_record(file, read_options());
  for (const std::string& remark : signals::implausible_magnitudes(record))
    std::cerr << "warning: " << file << ": " << remark << std::endl;
  return record;
}

std::vector<double> RecordOptions::read_column(const std::string& file,
                                               const std::string& column) const {
  signals::ReadOptions options = read_options();
  options.columns = {{.channel = column, .column = column}};
  options.remove_mean.clear();
  const signals::Record record = signals::read_record(file, options);
  const auto values = record.channel(column);
  return {values.begin(), values.end()};
}

}  // namespace vibrissa::apps
