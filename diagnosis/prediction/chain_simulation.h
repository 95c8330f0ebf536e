#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/prediction/record_nuisances.h"
#include "diagnosis/prediction/sweep_states.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/response/joint_simulation.h"
#include "diagnosis/response/linear_response.h"

namespace vibrissa::diagnosis {

/// Prediction of one prepared record by a chain; bins as in PreparedRecord::moment.
struct Prediction {
  std::vector<Complex> mean;
  /// Variances for white noise of unit standard deviation per sample on both channels, and of the
  /// process noise.
  std::vector<double> moment_noise;        // to be multiplied by the moment's noise variance
  std::vector<double> acceleration_noise;  // to be multiplied by the accelerometer's noise variance
  std::vector<double> process_noise;       // complete
  std::vector<RecordNuisance> unknowns;    // the rise of a drift, a tone, the record's start ...
  std::shared_ptr<const SweepStates>
      sweep{};  // of a response that is not proportional to its drive
};

/// Variance of each bin by the process noise and by nuisance parameters of effects [(N m)^2].
std::vector<double> own_noise(const Prediction& prediction);

/// Takes the number of a chain, and its predictions of all records.
using PredictionUser = std::function<void(std::size_t chain, const std::vector<Prediction>&)>;

/// Predicts records under one chain, which must outlive it. Linear parts exactly for band-limited
/// inputs, by transfer functions at the lines of the record (its start, where the circular
/// continuation is wrong, is not evaluated); the contributions of joint laws and relative wind are
/// integrated in time. Responses are steady states (sweep_states.h); where their phase is unknown,
/// they are turned to that of the measured one.
class ChainSimulator {
 public:
  explicit ChainSimulator(const Chain& chain) : chain_(chain), response_(chain) {}

  std::vector<Prediction> predict(std::span<const PreparedRecord> records);
  std::vector<std::vector<Complex>> means(std::span<const PreparedRecord> records);
  /// The reading [N m] at every sample of a record, including its mean.
  std::vector<double> samples(const PreparedRecord& record);

 private:
  using Spectra = std::vector<std::vector<Complex>>;  // of each record, at all its lines
  /// Linear parts, and the tasks for records that need time integration.
  struct Begun {
    Spectra moments;
    std::vector<std::size_t> indices{};  // of the records of the task
    DynamicTask task{};
  };
  static std::size_t predict_group(std::span<const Chain> chains, std::size_t first,
                                   std::span<const PreparedRecord> records,
                                   std::span<const Prediction> near, const PredictionUser& use);
  friend void predict_together(std::span<const Chain> chains,
                               std::span<const PreparedRecord> records,
                               std::span<const Prediction> near, const PredictionUser& use);

  Begun begin(std::span<const PreparedRecord> records);
  Spectra finish(std::span<const PreparedRecord> records, Begun begun,
                 const std::vector<std::vector<double>>& dynamic,
                 std::span<const Prediction> near = {});
  std::vector<Complex> response_reading(const PreparedRecord& record,
                                        const std::vector<Complex>& moment,
                                        const SweepStates* near);
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
  std::map<std::size_t, std::shared_ptr<const SweepStates>> sweeps_{};  // by number of the record
};

/// Predictions of each chain, as ChainSimulator::predict but faster, given to use() in their order.
/// near: predictions of a chain that hardly differs, whose branches responses stay on; may be
/// empty.
void predict_together(std::span<const Chain> chains, std::span<const PreparedRecord> records,
                      std::span<const Prediction> near, const PredictionUser& use);

/// Prediction of one record.
Prediction simulate(const Chain& chain, const PreparedRecord& record);
std::vector<Complex> simulate_mean(const Chain& chain, const PreparedRecord& record);

}  // namespace vibrissa::diagnosis
