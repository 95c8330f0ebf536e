#pragma once

#include <string>
#include <vector>

#include "diagnosis/model/effect.h"
#include "diagnosis/model/updated_model.h"
#include "diagnosis/records/noise_colour.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// One record made ready: what moved the sensor as spectra over the whole record, what was measured
/// as the spectrum of the part that is evaluated. DFTs are unscaled.
struct PreparedRecord {
  std::string name;
  signals::Excitation excitation;
  std::size_t number = 0;  // in the order of the dataset
  signals::Readout readout = signals::Readout::moment;
  bool magnet = true;      // without it the sensor reads nothing of the structure
  double wind_share = 1.;  // of the wind's force, in the plane that is read
  double sampling_rate_hz = 0.;
  double clock_start_s = 0.;  // how long the clocks had run
  std::size_t n_samples = 0;  // of the whole record
  bool periodic = false;      // the whole record is whole periods
  std::size_t first = 0,
              n_evaluated = 0;  // samples that are evaluated: the start may hold transients

  std::vector<Complex> acceleration;        // k = 0 .. n/2, noise reduced; empty: not measured
  std::vector<Complex> renewed;             // its source's; empty: not polled
  double unknown_age_s = 0.;                // deviation of when the source is read
  std::vector<Complex> cross_acceleration;  // empty: not measured
  std::vector<double> wind;                 // at the samples; empty: not measured
  /// Share of the accelerometer noise that is left at line k of the whole record.
  std::vector<double> noise_share;
  /// The same at the evaluated bins.
  std::vector<double> bin_noise_share;
  ChannelColours colours{};              // of the noise of both channels
  double acceleration_noise_power = 0.;  // sum |A_k|^2 where nothing moved, for its variance
  std::size_t n_acceleration_noise = 0;  // lines in it

  std::vector<Complex> moment;  // bins 1 .. of the evaluated part
  std::size_t n_bins() const { return moment.size(); }
  double bin_hz() const { return sampling_rate_hz / static_cast<double>(n_evaluated); }
  /// Line of the whole record nearest to evaluated bin b (0 is the DFT's 1).
  std::size_t whole_line(std::size_t b) const;
  /// s = j 2 pi f of line k of the whole record.
  Complex line_s(std::size_t k) const;
  /// Nothing is known to move the sensor.
  bool is_still() const { return wind.empty() && has_zero_inputs; }
  bool has_zero_inputs = false;  // both accelerations are empty or zero
};

/// How a record is prepared: as a fit record (noise of its inputs reduced) or as it was measured.
enum class InputNoise { reduced, as_measured };

/// The fit records of one sensor with the nominal model, ready for hypotheses.
struct Experiment {
  NominalModel nominal;
  std::vector<KnownEffect> known;  // effects that are part of the simulation
  std::vector<PreparedRecord> records;
  Scales scales;
  double moment_noise = 0.;        // guess, a sample [N m]
  double acceleration_noise = 0.;  // guess, a sample [m/s^2]
  bool has_base = false, has_wind = false, has_cross = false, has_repeats = false;

  /// The simulation as it is.
  Chain nominal_chain() const { return UpdatedModel(nominal, known).chain(); }
};

/// An ADXL345 or its like at rest, a sample [m/s^2]: docs/theory.md (T15) gives 0.008 g as its
/// bound.
inline constexpr double usual_acceleration_noise = 0.05;

/// Fewest samples of which something is left to judge once the unknown start has decayed.
std::size_t fewest_samples(const NominalModel& nominal, const signals::DatasetRecord& entry);

/// Can the chain be set up so? An added mass needs the sensor's moment of inertia and a clamped
/// stage the coil's force, which neither records nor the nominal model hold.
bool is_simulated(const signals::BenchSetup& setup);

/// Are all excitations of a record measured, and known to the simulation, and is it long enough?
/// Proven by tests/diagnosis/records/experiment_test.cc.
bool is_comparable(const NominalModel& nominal, const signals::DatasetRecord& entry);

/// What an experiment may lack of what an effect needs.
enum class Lack { base, wind, cross, repeats, modes, duration };
/// All of it, in that order.
std::vector<Lack> lacks(const Experiment& experiment, const Effect& effect);
/// Does the experiment hold what the effect needs?
bool shows(const Experiment& experiment, const Effect& effect);

/// Only comparable records of the given split. Throws UserError when fit records are asked for and
/// none of them is moved.
Experiment prepare_experiment(const UpdatedModel& simulation, const signals::Dataset& dataset,
                              signals::Split split, InputNoise noise);

/// Standard deviations a sample of both channels, from records at rest and from what periods do not
/// share; else from the quietest part of the spectrum, which is an upper bound, and which for the
/// acceleration is no more than usual. Proven by tests/diagnosis/records/experiment_test.cc.
struct ChannelNoise {
  double moment_n_m = 0., acceleration_m_s2 = 0.;
};
ChannelNoise channel_noise(const signals::Dataset& dataset);

}  // namespace vibrissa::diagnosis
