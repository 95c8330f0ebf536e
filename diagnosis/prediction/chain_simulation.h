#pragma once

#include <span>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/prediction/joint_simulation.h"
#include "diagnosis/prediction/linear_response.h"
#include "diagnosis/prediction/record_nuisances.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// What a chain predicts of one prepared record, bins as PreparedRecord::moment.
struct Prediction {
  std::vector<Complex> mean;
  /// Of white noise of unit standard deviation a sample at both channels, and of the effects' own.
  std::vector<double> moment_noise;        // times the moment's variance
  std::vector<double> acceleration_noise;  // times the accelerometer's variance
  std::vector<double> process_noise;       // as it is
  std::vector<RecordNuisance> unknowns;    // the rise of a drift, when a source was read
};

/// Predicts records under one chain, which must outlive it. Linear parts exactly for band-limited
/// inputs, by transfer functions at the lines of the record (its start, where the circular
/// continuation is wrong, is not evaluated); what the joint and the relative wind add is integrated
/// in time.
class ChainSimulator {
 public:
  explicit ChainSimulator(const Chain& chain) : chain_(chain), response_(chain) {}

  std::vector<Prediction> predict(std::span<const PreparedRecord> records);
  std::vector<std::vector<Complex>> means(std::span<const PreparedRecord> records);
  /// The reading [N m] at every sample of a record, its mean included.
  std::vector<double> samples(const PreparedRecord& record);

 private:
  using Spectra = std::vector<std::vector<Complex>>;  // of each record, at its whole lines
  /// Linear parts, and what is to be integrated of the dynamic ones of some records.
  struct Begun {
    Spectra moments;
    std::vector<std::size_t> indices{};  // of the task's records
    DynamicTask task{};
  };
  friend std::vector<std::vector<Prediction>> predict_together(
      std::span<const Chain> chains, std::span<const PreparedRecord> records);

  Begun begin(std::span<const PreparedRecord> records);
  Spectra finish(std::span<const PreparedRecord> records, Begun begun,
                 const std::vector<std::vector<double>>& dynamic);
  Spectra readings(std::span<const PreparedRecord> records);
  std::vector<Prediction> predictions(std::span<const PreparedRecord> records,
                                      const Spectra& readings);
  Spectra linear_moments(std::span<const PreparedRecord> records);
  std::vector<Complex> reading(const PreparedRecord& record, std::vector<Complex> moment);
  std::vector<RecordNuisance> unknowns_of(const PreparedRecord& record);
  void add_acceleration_noise(const PreparedRecord& record, std::span<double> variance);
  Prediction with_noise(const PreparedRecord& record, std::vector<Complex> mean);

  const Chain& chain_;
  LinearResponse response_;
};

/// Of each chain, as ChainSimulator::predict, in less time.
std::vector<std::vector<Prediction>> predict_together(std::span<const Chain> chains,
                                                      std::span<const PreparedRecord> records);

/// Of one record alone.
Prediction simulate(const Chain& chain, const PreparedRecord& record);
std::vector<Complex> simulate_mean(const Chain& chain, const PreparedRecord& record);

}  // namespace vibrissa::diagnosis
