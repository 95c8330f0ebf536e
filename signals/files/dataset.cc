#include "signals/files/dataset.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/json_input.h"
#include "signals/files/file_format.h"
#include "signals/record/dataset_entry.h"
#include "signals/spectra/resample.h"

namespace vibrissa::signals {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const std::vector<std::string> record_keys{
    "kind",          "file",    "excitation",       "period_samples",
    "split",         "setup",   "sampling_rate_hz", "readout",
    "clock_start_s", "columns", "remove_mean"};

/// Entries of the whole dataset, including those that its records may also have.
const std::vector<std::string> file_keys{
    "schema", "records", "sampling_rate_hz", "columns", "remove_mean", "readout", "setup"};

bool holds(const std::vector<std::string>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

Excitation excitation_of(const std::string& word, const std::string& where) {
  if (word == "none") return {};
  if (word == "base") return {.base = true, .wind = false};
  if (word == "wind") return {.base = false, .wind = true};
  if (word == "base+wind") return {.base = true, .wind = true};
  refuse_dataset(where, unknown_name("excitation", word, {"none", "base", "wind", "base+wind"}));
}

Readout readout_of(const std::string& word, const std::string& where) {
  if (word == "moment") return Readout::moment;
  if (word == "rotation") return Readout::rotation;
  refuse_dataset(where, unknown_name("readout", word, {"moment", "rotation"}));
}

std::size_t period_of(const json& entry, const std::string& where) {
  if (!entry.contains("period_samples")) return 0;
  const json& period = entry["period_samples"];
  if (!period.is_number_unsigned())
    refuse_dataset(where + "/period_samples", "must be a whole number of samples, 0 or more");
  return period.get<std::size_t>();
}

double clock_start_of(const json& entry, const std::string& where) {
  if (!entry.contains("clock_start_s")) return 0.;
  const json& start = entry["clock_start_s"];
  if (!start.is_number() || start.get<double>() < 0.)
    refuse_dataset(where + "/clock_start_s", "must be a time in seconds, 0 or more");
  return start.get<double>();
}

/// An entry of the record, or else of the whole dataset; nothing where neither has it.
const json* either(const json& document, const json& entry, const std::string& key) {
  if (entry.contains(key)) return &entry[key];
  return document.contains(key) ? &document[key] : nullptr;
}

std::vector<ColumnChoice> columns_of(const json& chosen, const std::string& where) {
  if (!chosen.is_object())
    refuse_dataset(where, "must be an object that names the column of each channel");
  std::vector<ColumnChoice> choices;
  for (const auto& [channel, column] : chosen.items()) {
    if (!column.is_string())
      refuse_dataset(where + "/" + channel, "must be a string that names a column");
    try {
      choices.push_back(parse_column_choice(channel + "=" + column.get<std::string>()));
    } catch (const UserError& error) {
      refuse_dataset(where, error.what());
    }
  }
  return choices;
}

std::vector<std::string> names_of(const json& list, const std::string& where) {
  if (!list.is_array()) refuse_dataset(where, "must be an array of channel names");
  std::vector<std::string> names;
  for (const json& name : list) {
    if (!name.is_string()) refuse_dataset(where, "must be an array of channel names");
    names.push_back(name);
  }
  return names;
}

ReadOptions options_of(const json& document, const json& entry, const std::string& where,
                       const ReadOptions& given) {
  const auto refuse_twice = [&](const bool is_given, const std::string& key,
                                const std::string& option) {
    if (is_given && either(document, entry, key) != nullptr)
      refuse_dataset(where, "dataset.json states '" + key + "', so " + option +
                                " would not be used; leave one of them out");
  };
  refuse_twice(given.sampling_rate_hz.has_value(), "sampling_rate_hz", "--rate");
  refuse_twice(!given.columns.empty(), "columns", "--column");
  refuse_twice(!given.remove_mean.empty(), "remove_mean", "--remove-mean");
  ReadOptions options = given;
  if (const json* const rate = either(document, entry, "sampling_rate_hz")) {
    if (!rate->is_number()) refuse_dataset(where + "/sampling_rate_hz", "must be a number");
    options.sampling_rate_hz = rate->get<double>();
  }
  if (const json* const columns = either(document, entry, "columns"))
    options.columns = columns_of(*columns, where + "/columns");
  if (const json* const names = either(document, entry, "remove_mean"))
    options.remove_mean = names_of(*names, where + "/remove_mean");
  return options;
}

/// Unknown entries of the whole dataset are allowed, except entries that belong to a record and
/// misspelt entries.
void refuse_misplaced(const json& document, const std::string& name) {
  for (const auto& item : document.items()) {
    if (holds(file_keys, item.key())) continue;
    if (holds(record_keys, item.key()))
      refuse_dataset(
          name + ": /" + item.key(),
          "belongs to each record, not to the whole dataset; move it into the entries of /records");
    if (!nearest_name(item.key(), file_keys).empty())
      refuse_dataset(name, unknown_name("entry", item.key(), file_keys));
  }
}

/// A record with what its entry says of it.
DatasetRecord described_record(const json& document, const json& entry, const std::string& where,
                               const std::string& name, Record record) {
  const std::string readout = text_of(document, "readout", where, "moment");
  return {
      .name = name,
      .record = std::move(record),
      .excitation = excitation_of(text_of(entry, "excitation", where, ""), where + "/excitation"),
      .period_samples = period_of(entry, where),
      .split = split_of(entry, where),
      .readout = readout_of(text_of(entry, "readout", where, readout), where + "/readout"),
      .setup = setup_of(document, entry, where),
      .clock_start_s = clock_start_of(entry, where),
      .readout_is_given = document.contains("readout") || entry.contains("readout")};
}

/// One response or record, or each piece of it that has a whole period.
void read_entry(const fs::path& folder, const json& document, const json& entry,
                const std::string& where, const ReadOptions& given, Dataset& dataset) {
  if (!entry.is_object()) refuse_dataset(where, "must be an object");
  if (is_response(entry, where)) {
    if (!given.takes_responses)
      refuse_dataset(
          where,
          "is a response; this command compares records in time only. Take its entry out "
          "of the dataset, or give the recording from which it was made");
    dataset.responses.push_back(read_dataset_response(folder, document, entry, where));
    return;
  }
  refuse_unknown_entries(entry, record_keys, where);
  const std::string file = file_of(entry, where);
  Recording recording = read_recording(folder / file, options_of(document, entry, where, given));
  dataset.readings.push_back({(folder / file).string(), recording.words});
  const bool is_one = recording.pieces.size() == 1;
  const double start_s = recording.pieces.front().time_s(0);
  const std::size_t longest = recording.pieces[recording.longest()].n_samples();
  for (std::size_t i = 0; i < recording.pieces.size(); ++i) {
    std::string name = fs::path(file).stem().string();
    if (!is_one) name.append(1, '_').append(std::to_string(i + 1));
    const double after_s = recording.pieces[i].time_s(0) - start_s;
    DatasetRecord record =
        described_record(document, entry, where, name, std::move(recording.pieces[i]));
    if (record.period_samples > longest)
      refuse_dataset(where + "/period_samples",
                     "is longer than the record of " + std::to_string(longest) + " samples");
    if (record.period_samples > record.record.n_samples()) continue;
    record.clock_start_s += after_s;
    dataset.records.push_back(std::move(record));
  }
}

Dataset read_described(const fs::path& folder, const fs::path& file, const ReadOptions& given) {
  const json document = read_json(file);
  const std::string name = file.string();
  if (!document.is_object() || text_of(document, "schema", name, "") != "vibrissa-dataset-1")
    refuse_dataset(name + ": /schema", "must be \"vibrissa-dataset-1\"");
  if (!document.contains("records") || !document["records"].is_array() ||
      document["records"].empty())
    refuse_dataset(name + ": /records", "must list at least one record");
  refuse_misplaced(document, name);
  Dataset dataset;
  for (std::size_t i = 0; i < document["records"].size(); ++i)
    read_entry(folder, document, document["records"][i], name + ": /records/" + std::to_string(i),
               given, dataset);
  refuse_doubled_levels(dataset.responses, name);
  use_repeats(dataset.responses);
  return dataset;
}

/// Whether the signal is as small as the noise of a small accelerometer, and white: no correlation
/// up to lag ten (Box and Pierce, 1970).
bool is_accelerometer_noise(const std::span<const double> values) {
  constexpr double most_m_s2 = 0.1, chance_of_a_thousandth = 29.6;  // chi-squared of 10
  constexpr std::size_t n_lags = 10;
  const std::vector<double> x = remove_mean(values);
  const auto product = [&](const std::size_t lag) {
    return std::inner_product(x.begin() + static_cast<std::ptrdiff_t>(lag), x.end(), x.begin(), 0.);
  };
  const double power = product(0), n = static_cast<double>(x.size());
  if (power > n * most_m_s2 * most_m_s2) return false;
  double correlated = 0.;
  for (std::size_t lag = 1; lag <= n_lags; ++lag) correlated += std::pow(product(lag) / power, 2);
  return n * correlated < chance_of_a_thousandth;
}

bool moves(const Record& record, const std::string& channel) {
  if (!record.has(channel)) return false;
  const auto values = record.channel(channel);
  if (std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); }))
    return false;
  return channel != channel::base_acceleration || !is_accelerometer_noise(values);
}

