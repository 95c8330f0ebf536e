#pragma once

#include <string>
#include <vector>

#include "diagnosis/model/effect.h"
#include "diagnosis/model/updated_model.h"
#include "diagnosis/records/channel_noise.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// What a response has instead of samples: the steady state under one sine in each bin. A sine of
/// amplitude A counts as a line of per_amplitude A of a DFT of 2 (n + 1) samples, so that the sines
/// together have the power of a record whose n lines share it.
struct SineLines {
  std::vector<double> frequency_hz{};  // rising; empty: a record in time
  signals::SweepDirection direction = signals::SweepDirection::up;
  double per_amplitude = 1.;
  bool phase_is_known = true;         // otherwise all lines may be turned by one angle
  std::vector<double> noise_share{};  // of the bins, relative to white noise of the moment
};

/// One prepared record: the excitation as spectra over the whole record, the measured moment as the
/// spectrum of the evaluated part. DFTs are unscaled. A response has its sines as bins instead.
struct PreparedRecord {
  std::string name;
  signals::Excitation excitation;
  std::size_t number = 0;  // index in the dataset
  signals::Readout readout = signals::Readout::moment;
  bool magnet = true;      // without magnet the sensor does not read the structure
  double wind_share = 1.;  // of the wind force, in the measured plane
  double sampling_rate_hz = 0.;
  double clock_start_s = 0.;               // running time of the clocks at the start
  std::size_t n_samples = 0;               // length of the whole record
  bool periodic = false;                   // the record consists of whole periods
  std::size_t first = 0, n_evaluated = 0;  // samples free of transients

  std::vector<Complex> acceleration{};  // k = 0 .. n/2, with reduced noise; empty: not measured
  std::vector<Complex> source_acceleration{};  // of its source's samples; empty: no repeats
  double unknown_age_s = 0.;  // standard deviation of the reading time of the source
  std::vector<Complex> cross_acceleration{};  // empty: not measured
  std::vector<double> wind{};                 // one value per sample; empty: not measured
  /// Share of the accelerometer noise that remains at lines of the whole record, and at its bins.
  std::vector<double> noise_share{}, bin_noise_share{};
  ChannelColours colours{};  // of the noise of both channels
  SineLines sines{};
  double acceleration_noise_power = 0.;  // sum |A_k|^2 at rest, for the noise variance
  std::size_t n_acceleration_noise = 0;  // number of lines in the sum

  std::vector<Complex> moment{};  // bins 1 .. of the evaluated part
  std::size_t n_bins() const { return moment.size(); }
  bool is_response() const { return !sines.frequency_hz.empty(); }
  bool is_steady() const { return periodic || is_response(); }
  double frequency_hz(const std::size_t b) const {
    return is_response() ? sines.frequency_hz[b] : bin_hz() * static_cast<double>(b + 1);
  }
  /// Distance of the bins; of a response its mean.
  double bin_hz() const { return sampling_rate_hz / static_cast<double>(n_evaluated); }
  /// Samples in a block of a bootstrap: a quarter of a second, or a sixteenth of a response.
  std::size_t block_length() const;
  /// Line of the whole record nearest to evaluated bin b (b = 0 is bin 1 of the DFT).
  std::size_t whole_line(std::size_t b) const;
  /// s = j 2 pi f of line k of the whole record.
  Complex line_s(std::size_t k) const;
  /// Is the record without excitation?
  bool is_still() const { return wind.empty() && has_zero_inputs; }
  bool has_zero_inputs = false;  // both accelerations are empty or zero
};

/// Whitened bins of a record under a fit.
struct WhitenedRecord {
  std::vector<Complex> error;     // (measured - mean) / sqrt(variance)
  std::vector<double> deviation;  // sqrt(variance) [N m]
};

/// Samples of a record's evaluated part from its bins (as PreparedRecord::moment), without the mean
/// and the component at half the sampling rate. For a response: real and imaginary parts of the
/// bins in turn, with the same sum of squares.
std::vector<double> evaluated_samples(const PreparedRecord& record, std::span<const Complex> bins);

