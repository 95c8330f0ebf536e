#pragma once

#include <random>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/model/updated_model.h"
#include "diagnosis/planning/projection.h"
#include "diagnosis/records/experiment.h"
#include "signals/files/dataset.h"

namespace vibrissa::benchmarks {

/// A sensor drawn by the priors of the nominal model's own catalogue: half of all are as simulated
/// but for what is named, the others a little off in all calibrations; a quarter have no effect,
/// half have one, a quarter two, from a tenth of their first start up to it.
class DrawnSensor {
 public:
  DrawnSensor(const diagnosis::Experiment& experiment, unsigned seed);

  const std::string& name() const { return name_; }
  /// Of its effects those that such records can show: a likelihood-ratio test that knows the form
  /// and size finds them more often than not at one false alarm in a hundred.
  std::string shown_name(const diagnosis::NominalPoint& point) const;
  /// Does the answer name what is shown, and beyond it at most calibrations that are a little off?
  bool is_answered_by(const std::string& answer, const diagnosis::NominalPoint& point) const;
  double share() const { return share_; }
  /// Of an effect that it has.
  const std::vector<double>& values(const std::string& effect) const;
  /// inputs: what moves it; clean: the same, prepared.
  signals::Dataset measure(const signals::Dataset& inputs,
                           const std::vector<diagnosis::PreparedRecord>& clean);

 private:
  void draw_calibrations(const diagnosis::Experiment& experiment);
  void draw_effects(const diagnosis::Experiment& experiment);
  std::vector<double> recalibrated(const diagnosis::Effect& effect);
  double drawn(const diagnosis::Parameter& parameter);
  void add_own_noise(const diagnosis::Chain& chain, const signals::DatasetRecord& entry,
                     std::vector<double>& moment);
  std::vector<double> with_noise(std::span<const double> x, double deviation);
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  std::mt19937 random_;
  diagnosis::UpdatedModel model_;
  std::string name_;
  bool as_built_ = false;  // a little off in all calibrations
  double share_ = 0.;      // of the effects' first starts
};

}  // namespace vibrissa::benchmarks