// Sound files contain drives; measured records have the other formats.
bool may_be_a_record(const fs::path& file) {
  const std::string extension = formats::extension_of(file);
  const auto& known = formats::file_formats();
  return std::any_of(known.begin(), known.end(), [&](const formats::FileFormat& format) {
    return format.write && format.has(extension);
  });
}

std::vector<fs::path> record_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (may_be_a_record(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty())
    throw UserError(
        folder.string() +
        ": contains neither dataset.json nor a record; name a record or a folder with records");
  return files;
}

double power(const std::span<const double> values) {
  const std::vector<double> x = remove_mean(values);
  return std::inner_product(x.begin(), x.end(), x.begin(), 0.) / static_cast<double>(x.size());
}

/// Whether the base comes to rest before the last third, as in an earthquake: what is left there is
/// a decay without a drive, which scores no prediction.
bool ends_before(const Record& record, const std::size_t n_fit, const Excitation& excitation) {
  if (!excitation.base || excitation.wind) return false;
  constexpr double at_rest = 1e-2;  // of the power, 20 dB
  const auto acceleration = record.channel(channel::base_acceleration);
  return power(acceleration.subspan(n_fit)) < at_rest * power(acceleration.first(n_fit));
}

void add_guessed(const std::string& name, const Record& record, const double clock_start_s,
                 Dataset& dataset) {
  const Excitation excitation = guessed_excitation(record);
  const std::size_t n_fit = record.n_samples() * 2 / 3;
  if (ends_before(record, n_fit, excitation)) {
    dataset.records.push_back(
        {.name = name, .record = record, .excitation = excitation, .clock_start_s = clock_start_s});
    dataset.guesses.push_back(name +
                              ": excitation base, not periodic, not held out, because the base "
                              "rests in its last third");
    return;
  }
  dataset.records.push_back({.name = name,
                             .record = record.slice(0, n_fit),
                             .excitation = excitation,
                             .split = Split::fit,
                             .clock_start_s = clock_start_s});
  dataset.records.push_back(
      {.name = name + "_last_third",
       .record = record.slice(n_fit, record.n_samples() - n_fit),
       .excitation = excitation,
       .split = Split::held_out,
       .clock_start_s = clock_start_s + record.time_s(n_fit) - record.time_s(0)});
  dataset.guesses.push_back(name + ": excitation " + to_string(excitation) +
                            ", not periodic, last third held out");
}

