#include "diagnosis/fit/model_form_errors.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnosis/records/frequency_block.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// Power of the difference of two fits' predictions of a record, around each bin.
std::vector<double> change(const FittedRecord& a, const FittedRecord& b) {
  std::vector<double> power = powers(difference(a.mean, b.mean));
  for (std::size_t i = 0; i < power.size(); ++i)
    power[i] += std::abs(a.process_noise[i] - b.process_noise[i]);
  return neighbour_mean(power, form_reach);
}

bool adds_nonlinear(const HypothesisFit& fit, const HypothesisFit& fewer) {
  return std::any_of(fit.hypothesis.effects().begin(), fit.hypothesis.effects().end(),
                     [&](const Effect* effect) {
                       return !fewer.hypothesis.contains(effect->id) && is_nonlinear(*effect);
                     });
}

/// Power of the model form errors of the nonlinear effects, and of all effects.
struct Hidden {
  double by_nonlinear = 0., by_all = 0.;
};

class FormBlock {
 public:
  void add(double gained, double form, double variance) {
    explained_ += std::min(gained, form) / variance;
    freedom_ += form / variance;
  }
  double hidden() const { return std::max(0., explained_ - std::log1p(freedom_)); }

 private:
  double explained_ = 0., freedom_ = 0.;
};

Hidden hidden_by_forms(const Experiment& experiment, const HypothesisFit& fit,
                       const HypothesisFit& fewer) {
  std::vector<FormBlock> nonlinear, all;
  for (std::size_t r = 0; r < experiment.records.size(); ++r) {
    const std::vector<double> gained = change(fit.records[r], fewer.records[r]);
    const FormErrors& errors = fewer.records[r].model_form_errors;
    for (std::size_t b = 0; b < gained.size(); ++b) {
      const std::size_t index = frequency_block(experiment, experiment.records[r], b);
      if (index >= all.size()) {
        nonlinear.resize(index + 1);
        all.resize(index + 1);
      }
      const double variance = fit.records[r].variance[b];
      nonlinear[index].add(gained[b], errors.nonlinear[b], variance);
      all[index].add(gained[b], errors.nonlinear[b] + errors.linear[b], variance);
    }
  }
  const auto sum = [](const std::vector<FormBlock>& blocks) {
    double total = 0.;
    for (const FormBlock& block : blocks) total += block.hidden();
    // No model form error can be determined for a calibration parameter without which the sensor is
    // unstable.
    return std::isfinite(total) ? total : 0.;
  };
  return {sum(nonlinear), sum(all)};
}

}  // namespace

double hidden_gain(const Experiment& experiment, const HypothesisFit& fit,
                   const HypothesisFit& fewer) {
  const Hidden part = hidden_by_forms(experiment, fit, fewer);
  double hidden = part.by_nonlinear;
  if (!adds_nonlinear(fit, fewer))
    hidden += std::clamp(part.by_all - part.by_nonlinear, 0., most_hidden_by_form);
  return std::min(hidden, std::max(0., fit.log_likelihood - fewer.log_likelihood));
}

}  // namespace vibrissa::diagnosis
