#include "apps/record_options.h"

#include <charconv>

#include "signals/error.h"
#include "signals/resample.h"

namespace vibrissa::apps {

namespace {

std::size_t whole_number(const std::string& text, const std::string& option) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw signals::UserError(option + ": '" + text + "' is no whole number; write FIRST:LAST");
  }
  return value;
}

}  // namespace

RowRange parse_rows(const std::string& text, const std::string& option) {
  const auto colon = text.find(':');
  if (colon == std::string::npos) {
    throw signals::UserError(option + ": '" + text + "' is no range; write FIRST:LAST");
  }
  const std::size_t first = whole_number(text.substr(0, colon), option);
  const std::size_t last = whole_number(text.substr(colon + 1), option);
  if (first < 1 || last < first) {
    throw signals::UserError(option + ": rows " + text + " are no range; rows count from 1");
  }
  return {first, last - first + 1};
}

std::string full_channel_name(const std::string& name) {
  return signals::parse_column_choice(name + "=any").channel;
}

void RecordOptions::add_to(CLI::App& command) {
  command.add_option("--column", columns,
                     "CHANNEL=COLUMN[*SCALE]: takes a column of the file as a channel, in SI units "
                     "after the scale, e.g. base_moment=hall_mT*1.8e-4; repeatable");
  command.add_option("--rate", rate_hz, "Sampling rate [Hz], when the file has no time_s column");
  command.add_option("--rows", rows, "FIRST:LAST data rows used, counted from 1");
  command.add_option("--remove-mean", remove_mean, "Channel whose mean is taken off; repeatable");
}

signals::ReadOptions RecordOptions::read_options() const {
  signals::ReadOptions options;
  options.sampling_rate_hz = rate_hz;
  if (rows) {
    const RowRange range = parse_rows(*rows, "--rows");
    options.first_row = range.first;
    options.n_rows = range.count;
  }
  return options;
}

signals::Record RecordOptions::read(const std::string& file) const {
  signals::ReadOptions options = read_options();
  for (const auto& text : columns) options.columns.push_back(signals::parse_column_choice(text));
  signals::Record record = signals::read_record(file, options);
  for (const auto& name : remove_mean) {
    const std::string channel = full_channel_name(name);
    record.set_channel(channel, signals::remove_mean(record.channel(channel)));
  }
  return record;
}

std::vector<double> RecordOptions::read_column(const std::string& file,
                                               const std::string& column) const {
  signals::ReadOptions options = read_options();
  options.columns = {{column, column, 1.}};
  const signals::Record record = signals::read_record(file, options);
  const auto values = record.channel(column);
  return {values.begin(), values.end()};
}

}  // namespace vibrissa::apps
