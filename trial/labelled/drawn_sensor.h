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

/// A sensor drawn from the priors of the catalogue: half of all sensors are as simulated apart from
/// the named effects, the others deviate by building tolerances in all calibration parameters; a
/// quarter have no effect, half have one, a quarter have two, with sizes from a tenth of their
/// first start up to it.
class DrawnSensor {
 public:
  DrawnSensor(const diagnosis::Experiment& experiment, unsigned seed);

  const std::string& name() const { return name_; }
  /// The effects that such records can show: a likelihood-ratio test that knows form and size
  /// detects them in more than half of all cases with 1 % false alarms.
  std::string shown_name(const diagnosis::NominalPoint& point) const;
  /// Does the answer name the detectable effects and, beyond them, at most calibration effects that
  /// deviate?
  bool is_answered_by(const std::string& answer, const diagnosis::NominalPoint& point) const;
  double share() const { return share_; }
  /// True value of an effect's parameter.
  const std::vector<double>& values(const std::string& effect) const;
  /// inputs: excitation records; clean: the same, prepared.
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
  bool as_built_ = false;  // building tolerances in all calibration parameters
  double share_ = 0.;      // size relative to the effects' first starts
};

}  // namespace vibrissa::benchmarks
