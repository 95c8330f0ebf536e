#pragma once

#include <optional>
#include <vector>

#include "diagnosis/checks/finding.h"
#include "diagnosis/model/nominal_model.h"

namespace vibrissa::diagnosis {

/// The largest delay that filters and conversion times of one measuring chain cause [s]; more means
/// that two devices recorded the channels.
inline constexpr double longest_delay_s = 6e-3;

/// Samples by which the base moment is later than the acceleration of the same row; nothing when
/// the record does not tell it. Peak of the phase transform between the moment that the simulation
/// predicts and the measured one (Knapp and Carter 1976), from the lines that base motion excites.
/// Proven by tests/diagnosis/checks/clock_offset_test.cc.
std::optional<std::ptrdiff_t> clock_offset(const NominalModel& nominal,
                                           const signals::DatasetRecord& entry);

struct AlignedDataset {
  signals::Dataset dataset{};
  std::vector<Finding> findings{};
  bool is_shifted() const { return !findings.empty(); }
};

/// The dataset with the moment of each record shifted back, where it is off by more than
/// longest_delay_s. A shift cuts both ends of a record, and turns a record of whole periods.
AlignedDataset align_clocks(const NominalModel& nominal, const signals::Dataset& dataset);

}  // namespace vibrissa::diagnosis
