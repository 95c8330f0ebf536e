#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "signals/files/dataset_response.h"
#include "signals/files/record_io.h"
#include "signals/record/bench_setup.h"
#include "signals/record/record.h"
#include "signals/record/split.h"

namespace vibrissa::signals {

/// What excited the sensor during a record.
struct Excitation {
  bool base = false;
  bool wind = false;
  bool operator==(const Excitation&) const = default;
};
/// none, base, wind or base+wind.
std::string to_string(const Excitation& excitation);

/// moment: the base moment itself. rotation: a statically calibrated Hall element over the
/// silicone, M = k_nominal phi.
enum class Readout { moment, rotation };

struct DatasetRecord {
  std::string name;  // file name without extension
  Record record;
  Excitation excitation;
  std::size_t period_samples = 0;  // 0: not periodic; else periodic and in steady state
  Split split = Split::fit;
  Readout readout = Readout::moment;
  BenchSetup setup{};
  /// Time that both clocks had run when the record began, for a part of a longer record [s].
  double clock_start_s = 0.;
  bool readout_is_given = false;  // otherwise the readout is a guess
};

/// Records of one sensor; docs/records.md describes the folder.
struct Dataset {
  std::vector<DatasetRecord> records;
  std::vector<DatasetResponse> responses{};
  /// Assumptions about what the folder does not state; empty when it states everything.
  std::vector<std::string> guesses{};
  std::vector<FileReading> readings = {};  // of each file
};

/// What excited the sensor, as far as the channels tell: base or wind whose channel varies, where a
/// white acceleration below 0.1 m/s2 rms is noise. Proven by tests/signals/files/dataset_test.cc.
Excitation guessed_excitation(const Record& record);

/// The readings of a dataset as text, in one line where all files were read alike but for their
/// lengths: "8 files (bench/a.csv, ...) read as: commas, ...". Proven by
/// tests/signals/files/dataset_test.cc.
std::vector<std::string> short_readings(const std::vector<FileReading>& readings);

/// Reads FOLDER/dataset.json ("vibrissa-dataset-1") and its records. Without dataset.json it reads
/// every record file of the folder, or the one given file; the excitation is guessed from the
/// channels that vary (a white acceleration below 0.1 m/s2 rms is noise), and the last third of
/// each record is held out. dataset.json may contain, for all records or for one, "columns":
/// {"base_acceleration": "ax[g]"} and "remove_mean": ["base_acceleration"]; otherwise the given
/// options apply. An entry of the kind response is read by read_dataset_response() where
/// options.takes_responses allows it, otherwise refused. Where samples are lost and options.gaps
/// allows it, each piece is a record. Throws UserError with file and entry for: a missing source,
/// no records, a wrong schema or entry (lists the known words), a rate that contradicts time_s, a
/// period longer than its record, a record without a base moment, and all errors of read_record.
/// Proven by tests/signals/files/dataset_test.cc.
Dataset read_dataset(const std::filesystem::path& source, const ReadOptions& options = {});

}  // namespace vibrissa::signals
