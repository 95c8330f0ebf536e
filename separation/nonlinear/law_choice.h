#pragma once

#include <span>
#include <string>
#include <vector>

#include "separation/nonlinear/nonlinear_fit.h"

namespace vibrissa::separation {

/// One term that was tried on top of those accepted before.
struct LawTrial {
  std::string term, readout;
  double unseen_rms_n_m = 0.;
  /// Mean gain in the logarithm of the squared error of 40 parts of the unseen data, in standard
  /// deviations of that mean.
  double gain_deviations = 0.;
  bool accepted = false;
};

struct LawChoice {
  NonlinearBvrm model;  // fitted to the first part of each segment; without law where none gains
  double unseen_rms_n_m = 0., unseen_rms_without_law_n_m = 0.;
  std::vector<LawTrial> trials;
};

struct LawChoiceOptions {
  OutputErrorOptions fit = {};
  double held_out_share = 0.3;  // of each segment, at its end
  /// A term must lower the squared error on unseen data by this many standard deviations (see
  /// LawTrial) and by this share: less is not worth its extrapolation.
  double significant = 4., least_gain = 0.1;
  std::size_t most_terms = 6;
};

/// Grows the joint law of the strongest mode one term at a time. Each candidate is fitted by
/// refine_nonlinear() to the first part of each segment; the one with the smallest error in the
/// rest, which no fit has seen, is accepted when it gains significantly. First the laws that have a
/// name (quadratic and cubic stiffness, quadratic damping, friction), with both readouts for the
/// first term, damping only where it takes energy (a term that another one turns around is
/// dropped); where none of them gains, monomials of deflection and speed. `start` should be a
/// linear model of a low level. Source of the procedure: forward selection on validation data
/// (Ljung, System Identification, 2nd ed., sections 16.4 and 16.5). Proven by
/// tests/separation/nonlinear/law_choice_test.cc.
LawChoice choose_law(const Bvrm& start, std::span<const Segment> segments, double sampling_rate_hz,
                     const LawChoiceOptions& options = {});

/// The mode with the largest power of the moment for this acceleration.
std::size_t strongest_mode(const Bvrm& model, std::span<const Segment> segments,
                           double sampling_rate_hz, Hold hold);

}  // namespace vibrissa::separation
