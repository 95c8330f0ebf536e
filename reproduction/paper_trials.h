#pragma once

#include <optional>
#include <string>
#include <vector>

#include "case/rig.h"
#include "reproduction/paper_sensors.h"
#include "separation/identification/identify.h"
#include "views/records/separation_scores.h"

namespace vibrissa::reproduction {

/// A rig of the reference paper with its identified model and separated signals.
struct PaperTrial {
  sensor_case::RigRecords records;
  separation::Identification identified;
  std::vector<views::SeparatedSignal> separated;  // "BVRM", "FDAF", "nothing removed"
  std::optional<double> fdaf_convergence_s;
  /// Power of the vibration left in the FDAF's estimate from 0.25 to 0.5 s, divided by that of the
  /// vibration.
  double fdaf_left_early_db = 0.;
};

/// Records of the paper's simulation with this sensor: 1 kHz, no noise, 21 s.
sensor_case::RigRecords paper_simulation_records(const signals::ReducedModel& model);

/// Figure 10: the simulated flow sensor at 1 kHz without noise, ten lines within 1 .. 200 Hz up to
/// 1.5 g, turbulent wind up to 4 m/s; FDAF with L = 20, mu = 0.1.
PaperTrial simulate_paper_simulation(const PaperSensors& sensors);

/// Figures 11 and 12: the built sensor at 500 Hz with the noise of its accelerometer and Hall
/// element, lines 12 .. 29 Hz up to 0.4 g, turbulent wind about 1.6 Hz; FDAF with L = 200, mu =
/// 0.001; BVRM from frequency-domain data, the periods of a record without wind.
PaperTrial simulate_paper_experiment(const PaperSensors& sensors);

/// Fit in percent on the held-out last third of a simulated record without wind; the order is
/// chosen by an information criterion.
double held_out_fit_percent(const signals::Record& vibration_only,
                            separation::IdentifyMethod method);

/// One interpretation of the paper's FDAF settings, applied to the simulated experiment.
struct FdafReading {
  std::string name;
  std::size_t block_length = 0, filter_length = 0;
  double step = 0.;
  double sdr_db = 0., nothing_removed_sdr_db = 0.;
  std::optional<double> convergence_s;
  /// Duration of 1 / mu blocks [s]: the time to learn a strong line.
  double learning_time_s = 0.;
  /// Share of the energy of the sensor's impulse response that lies beyond the filter's taps.
  double missing_energy = 0.;
};
std::vector<FdafReading> compare_fdaf_readings(const PaperSensors& sensors,
                                               const PaperTrial& experiment);

}  // namespace vibrissa::reproduction
