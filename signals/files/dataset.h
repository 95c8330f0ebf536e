#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "signals/files/record_io.h"
#include "signals/record/bench_setup.h"
#include "signals/record/record.h"

namespace vibrissa::signals {

/// What moved the sensor during a record.
struct Excitation {
  bool base = false;
  bool wind = false;
  bool operator==(const Excitation&) const = default;
};
/// none, base, wind or base+wind.
std::string to_string(const Excitation& excitation);

/// fit: may be used to fit, choose and tune. held_out: only to score.
enum class Split { fit, held_out };

/// moment: the base moment itself. rotation: a statically calibrated Hall element over the
/// silicone, M = k_nominal phi.
enum class Readout { moment, rotation };

struct DatasetRecord {
  std::string name;  // of the file, without extension
  Record record;
  Excitation excitation;
  std::size_t period_samples = 0;  // 0: not periodic; else periodic and in steady state
  Split split = Split::fit;
  Readout readout = Readout::moment;
  BenchSetup setup{};
  /// How long both clocks had run when the record began: of a piece cut from a longer one [s].
  double clock_start_s = 0.;
};

/// Records of one sensor, as docs/records.md describes the folder.
struct Dataset {
  std::vector<DatasetRecord> records;
  /// What had to be guessed because the folder does not say it; empty when it does.
  std::vector<std::string> guesses;
};

/// Reads FOLDER/dataset.json ("vibrissa-dataset-1") and its records. Without dataset.json: every
/// record file of the folder, or the one file that is named, excitation guessed from the columns
/// that move (an acceleration that is white and below 0.1 m/s2 rms is noise), the last third of
/// each record held out. dataset.json may say, for all records or for one, "columns":
/// {"base_acceleration": "ax[g]"} and "remove_mean": ["base_acceleration"]; where it does not, the
/// options given here hold. Throws UserError with file and entry for: nothing there, no records, a
/// wrong schema or entry (lists the known words), a rate that contradicts time_s, a period longer
/// than its record, a record without a base moment, and whatever read_record refuses. Proven by
/// tests/signals/files/dataset_test.cc.
Dataset read_dataset(const std::filesystem::path& source, const ReadOptions& options = {});

}  // namespace vibrissa::signals
