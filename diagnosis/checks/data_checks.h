#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "diagnosis/checks/finding.h"
#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// What a record shows without a simulation: missing, clipped, constant, stuck and repeating
/// channels, spikes, exchanged axes, a period that the record does not have.
void check_recording(const signals::DatasetRecord& entry, std::vector<Finding>& findings);
/// Of these the ones that need one channel: clipping and repeated samples.
void check_samples(const signals::DatasetRecord& entry, std::vector<Finding>& findings);

/// Paths of the sensor that a diagnosis is to decide on.
struct WantedPaths {
  bool base = true, wind = true;
};

using UsableRecord = std::function<bool(const signals::DatasetRecord&)>;

/// Records that are missing: at rest, held out, with base motion, with wind, at a second level.
void check_what_is_there(const WantedPaths& wanted, const UsableRecord& is_usable,
                         const signals::Dataset& real, std::vector<Finding>& findings);

/// Channels that contradict the excitation stated for the record: constant where they must vary, or
/// stuck at one value for a while, unless the drive has ended and the moment decays; spikes. Proven
/// by tests/diagnosis/checks/dead_channels_test.cc.
void check_dead_channels(const signals::DatasetRecord& entry, std::vector<Finding>& findings);

/// Does the acceleration repeat after period_samples? Its tones must lie on multiples of the
/// period's frequency. Proven by tests/diagnosis/checks/period_check_test.cc.
void check_period(const signals::DatasetRecord& entry, std::vector<Finding>& findings);

/// Records at rest in which base and moment move: not as white noise, and at least half as much as
/// in the record with the smallest base motion.
void check_rest(const signals::Dataset& dataset, std::vector<Finding>& findings);

/// Differences between measured and nominal response that no sensor can have: a factor between
/// units, exchanged columns, an opposite sign, a time unit that puts the first mode out of the
/// measured band. The excitation must exceed the noise.
void check_response(const NominalModel& nominal, const signals::DatasetRecord& entry,
                    double acceleration_noise_m_s2, std::vector<Finding>& findings);

/// All of these, and records that are too short. simulated_rate_hz: 0 for none. Proven by
/// tests/diagnosis/checks/data_checks_test.cc.
std::vector<Finding> check_data(const NominalModel& nominal, const signals::Dataset& real,
                                double simulated_rate_hz = 0.);

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
