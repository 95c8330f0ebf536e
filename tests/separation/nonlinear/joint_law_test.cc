#include "separation/nonlinear/joint_law.h"

#include <gmock/gmock.h>

#include "signals/base/error.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<LawTerm> all_kinds{
    {.kind = LawKind::quadratic_stiffness},
    {.kind = LawKind::cubic_stiffness},
    {.kind = LawKind::quadratic_damping},
    {.kind = LawKind::friction, .speed_m_s = 0.3},
    {.kind = LawKind::monomial, .deflection_power = 2, .velocity_power = 1},
    {.kind = LawKind::monomial, .deflection_power = 0, .velocity_power = 3}};

TEST(JointLaw, HasTheSlopesOfItsFunction) {
  constexpr double h = 1e-6;
  for (const LawTerm& term : all_kinds)
    for (const double x : {-0.7, 0.2})
      for (const double v : {-0.4, 0.6}) {
        const LawValue at = law_function(term, x, v);
        const auto value = [&](double dx, double dv) {
          return law_function(term, x + dx, v + dv).value;
        };
        EXPECT_NEAR(at.by_deflection, (value(h, 0.) - value(-h, 0.)) / (2. * h), 1e-8)
            << term.name();
        EXPECT_NEAR(at.by_velocity, (value(0., h) - value(0., -h)) / (2. * h), 1e-8) << term.name();
      }
}

TEST(JointLaw, ActsAgainstTheMotionAlikeToBothSidesWhereItsKindSaysSo) {
  for (const LawTerm& term : all_kinds) {
    const double there = law_function(term, 0.5, 0.4).value;
    const double back = law_function(term, -0.5, -0.4).value;
    EXPECT_DOUBLE_EQ(back, term.kind == LawKind::quadratic_stiffness ? there : -there)
        << term.name();
  }
}

TEST(JointLaw, SaysTheUnitOfItsCoefficient) {
  EXPECT_EQ(all_kinds[0].unit(), "m^-1 s^-2");
  EXPECT_EQ(all_kinds[1].unit(), "m^-2 s^-2");
  EXPECT_EQ(all_kinds[2].unit(), "m^-1");
  EXPECT_EQ(all_kinds[3].unit(), "m s^-2");
  EXPECT_EQ(all_kinds[4].unit(), "m^-2 s^-1");
  EXPECT_EQ(all_kinds[5].unit(), "m^-2 s");
}

TEST(JointLaw, RefusesWhatIsNoLaw) {
  const auto checked = [](const LawTerm& term) { check(std::vector<LawTerm>{term}); };
  for (const LawTerm& term : all_kinds) EXPECT_NO_THROW(checked(term));
  EXPECT_THAT([&] { checked({.kind = LawKind::friction}); },
              ThrowsMessage<UserError>(HasSubstr("term 1 (friction): its speed")));
  EXPECT_THAT([&] { checked({.kind = LawKind::monomial}); },
              ThrowsMessage<UserError>(HasSubstr("not both 0")));
  EXPECT_THAT([&] { checked({.coefficient = NAN}); },
              ThrowsMessage<UserError>(HasSubstr("not finite")));
  EXPECT_THAT([] { parse_law_kind("cubic_stifness"); },
              ThrowsMessage<UserError>(HasSubstr("did you mean 'cubic_stiffness'")));
}

}  // namespace
}  // namespace vibrissa::separation
