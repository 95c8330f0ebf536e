#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/model/effect.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Where a term acts: on the joint, as a moment in addition to its spring and damper, or on the
/// reading of the moment sensor.
enum class TermPlace { joint, reading };
std::string to_string(TermPlace place);

/// One candidate of a model without physics: coefficient times a function of dimensionless
/// quantities. angle: elastic moment of the joint over its peak in the fit records; rate: its
/// derivative over peak and angular frequency of the first mode; acceleration (of the base) and
/// wind: over their largest rms of the records; moment: reading over the peak. A joint moment
/// counts in shares of the peak, too. A term vanishes with its coefficient.
struct Term {
  std::string name{};  // "angle^3"
  TermPlace place = TermPlace::joint;
  bool basic = false;  // a wrong calibration does the same
  std::string like{};  // effect of the catalogue that does much the same
  std::function<void(Chain&, double coefficient)> add{};
};

/// All terms that the experiment can show: powers, signs, products with the inputs, delays.
/// further: other records that will be predicted. Proven by
/// tests/diagnosis/unknown/unknown_cause_test.cc.
std::vector<Term> all_terms(const Experiment& experiment, std::span<const PreparedRecord> further);

}  // namespace vibrissa::diagnosis
