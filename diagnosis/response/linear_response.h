#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/model/joint_model.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Transfer functions of the chain at one frequency. The quantity before the sensor is the base
/// moment, or with the readout rotation k_nominal times the joint's rotation.
template <typename C>
struct LinearParts {
  C base;     // reading of the accelerometer -> before the sensor
  C wind;     // u |u| -> before the sensor
  C elastic;  // before the sensor -> elastic moment of the joint
  C cross;    // transverse acceleration -> before the sensor
  C sensor;   // before the sensor -> reading
};
using LinearPart = LinearParts<Complex>;

/// The linear part of a chain at the lines of records; records of one length share it. For a joint
/// K(s) (1 + D(s)) instead of K(s), with H = K B / (1 + K G) for the whisker pinned at its base (B,
/// G: its rotation by the load and by a moment there), the moment becomes H (1 + D) / (1 + D P), P
/// = K G / (1 + K G); P from the joint model. The chain must outlive this object. Proven by
/// tests/diagnosis/prediction/chain_simulation_test.cc.
class LinearResponse {
 public:
  explicit LinearResponse(const Chain& chain);

  LinearPart at(Complex s, signals::Readout readout = signals::Readout::moment,
                bool magnet = true) const;
  /// The responses at lines 0 .. n_samples / 2 of a whole record.
  const std::vector<LinearPart>& lines(const PreparedRecord& record);
  const std::optional<JointModel>& joint() const { return joint_; }

 private:
  template <typename C>
  LinearParts<C> parts(const C& s, signals::Readout readout, bool magnet) const;

  const Chain& chain_;
  std::optional<JointModel> joint_;
  double per_static_response_ = 1.;
  /// Cache by length, sampling rate, readout and magnet; a response by its number, too.
  using Kind = std::tuple<std::size_t, double, signals::Readout, bool, std::size_t>;
  std::map<Kind, std::vector<LinearPart>> lines_;
};

}  // namespace vibrissa::diagnosis