/// Where no record has a part that is held out, the last of several.
void hold_out_last(Dataset& dataset) {
  const bool holds_out = std::ranges::any_of(
      dataset.records, [](const DatasetRecord& r) { return r.split == Split::held_out; });
  if (holds_out || dataset.records.size() < 2) return;
  dataset.records.back().split = Split::held_out;
  dataset.guesses.back() = dataset.records.back().name +
                           ": excitation base, not periodic, held out, because the base rests in "
                           "the last third of every record";
}

Dataset guess(const std::vector<fs::path>& files, const ReadOptions& options) {
  Dataset dataset;
  for (const fs::path& file : files) {
    const Recording recording = read_recording(file, options);
    dataset.readings.push_back({file.string(), recording.words});
    const bool is_one = recording.pieces.size() == 1;
    const double start_s = recording.pieces.front().time_s(0);
    for (std::size_t i = 0; i < recording.pieces.size(); ++i) {
      std::string name = file.stem().string();
      if (!is_one) name.append("_").append(std::to_string(i + 1));
      const signals::Record& piece = recording.pieces[i];
      add_guessed(name, piece, piece.time_s(0) - start_s, dataset);
    }
  }
  hold_out_last(dataset);
  return dataset;
}

}  // namespace

Excitation guessed_excitation(const Record& record) {
  return {.base = moves(record, channel::base_acceleration),
          .wind = moves(record, channel::wind_speed)};
}

std::string to_string(const Excitation& excitation) {
  if (excitation.base && excitation.wind) return "base+wind";
  if (excitation.base) return "base";
  return excitation.wind ? "wind" : "none";
}

std::vector<std::string> short_readings(const std::vector<FileReading>& readings) {
  // Without the part "4096 samples, 8.192 s".
  const auto layout_of = [](const FileReading& reading) {
    const std::string& words = reading.words;
    const std::size_t at = words.find(" samples, ");
    if (at == std::string::npos) return words;
    const std::size_t begin = words.rfind("; ", at), end = words.find("; ", at);
    return words.substr(0, begin) + (end == std::string::npos ? "" : words.substr(end));
  };
  const auto is_alike = [&](const FileReading& reading) {
    return layout_of(reading) == layout_of(readings.front());
  };
  std::vector<std::string> lines;
  if (readings.size() > 1 && std::ranges::all_of(readings, is_alike))
    return {std::to_string(readings.size()) + " files (" + readings.front().file +
            ", ...) read as: " + layout_of(readings.front())};
  for (const FileReading& reading : readings) lines.push_back(to_string(reading));
  return lines;
}

Dataset read_dataset(const fs::path& source, const ReadOptions& options) {
  if (!fs::exists(source)) throw UserError(source.string() + ": does not exist");
  const fs::path description = source / "dataset.json";
  Dataset dataset = !fs::is_directory(source) ? guess({source}, options)
                    : fs::exists(description) ? read_described(source, description, options)
                                              : guess(record_files(source), options);
  for (const DatasetRecord& entry : dataset.records)
    if (!entry.record.has(channel::base_moment))
      throw UserError((source / entry.name).string() + ": has no channel " + channel::base_moment);
  return dataset;
}

}  // namespace vibrissa::signals