/// Bins of the evaluated part, as PreparedRecord::moment, from the samples of a whole record.
std::vector<Complex> evaluated_bins(const PreparedRecord& record, std::span<const double> samples);

/// The same from the lines k = 0 .. n/2 of a whole record.
std::vector<Complex> bins_of_lines(const PreparedRecord& record, const std::vector<Complex>& whole);

/// Preparation of a record: with reduced input noise (fit records) or as measured.
enum class InputNoise { reduced, as_measured };

inline constexpr double usual_simulation_accuracy = 0.01;
/// Largest power of a simulation's error, relative to the response, that needs no cause: twice the
/// accuracy, which is the median of such errors.
constexpr double power_without_cause(const double accuracy) {
  return 4. * accuracy * accuracy;
}

/// Power of the error, relative to the measured moment, below which nothing is sought or named:
/// 95 % of simulations of this accuracy, whose logarithm has the spread 1, have more.
constexpr double least_error_power(const double accuracy) {
  return 0.037 * accuracy * accuracy;
}

/// The prepared fit records of one sensor with the nominal model.
struct Experiment {
  NominalModel nominal;
  /// Modes identified from the records themselves; fits begin there, too. May be empty.
  std::vector<StructuralMode> measured_modes{};
  std::vector<KnownEffect> known;  // effects that the simulation already contains
  std::vector<PreparedRecord> records;
  Scales scales;
  double moment_noise = 0.;        // estimate per sample [N m]
  double acceleration_noise = 0.;  // estimate per sample [m/s^2]
  bool acceleration_noise_is_measured = true;
  bool has_base = false, has_wind = false, has_cross = false, has_repeats = false;
  /// Relative error of its form that a simulation usually has (model_discrepancy.h).
  double simulation_accuracy = usual_simulation_accuracy;

  /// The chain of the simulation without further effects.
  Chain nominal_chain() const { return UpdatedModel(nominal, known).chain(); }
};

/// Smallest record length that has evaluated samples after the transients.
std::size_t fewest_samples(const NominalModel& nominal, const signals::DatasetRecord& entry);

/// Can this setup be simulated? An added mass requires the sensor's moment of inertia and a clamped
/// stage the coil's force, which neither the records nor the nominal model contain.
bool is_simulated(const signals::BenchSetup& setup);

/// Are all excitations of a record measured and simulated, and is it long enough?
/// Proven by tests/diagnosis/records/experiment_test.cc.
bool is_comparable(const NominalModel& nominal, const signals::DatasetRecord& entry);

/// Can a response be compared with the simulation?
bool is_comparable(const NominalModel& nominal, const signals::DatasetResponse& entry);

/// Requirements of an effect that an experiment may lack.
enum class Lack { base, wind, cross, repeats, modes, duration, band, time };
/// All missing requirements, in that order.
std::vector<Lack> lacks(const Experiment& experiment, const Effect& effect);
/// Does the experiment contain everything that the effect needs?
bool shows(const Experiment& experiment, const Effect& effect);

/// Prepares the comparable records and responses of the given split. Throws UserError when fit
/// records are requested and none of them has an excitation.
Experiment prepare_experiment(const UpdatedModel& simulation, const signals::Dataset& dataset,
                              signals::Split split, InputNoise noise);

/// Records with at most this many samples are used completely. Longer records cost memory and time
/// without more information on any effect, except a drift, which needs the duration and not the
/// samples.
inline constexpr std::size_t longest_whole_record = std::size_t{1} << 17;

/// Replaces each longer record by four pieces with this many samples in total, spread from its
/// beginning to its end (whole periods of a periodic record), with the clock's time at their start.
/// An entry in guesses reports it. Proven by tests/diagnosis/records/long_records_test.cc.
signals::Dataset in_pieces(const signals::Dataset& dataset);

}  // namespace vibrissa::diagnosis
