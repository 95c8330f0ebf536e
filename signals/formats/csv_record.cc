#include "signals/formats/csv_record.h"

#include <span>
#include <string>
#include <vector>

#include "signals/base/number_text.h"
#include "signals/formats/record_columns.h"
#include "signals/record/channel_name.h"
#include "signals/system/output_file.h"

namespace vibrissa::signals::formats {
namespace {

std::string csv_field(const std::string& name) {
  const bool is_padded = name.starts_with(' ') || name.ends_with(' ');
  if (name.find_first_of(",\"") == std::string::npos && !is_padded) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

void write_csv_header(std::ostream& out, const Record& block) {
  out << time_channel;
  for (const std::string& name : channels_in_writing_order(block)) out << ',' << csv_field(name);
  out << '\n';
}

void write_csv_rows(std::ostream& out, const Record& block, const TimeAxis& axis,
                    const std::size_t first_sample) {
  std::vector<std::span<const double>> channels;
  for (const std::string& name : channels_in_writing_order(block))
    channels.push_back(block.channel(name));
  std::string row;
  for (std::size_t i = 0; i < block.n_samples(); ++i) {
    const auto sample = static_cast<double>(first_sample + i);
    row = to_text(axis.start_s + sample / axis.sampling_rate_hz);
    for (const auto& values : channels) row.append(1, ',').append(to_text(values[i]));
    out << row.append(1, '\n');
  }
}

void write_csv(const std::filesystem::path& file, const Record& record) {
  write_file(file, [&](std::ostream& out) {
    write_csv_header(out, record);
    write_csv_rows(out, record, {record.time_s(0), record.sampling_rate_hz()}, 0);
  });
}

}  // namespace vibrissa::signals::formats
