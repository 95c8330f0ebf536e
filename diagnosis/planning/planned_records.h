#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/model/nominal_model.h"
#include "diagnosis/records/experiment.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Noise of the reference rig, standard deviation per sample: 5.43 uT of the Hall element at 0.18 N
/// m/T (docs/theory.md, T15), and that of an ADXL345 at rest.
ChannelNoise usual_noise();

/// The planned excitation of one record.
struct PlannedInput {
  std::string name{};
  double sampling_rate_hz = 500.;
  std::size_t n_samples = 0;
  std::vector<double> acceleration{};        // m/s^2; empty: base at rest
  std::vector<double> cross_acceleration{};  // m/s^2; empty: not measured
  std::vector<double> wind{};                // m/s; empty: no wind
  std::size_t period_samples = 0;            // 0: not periodic
};

/// The inputs of a simulation's fit records that the nominal model can predict. Channels that are
/// zero at all samples count as missing. Throws UserError when no record is left.
std::vector<PlannedInput> inputs_of(const NominalModel& nominal, const signals::Dataset& dataset);

/// Inputs for a model without records: two periods of a multisine on odd lines from 4 Hz to a
/// quarter of the sampling rate, at 1 and 4 m/s^2 rms, and, when the model has a wind path, ten
/// seconds of gusts about 2 m/s.
std::vector<PlannedInput> usual_inputs(const NominalModel& nominal, double sampling_rate_hz);

PlannedInput quiet_input(double duration_s, double sampling_rate_hz);
/// Two periods of 2048 samples: odd lines with random phases, every fourth of them left out.
PlannedInput multisine_input(const std::string& name, double low_hz, double high_hz, double rms,
                             double sampling_rate_hz);
/// Gusts with a standard deviation of a quarter of the mean speed, on lines over three decades up
/// to 40 Hz.
PlannedInput gust_input(const std::string& name, double mean_m_s, double duration_s,
                        double sampling_rate_hz);

/// Records of the nominal sensor with white noise on both channels; the noise is the same in every
/// call. Proven by tests/diagnosis/planning/planned_records_test.cc.
signals::Dataset planned_dataset(const NominalModel& nominal,
                                 const std::vector<PlannedInput>& inputs,
                                 const ChannelNoise& noise);

/// The records that an entry of experiment_menu() adds to the planned ones. Nothing when the
/// nominal model cannot predict them: changes of the sensor or its stage, or wind that the
/// simulation does not include. The base motion is that of the strongest planned record, or that of
/// usual_inputs(). Proven by tests/diagnosis/planning/planned_records_test.cc.
std::optional<std::vector<PlannedInput>> added_inputs(const std::string& entry,
                                                      const NominalModel& nominal,
                                                      const std::vector<PlannedInput>& planned);

}  // namespace vibrissa::diagnosis
