#pragma once

#include <optional>

#include "diagnosis/search/search.h"
#include "diagnosis/unknown/unknown_cause.h"

namespace vibrissa::diagnosis {

/// What the best answer leaves; or what calibrations alone leave, where the answer is outside the
/// catalogue or where terms beside them explain more than its effects. Nothing where noise, a
/// random effect or the usual error of a simulation explains it. Proven by
/// tests/diagnosis/diagnosis_test.cc, DescribesASpringThatIsInNoCatalogue.
std::optional<UnknownCause> unknown_part(const SearchResult& result, const Experiment& experiment,
                                         const Experiment& scored, std::size_t n_threads);

/// An unknown cause takes the place of the best answer.
void prefer_outside(SearchResult& result);

}  // namespace vibrissa::diagnosis
