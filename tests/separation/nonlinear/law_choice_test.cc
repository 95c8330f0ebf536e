#include "separation/nonlinear/law_choice.h"

#include <gmock/gmock.h>

#include "tests/separation/nonlinear/oscillator.h"

namespace vibrissa::separation {
namespace {

using test::rate_hz;
using test::Shaken;

constexpr LawChoiceOptions elastic_choice{
    .fit = {.hold = Hold::band_limited, .direct_term = false, .viscous_term = false}};

LawChoice choose_for(const Shaken& shaken) {
  Bvrm start;
  start.modes = {make_modal_term(31.7, 0.03, -9e-6)};
  const Segment segment = shaken.segment();
  return choose_law(start, std::span(&segment, 1), rate_hz, elastic_choice);
}

std::vector<std::string> law_names(const LawChoice& choice) {
  std::vector<std::string> names;
  for (const LawTerm& term : choice.model.law) names.push_back(term.name());
  return names;
}

TEST(LawChoice, TakesNoneForALinearSensor) {
  int n_none = 0;
  for (std::uint64_t draw = 0; draw < 20; ++draw) {
    Shaken shaken(
        test::shaken_mode(), [](double, double) { return 0.; }, true, 1500, 1., 100 + draw);
    shaken.add_noise(0.05, 200 + draw);
    if (choose_for(shaken).model.law.empty()) ++n_none;
  }
  EXPECT_GE(n_none, 19);
}

struct LawCase {
  std::string name;
  test::Force force;
  bool moment = true;
};

TEST(LawChoice, FindsTheLawAndWhatTheChannelShows) {
  for (const LawCase& truth :
       {LawCase{"cubic_stiffness", [](double x, double) { return 4e9 * x * x * x; }},
        LawCase{"cubic_stiffness", [](double x, double) { return -5e8 * x * x * x; }, false},
        LawCase{"quadratic_stiffness", [](double x, double) { return 1e6 * x * x; }},
        LawCase{"quadratic_damping", [](double, double v) { return 100. * v * std::abs(v); },
                false},
        LawCase{"friction", [](double, double v) { return 0.5 * std::tanh(v / 1e-3); }, false}}) {
    Shaken shaken(test::shaken_mode(), truth.force, truth.moment, 4000, 1., 7);
    shaken.add_noise(0.005, 8);
    const LawChoice choice = choose_for(shaken);
    EXPECT_THAT(law_names(choice), testing::ElementsAre(truth.name));
    EXPECT_EQ(choice.model.readout, truth.moment ? LawReadout::moment : LawReadout::deflection)
        << truth.name;
    EXPECT_LT(choice.unseen_rms_n_m, 0.006 * test::rms(shaken.moment)) << truth.name;
  }
}

TEST(LawChoice, TakesAPolynomialWhereNoNamedLawFits) {
  Shaken shaken(
      test::shaken_mode(), [](double x, double v) { return 3e8 * x * x * v; }, false, 4000, 1., 9);
  shaken.add_noise(0.005, 10);
  const LawChoice choice = choose_for(shaken);
  EXPECT_THAT(law_names(choice), testing::Contains("x^2 x'^1"));
  EXPECT_LT(choice.unseen_rms_n_m, 0.006 * test::rms(shaken.moment));
}

TEST(LawChoice, PutsTheLawOnTheStrongestMode) {
  Bvrm model = test::sensor(3);
  const test::Signal a = test::white_noise(2000, 3., 11);
  const Segment segment{a, a};
  EXPECT_EQ(strongest_mode(model, std::span(&segment, 1), rate_hz, Hold::first_order), 0u);
  model.modes[2] = make_modal_term(95., 0.04, -5e-5);
  EXPECT_EQ(strongest_mode(model, std::span(&segment, 1), rate_hz, Hold::first_order), 2u);
}

}  // namespace
}  // namespace vibrissa::separation
