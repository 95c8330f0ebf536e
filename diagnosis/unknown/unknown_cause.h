#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"
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

/// Mean residual moment of the joint in the bins of a quantity, with its standard deviation.
struct ResidualCurve {
  std::vector<double> x, mean, deviation;
};

/// The moment that the joint would need in addition so that the chain predicts the measured moment:
/// the residual divided by the chain's response to a moment of the joint, at the lines where the
/// response is at least a tenth of its largest value. With J, p and K of JointModel that response
/// is J p / (K (1 + (1 - p) J) + p J): base moments at rest do not show a static moment.
struct ResidualMoment {
  ResidualCurve over_angle{}, over_rate{};  // all in shares of the scales
};
ResidualMoment residual_moment(const Experiment& experiment, const Chain& chain);

struct NamedTerm {
  std::string name{};  // Term::name
  TermPlace place = TermPlace::joint;
  std::string like{};  // effect of the catalogue that does much the same
  double coefficient = 0.;
  double closes = 0.;  // share of what was unexplained, by this term and those before it
};

/// A description of what no known effect explains: enough for an engineer to name it.
struct UnknownCause {
  double unexplained = 0.;         // error power beyond noise, as a share of the measured power
  double left = 0.;                // the same once the terms are added
  bool replaces_effects = false;   // the terms stand beside calibrations alone, without effects
  std::vector<NamedTerm> terms{};  // largest gain first
  ResidualMoment residual{};       // empty where the joint's moment cannot be seen
};

/// Forward selection (Miller 2002, Subset Selection in Regression, 2nd ed., ch. 3) of at most three
/// terms, added to the chain of a fit and solved by Gauss-Newton steps on the error power of the
/// fit records, together with what a wrong calibration does. A term stays if it closes another 5 %
/// of what is unexplained in `scored`. noise_share: share of the fit's error power there that is
/// noise. Proven by tests/diagnosis/unknown/unknown_cause_test.cc.
UnknownCause describe_unknown(const Experiment& experiment, const Experiment& scored,
                              const HypothesisFit& fit, double noise_share,
                              std::size_t n_threads = 2);

}  // namespace vibrissa::diagnosis
