#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/records/experiment.h"
#include "diagnosis/search/search.h"
#include "diagnosis/unknown/unknown_cause.h"

namespace vibrissa::diagnosis {

/// Reduces each answer to what closes the gap, and gives it the names of its changes. An effect
/// that closes less than least_share of what recalibration alone leaves, or less than any
/// simulation's error, in fitted and unseen records together, is left out of the name where a fit
/// without it is known: the simpler answer wins. An effect that closes a part of the gap as it was
/// brought is kept, unless recalibration alone predicts unseen records better, by more than the
/// simulation's error. The values are those of the fuller fit where it predicts unseen records
/// better. Calibration parameters are named by named_calibrations(). Where least_share or more of
/// the gap is left, and more than any discrepancy, the cause is outside the catalogue. Answers of
/// the same name become one. fitted, scored: the fit records and those to be scored, prepared with
/// InputNoise::as_measured. Proven by tests/diagnosis/validation/named_answers_test.cc.
void name_answers(SearchResult& result, const Experiment& experiment, const Experiment& fitted,
                  const Experiment& scored);

/// Sets of effects that this experiment cannot distinguish, for the most probable candidate; the
/// first member is the effect that it names. Members differ by less than two nats. Each other
/// effect is compared by a fit in its place, with all unnamed calibration parameters exactly
/// nominal. A named calibration effect is also compared by projection: its tangent times its size
/// (whitened mean and log variance) on the tangent of each other effect, with the other nuisances,
/// the noise levels and the effects of the hypothesis free within twice the spread of their priors.
/// Proven by tests/diagnosis/validation/indistinguishable_test.cc.
std::vector<std::vector<std::string>> indistinguishable_sets(const Experiment& experiment,
                                                             const SearchResult& result);

/// What the best answer leaves; or what calibrations alone leave, where the answer is outside the
/// catalogue or where terms beside them explain more than its effects. Nothing where noise, a
/// random effect or the usual error of a simulation explains it. Proven by
/// tests/diagnosis/diagnosis_test.cc, DescribesASpringThatIsInNoCatalogue.
std::optional<UnknownCause> unknown_part(const SearchResult& result, const Experiment& experiment,
                                         const Experiment& scored, std::size_t n_threads);

/// An unknown cause takes the place of the best answer.
void prefer_outside(SearchResult& result);

/// An effect that these data cannot show: it is neither detected nor excluded.
struct UntestedEffect {
  std::string effect{}, reason{};
};

/// Effects of the catalogue that the experiment cannot show, in alphabetical order. Proven by
/// tests/diagnosis/validation/untested_test.cc.
std::vector<UntestedEffect> untested_effects(const Experiment& experiment);

/// The effects grouped by reason, as one line; empty when there are none.
std::string untested_sentence(const std::vector<UntestedEffect>& untested);

}  // namespace vibrissa::diagnosis
