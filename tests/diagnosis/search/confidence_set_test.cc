#include "diagnosis/search/confidence_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnosis/model/hypothesis.h"

namespace vibrissa::diagnosis {
namespace {

using ::testing::ElementsAre;

Candidate candidate(const std::string& name, double probability) {
  return {.name = name, .fit = 0, .calibrations = {}, .probability = probability};
}

TEST(ConfidenceSet, IsTheShortestThatReachesTheLevel) {
  const std::vector<Candidate> candidates{candidate("a", 0.7), candidate("b", 0.26),
                                          candidate("c", 0.04)};
  EXPECT_THAT(confidence_set(candidates, 0.95), ElementsAre("a", "b"));
  EXPECT_THAT(confidence_set(candidates, 0.5), ElementsAre("a"));
}

TEST(ConfidenceSet, HoldsNoKnownEffectByItsOwnOddsAndNotBeforeTheVerdict) {
  const std::vector<Candidate> candidates{candidate("a", 0.7), candidate("b", 0.26),
                                          candidate(outside_catalogue, 0.04)};
  // 0.42, 0.156 and 0.3 of 0.876.
  EXPECT_THAT(confidence_set(candidates, 0.8, 0.6, 0.3), ElementsAre("a", outside_catalogue));
  EXPECT_THAT(confidence_set(candidates, 0.95, 0.6, 0.3), ElementsAre("a", outside_catalogue, "b"));
  EXPECT_THAT(confidence_set(candidates, 0.95, 1., 0.04), ElementsAre("a", "b"));
  EXPECT_THAT(confidence_set(candidates, 0.7, 0.3, 0.5), ElementsAre("a", outside_catalogue));
}

TEST(ConfidenceSet, BeginsWithNoKnownEffectWhereThatIsTheVerdict) {
  const std::vector<Candidate> candidates{candidate(outside_catalogue, 0.9), candidate("a", 0.1)};
  EXPECT_THAT(confidence_set(candidates, 0.95, 0.9, 0.81), ElementsAre(outside_catalogue, "a"));
}

}  // namespace
}  // namespace vibrissa::diagnosis
