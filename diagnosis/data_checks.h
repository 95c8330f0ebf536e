#pragma once

#include <string>
#include <vector>

#include "diagnosis/nominal_model.h"
#include "signals/dataset.h"

namespace vibrissa::diagnosis {

enum class FindingKind {
  clipped_channel,
  swapped_columns,
  wrong_unit,
  repeated_samples,
  no_quiet_record,
  one_level,
  missing_wind,
  missing_acceleration,
  no_held_out,
  different_rate
};
std::string to_string(FindingKind kind);

/// Something about the data that a reader of the answer must know.
struct Finding {
  FindingKind kind = FindingKind::clipped_channel;
  std::string record{};  // empty: of the dataset
  std::string message{};
};

/// Is it a mistake that makes every number of the diagnosis wrong?
bool spoils_everything(FindingKind kind);

/// Looks for bad and poor data: extremes that repeat, columns that are exchanged, a factor between
/// measured and nominal response that is one between units, equal neighbours, and what is missing.
/// simulated_rate_hz: 0 when the simulation has none. Proven by
/// tests/diagnosis/data_checks_test.cc.
std::vector<Finding> check_data(const NominalModel& nominal, const signals::Dataset& real,
                                double simulated_rate_hz = 0.);

}  // namespace vibrissa::diagnosis
