#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/planning/next_experiment.h"

namespace vibrissa::diagnosis {

/// What is known of a first resonance when there is no record. A per cent for the frequency: a line
/// grid, a fit, a mesh; ten for the damping ratio.
struct ResonanceData {
  double frequency_hz = 0.;
  std::optional<double> damping_ratio{};
  double relative_deviation = 0.01;  // of the frequency
  double damping_relative_deviation = 0.1;
};

/// What is known of the simulation beside its parameters.
struct ResonanceModel {
  /// d ln k / d ln E of the first mode, the silicone's share in its compliance; as NominalModel.
  double joint_share = 0.7, joint_share_deviation = 0.15;
  /// The reference study's where nothing is said.
  std::optional<double> silicone_modulus_pa = 2.04e6;
};

/// One parameter that an explanation takes.
struct NeededValue {
  std::string effect{}, name{}, unit{};
  double value = 0.;
  std::optional<std::array<double, 2>> ci95{};  // from the parameters' deviations
  double usual_low = 0., usual_high = 0.;
  bool inside = false;
};

/// Effects that together bring the simulated resonance to the measured one.
struct ResonanceExplanation {
  std::vector<std::string> effects{};
  std::vector<NeededValue> parameters{};  // of a combination at its most probable
  double odds = 0.;
  bool possible = true;  // else no value reaches the measured parameter
  bool inside_usual_range = false;
  /// c / c0 that is left to explain when damping ratios are given.
  std::optional<double> damping_left{};
  std::string note{};

  std::string name() const;  // ids joined by '+' in alphabetical order, "none"
};

struct ResonanceDiagnosis {
  ResonanceData simulated{}, measured{};
  ResonanceModel model{};
  double modal_ratio = 1.;  // (measured / simulated)^2, stiffness over mass
  std::string verdict{};    // of the likeliest
  /// Likeliest first, every single effect and combinations of two; odds sum to one.
  std::vector<ResonanceExplanation> explanations{};
  std::vector<std::string> confidence_set{};  // 95 %
  NextExperiment next{};
};

/// Every effect of resonance_effects(), alone and in twos, with the value it takes and its odds:
///   odds ~ P(effects) int pi(x) delta(y - g(x)) pi_c(zeta / zeta'(x)) dx,  y = ln (f / f0)^2,
/// integrated along the line of solutions (the last parameter solved for, the density divided by
/// |dg/dx|) and over the deviation of y, 2 sqrt(s^2 + s0^2). P: the priors of the search
/// (log_prior_of_number, Effect::log_prior). pi_c: the damper that is left, usual 0.3 .. 3
/// (docs/effects.md). The silicone's share is taken as given. `none` and, for what no effect
/// reaches, outside_catalogue compete. Where the frequencies agree but not the damping ratios, the
/// first of them is `damping`. Throws UserError for parameters that are not positive, deviations
/// outside (0, 0.5), damping ratios outside (0, 1) or shares outside (0, 1]. Proven by
/// tests/diagnosis/resonances/resonance_gap_test.cc against closed forms, the finite-element model
/// and sampled priors.
ResonanceDiagnosis explain_resonance_gap(const ResonanceData& simulated,
                                         const ResonanceData& measured,
                                         const ResonanceModel& model = {});

/// A gap that is known by its parameters only.
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
