#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnosis/model/nominal_model.h"
#include "diagnosis/records/experiment.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Noise of the reference rig, a sample: the Hall element's 5.43 uT at 0.18 N m/T (docs/theory.md,
/// T15), and an ADXL345's at rest.
ChannelNoise usual_noise();

/// What shall move the sensor in one record.
struct PlannedInput {
  std::string name{};
  double sampling_rate_hz = 500.;
  std::size_t n_samples = 0;
  std::vector<double> acceleration{};        // m/s^2; empty: base at rest
  std::vector<double> cross_acceleration{};  // m/s^2; empty: not measured
  std::vector<double> wind{};                // m/s; empty: no wind
  std::size_t period_samples = 0;            // 0: not periodic
};

/// The inputs of the fit records of a simulation that the nominal model can predict. Channels that
/// are zero throughout are none. Throws UserError when nothing is left.
std::vector<PlannedInput> inputs_of(const NominalModel& nominal, const signals::Dataset& dataset);

/// Where there are no records: two periods of a multisine on odd lines from 4 Hz to a quarter of
/// the rate at 1 and 4 m/s^2 rms and, where the model knows wind, ten seconds of gusts about 2 m/s.
std::vector<PlannedInput> usual_inputs(const NominalModel& nominal, double sampling_rate_hz);

PlannedInput quiet_input(double duration_s, double sampling_rate_hz);
/// Two periods of 2048 samples: odd lines, every fourth of them left out, random phases.
PlannedInput multisine_input(const std::string& name, double low_hz, double high_hz, double rms,
                             double sampling_rate_hz);
/// Gusts of a quarter of the mean speed, three decades of lines up to 40 Hz.
PlannedInput gust_input(const std::string& name, double mean_m_s, double duration_s,
                        double sampling_rate_hz);

/// Records as the nominal sensor would write them with white noise on both channels; the same noise
/// in every call. Proven by tests/diagnosis/planning/planned_records_test.cc.
signals::Dataset planned_dataset(const NominalModel& nominal,
                                 const std::vector<PlannedInput>& inputs,
                                 const ChannelNoise& noise);

}  // namespace vibrissa::diagnosis
