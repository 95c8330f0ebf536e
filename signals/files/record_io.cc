#include "signals/files/record_io.h"

#include "signals/base/error.h"
#include "signals/files/file_format.h"
#include "signals/files/record_rows.h"
#include "signals/files/record_sources.h"
#include "signals/record/channel_name.h"
#include "signals/spectra/resample.h"

namespace vibrissa::signals {
namespace {

void remove_means(const ReadOptions& options, Record& record) {
  for (const std::string& name : options.remove_mean) {
    const std::string channel = full_channel_name(name);
    if (channel.empty()) throw UserError(unknown_name("channel", name, known_channels()));
    record.set_channel(channel, remove_mean(record.channel(channel)));
  }
}

}  // namespace

Record read_record(const std::filesystem::path& file, const ReadOptions& options) {
  check(options);
  const auto table = formats::open_table(file);
  const Sources sources = find_sources(*table, options);
  const std::size_t n_rows = number_of_rows(*table, options);
  Record record = read_rows(*table, file.string(), sources, options, n_rows);
  remove_means(options, record);
  return record;
}

void write_record(const std::filesystem::path& file, const Record& record) {
  const formats::FileFormat& format = formats::format_of(file);
  const std::string ending = formats::extension_of(file);
  const bool is_text = ending.empty() || ending == ".txt" || ending == ".dat";
  if (!format.has(ending) && !is_text)
    throw UserError(file.string() + ": '" + ending +
                    "' cannot be written as a record; use .csv, .mat, .h5, .npy or .uff");
  if (!format.write)
    throw UserError(file.string() +
                    ": a sound file cannot store the units and the start of a record; use .csv, "
                    ".mat, .h5, .npy or .uff");
  format.write(file, record);
}

}  // namespace vibrissa::signals
