#include "separation/identification/structure_choice.h"

#include <gtest/gtest.h>

#include "separation/model/simulation.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using test::rate_hz;
using test::Signal;

// From a fit with all unknowns under first_order, as the choice of the order leaves it.
ModelStructure chosen_structure(const Bvrm& truth, Hold hold, double noise_share,
                                std::uint64_t seed) {
  const Signal motion = test::white_noise(5000, 3., seed);
  const Signal clean = simulate(truth, motion, rate_hz, hold);
  const Signal moment = test::plus_noise(clean, noise_share * test::rms(clean), seed + 100);
  const Segment segment{motion, moment};
  const FittedBvrm found = refine_output_error(truth, std::span(&segment, 1), rate_hz);
  return choose_structure(found, std::span(&segment, 1), rate_hz,
                          {Hold::first_order, Hold::zero_order, Hold::band_limited}, {});
}

TEST(StructureChoice, FindsTheHoldOfASensorWithAnElasticMoment) {
  const Bvrm truth{.modes = {make_modal_term(31.47, 0.027, -9e-6)}};
  for (const Hold hold : {Hold::first_order, Hold::zero_order, Hold::band_limited})
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      const ModelStructure found = chosen_structure(truth, hold, 0.03, seed);
      EXPECT_EQ(found.hold, hold) << to_string(hold) << seed;
      EXPECT_FALSE(found.viscous_term) << to_string(hold) << seed;
    }
}

TEST(StructureChoice, KeepsWhatTheRecordDetermines) {
  const double w = 2. * 3.14159265 * 31.47, viscous = -9e-6 * 2. * 0.1 * w;
  const Bvrm truth{.modes = {make_modal_term(31.47, 0.1, -9e-6, viscous)},
                   .direct_term_kg_m = -2e-6};
  const ModelStructure found = chosen_structure(truth, Hold::first_order, 0.01, 4);
  EXPECT_TRUE(found.viscous_term);
  EXPECT_TRUE(found.direct_term);
  EXPECT_EQ(found.hold, Hold::first_order) << "the moment does not answer before the motion";
}

TEST(StructureChoice, LeavesOutADirectTermThatIsZero) {
  const Bvrm truth{.modes = {make_modal_term(31.47, 0.027, -9e-6)}};
  EXPECT_FALSE(chosen_structure(truth, Hold::first_order, 0.03, 5).direct_term);
}

}  // namespace
}  // namespace vibrissa::separation
