#include "signals/formats/csv_record.h"

#include <span>
#include <string>
#include <vector>

#include "signals/channel_name.h"
#include "signals/formats/record_columns.h"
#include "signals/number_text.h"
#include "signals/output_file.h"

namespace vibrissa::signals::formats {
namespace {

std::string csv_field(const std::string& name) {
  const bool is_padded = name.starts_with(' ') || name.ends_with(' ');
  if (name.find_first_of(",\"") == std::string::npos && !is_padded) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

void write_rows(std::ostream& out, const Record& record, const std::vector<std::string>& names) {
  std::vector<std::span<const double>> channels;
  for (const std::string& name : names) channels.push_back(record.channel(name));
  std::string row;
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    row = to_text(record.time_s(i));
    for (const auto& values : channels) row.append(1, ',').append(to_text(values[i]));
    out << row.append(1, '\n');
  }
}

}  // namespace

void write_csv(const std::filesystem::path& file, const Record& record) {
  const std::vector<std::string> names = channels_in_writing_order(record);
  write_file(file, [&](std::ostream& out) {
    out << time_channel;
    for (const std::string& name : names) out << ',' << csv_field(name);
    out << '\n';
    write_rows(out, record, names);
  });
}

}  // namespace vibrissa::signals::formats
