#include "separation/nonlinear/nonlinear_bank.h"

#include <gmock/gmock.h>

#include "separation/model/simulation.h"
#include "separation/nonlinear/nonlinear_separator.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using test::rate_hz;
using test::Signal;

// Deflections of the first mode under 3 m/s^2 rms are some 2e-4 m.
NonlinearBvrm with_law(std::vector<LawTerm> law) {
  NonlinearBvrm model{.linear = test::sensor(2, -2e-7), .mode = 0, .law = std::move(law)};
  model.largest_deflection_m = 1e-3;
  model.largest_speed_m_s = 0.2;
  return model;
}

constexpr std::array all_holds{Hold::first_order, Hold::zero_order, Hold::band_limited};

TEST(NonlinearBank, WithoutLawIsTheExactLinearSimulationButForItsSteps) {
  const Signal a = test::Lines(2., 210., 40, 3).sample(3000, rate_hz);
  for (const Hold hold : all_holds)
    for (const double delay_s : {0., 0.004, 0.0027, -0.0033}) {
      NonlinearBvrm model = with_law({});
      model.linear.delay_s = delay_s;
      const Signal exact = simulate(model.linear, a, rate_hz, hold);
      const Signal found = simulate(model, a, rate_hz, hold);
      // The ends of the record are extended otherwise where the input is band-limited.
      const auto middle = [](const Signal& x) { return std::span(x).subspan(2000, 900); };
      EXPECT_LT(test::rms(test::minus(middle(exact), middle(found))), 2e-5 * test::rms(exact))
          << to_string(hold) << " " << delay_s;
    }
}

TEST(NonlinearBank, GivesTheSameInOneGoAndSampleBySample) {
  const Signal a = test::white_noise(1500, 3., 4), m = test::white_noise(1500, 1e-5, 5);
  for (const Hold hold : all_holds)
    for (const double delay_s : {0., 0.0113, -0.0033}) {
      NonlinearBvrm model =
          with_law({{.kind = LawKind::cubic_stiffness, .coefficient = 1e11},
                    {.kind = LawKind::friction, .coefficient = 0.5, .speed_m_s = 5e-3}});
      model.linear.delay_s = delay_s;
      NonlinearSeparator separator(model, rate_hz, hold);
      Signal whole(a.size()), single(a.size());
      separator.process(a, m, whole);
      separator.reset();
      for (std::size_t i = 0; i < a.size(); ++i)
        separator.process(std::span(a).subspan(i, 1), std::span(m).subspan(i, 1),
                          std::span(single).subspan(i, 1));
      EXPECT_LT(test::rms(test::minus(whole, single)), 1e-13 * test::rms(whole));
    }
}

TEST(NonlinearBank, DiffersFromTheLinearModelByItsLaw) {
  const Signal a = test::white_noise(3000, 3., 6);
  const Signal linear = simulate(with_law({}), a, rate_hz, Hold::first_order);
  const Signal hard = simulate(with_law({{.kind = LawKind::cubic_stiffness, .coefficient = 1e11}}),
                               a, rate_hz, Hold::first_order);
  EXPECT_GT(test::rms(test::minus(linear, hard)), 0.1 * test::rms(linear));
}

TEST(NonlinearBank, StartsAgainAtRestWhereASofteningLawRunsAway) {
  const Signal a = test::white_noise(5000, 30., 7);
  const Signal soft = simulate(with_law({{.kind = LawKind::cubic_stiffness, .coefficient = -1e11}}),
                               a, rate_hz, Hold::first_order);
  for (const double m : soft) ASSERT_TRUE(std::isfinite(m));
}

TEST(NonlinearBank, RefusesABadRate) {
  EXPECT_THAT([] { NonlinearSeparator(with_law({}), 0., Hold::first_order); },
              testing::ThrowsMessage<signals::UserError>(testing::HasSubstr("sampling rate 0")));
}

}  // namespace
}  // namespace vibrissa::separation
