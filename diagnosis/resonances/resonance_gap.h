#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/planning/next_experiment.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::diagnosis {

/// A first resonance that is known without a record. Default relative standard deviations: 1 % of
/// the frequency (frequency resolution, fit, mesh), 10 % of the damping ratio.
struct ResonanceData {
  double frequency_hz = 0.;
  std::optional<double> damping_ratio{};
  double relative_deviation = 0.01;  // of the frequency
  double damping_relative_deviation = 0.1;
};

/// What is known of the simulation beside its resonance.
struct ResonanceModel {
  /// d ln k / d ln E of the first mode: the silicone's share in its compliance, as in NominalModel.
  double joint_share = 0.7, joint_share_deviation = 0.15;
  /// Default: that of the reference study.
  std::optional<double> silicone_modulus_pa = 2.04e6;
};

/// The silicone's share in the compliance of the first mode and its modulus, from a model of this
/// program, when the model has that sensitivity. Throws UserError when the model's first mode
/// differs from the simulated frequency by more than a tenth: the model then belongs to another
/// sensor. Proven by tests/diagnosis/resonances/resonance_model_test.cc.
ResonanceModel resonance_model_from(const signals::ReducedModel& model, double simulated_hz);

/// The value that an explanation needs for one parameter.
struct NeededValue {
  std::string effect{}, name{}, unit{};
  double value = 0.;
  std::optional<std::array<double, 2>> ci95{};  // from the standard deviations of the resonances
  double usual_low = 0., usual_high = 0.;

  bool inside() const { return value >= usual_low && value <= usual_high; }
};

/// Effects that together change the simulated resonance to the measured one.
struct ResonanceExplanation {
  std::vector<std::string> effects{};
  std::vector<NeededValue> parameters{};  // for a combination the most probable values
  double odds = 0.;
  bool possible = true;  // false: no value reaches the measured resonance
  bool inside_usual_range = false;
  /// Ratio c / c0 of the damper that remains to be explained, when damping ratios are given.
  std::optional<double> damping_left{};
  std::string note{};

  std::string name() const;  // ids joined by '+' in alphabetical order, "none"
};

struct ResonanceDiagnosis {
  ResonanceData simulated{}, measured{};
  ResonanceModel model{};
  double modal_ratio = 1.;  // (measured / simulated)^2, stiffness over mass
  std::string verdict{};    // name of the most probable explanation
  /// Every single effect and combinations of two, most probable first; odds sum to one.
  std::vector<ResonanceExplanation> explanations{};
  std::vector<std::string> confidence_set{};  // 95 %
  NextExperiment next{};
};

/// Every effect of resonance_effects(), alone and in pairs, with the value that it needs and its
/// odds:
///   odds ~ P(effects) int pi(x) delta(y - g(x)) pi_c(zeta / zeta'(x)) dx,  y = ln (f / f0)^2,
/// integrated by evidence(), over the deviation of y, 2 sqrt(s^2 + s0^2), too. P: the priors of the
/// search (log_prior_of_number, Effect::log_prior). pi_c: prior of the remaining damper. The
/// silicone's share is taken as given. `none` and outside_catalogue are explanations, too. Where
/// the frequencies agree but the damping ratios do not, `damping` takes the place of `none`. Throws
/// UserError for parameters that are not positive, deviations outside (0, 0.5), damping ratios
/// outside (0, 1) or shares outside (0, 1]. Proven by
/// tests/diagnosis/resonances/resonance_gap_test.cc against closed forms, the finite-element model
/// and sampled priors.
ResonanceDiagnosis explain_resonance_gap(const ResonanceData& simulated,
                                         const ResonanceData& measured,
                                         const ResonanceModel& model = {});

/// Schema "vibrissa-resonance-gap-1": both resonances; every explanation with its values, odds,
/// remaining damping ratio and note; confidence set; next experiment. Proven by
/// tests/diagnosis/resonances/resonance_gap_text_test.cc.
nlohmann::ordered_json resonance_gap_json(const ResonanceDiagnosis& diagnosis);

/// At most 20 lines of at most 100 characters for a terminal: every single effect with the value
/// that it needs, the most probable combinations, effects that are impossible alone, the next
/// experiment.
std::string resonance_gap_text(const ResonanceDiagnosis& diagnosis);

/// A gap between two resonances without records.
struct ResonanceExample {
  ResonanceData simulated{}, measured{};
  ResonanceModel model{};
};
/// The reference study's flow sensor (docs/theory.md, T15): 37.32 Hz simulated, 31.47 Hz and 0.027
/// built, 0.05 its nominal damping ratio. Share of the silicone 0.71, so that its modulus ratio is
/// 0.64; the study's dimensions are not known: this project's model of them, cases/flow_sensor.prm,
/// has 0.56, a deviation below. Yeoh modulus 6 c1 = 2.04 MPa.
ResonanceExample paper_gap();

}  // namespace vibrissa::diagnosis
