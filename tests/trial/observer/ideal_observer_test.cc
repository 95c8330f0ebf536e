#include "trial/observer/ideal_observer.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "trial/generator/record_set.h"

namespace vibrissa::trial {
namespace {

constexpr std::size_t n_lines = 6;
const std::vector<double> unit_noise(n_lines, 1.);

LineChange along(const std::vector<float>& direction, const double size) {
  LineChange out{.moment = std::vector<std::complex<double>>(n_lines)};
  for (std::size_t i = 0; i < direction.size(); ++i) out.moment[i] = size * direction[i];
  return out;
}

/// A ladder of an effect that adds size times the direction to the lines.
EffectLadder straight(const std::string& id, const std::vector<float>& direction,
                      const std::vector<double>& sizes) {
  EffectLadder out{.unknown = &find_unknown(id), .sizes = sizes, .changes = {}};
  for (const double size : sizes) out.changes.push_back(along(direction, size));
  return out;
}

struct Rates {
  double right = 0., said = 0.;
};

Rates ask(const IdealObserver& observer, std::size_t n_effects, std::size_t n) {
  std::mt19937_64 random(5);
  Rates out;
  for (std::size_t i = 0; i < n; ++i) {
    const ObserverAnswer answer = observer.answer(observer.draw(n_effects, random));
    out.right += (answer.right ? 1. : 0.) / static_cast<double>(n);
    out.said += answer.probability / static_cast<double>(n);
  }
  return out;
}

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

TEST(IdealObserver, ErrsAsOftenAsDetectionTheorySays) {
  // None or one effect of known size, d standard deviations away, with relative frequencies 2 and
  // 9: the answer changes at y = d/2 + ln(2/9)/d (Van Trees 1968, section 2.2).
  constexpr double d = 3.;
  const IdealObserver observer(
      {straight("sample_repeat", {static_cast<float>(d / std::numbers::sqrt2)}, {1.})}, unit_noise,
      {});
  const double border = 0.5 * d + std::log(2. / 9.) / d;
  EXPECT_NEAR(ask(observer, 0, 4000).right, normal_cdf(border), 0.03);
  EXPECT_NEAR(ask(observer, 1, 4000).right, normal_cdf(d - border), 0.01);
}

TEST(IdealObserver, IsRightHalfOfTheTimesBetweenTwoThatLookAlike) {
  const std::vector<double> sizes{0.002, 0.02, 0.2};
  const IdealObserver observer({straight("viscoelastic", {100.f, 200.f}, sizes),
                                straight("flow_lag", {100.f, 200.f}, sizes)},
                               unit_noise, {});
  const Rates rates = ask(observer, 1, 2000);
  EXPECT_NEAR(rates.right, 0.5, 0.05);
  EXPECT_LE(rates.said, 0.5);
}

TEST(IdealObserver, AFurtherExperimentTellsApartWhatLooksAlike) {
  const std::vector<double> sizes{0.002, 0.02, 0.2};
  // Four lines of the usual session; of the last two each effect has its own.
  const IdealObserver observer({straight("viscoelastic", {100.f, 200.f, 0.f, 0.f, 900.f}, sizes),
                                straight("flow_lag", {100.f, 200.f, 0.f, 0.f, 0.f, 900.f}, sizes)},
                               unit_noise, {}, {}, {4, 6});
  std::mt19937_64 random(6);
  int right = 0, right_after = 0;
  constexpr int n = 500;
  for (int i = 0; i < n; ++i) {
    const ObservedSensor sensor = observer.draw(1, random);
    right += observer.answer(sensor).right ? 1 : 0;
    right_after += observer.answer(sensor, 1).right ? 1 : 0;
  }
  EXPECT_NEAR(right, 0.5 * n, 0.1 * n);
  EXPECT_GT(right_after, 0.95 * n);
}

TEST(IdealObserver, TellsApartWhatIsLargeAndUnlike) {
  const std::vector<double> sizes{0.02, 0.1, 0.5};
  const IdealObserver observer(
      {straight("viscoelastic", {200.f}, sizes), straight("base_compliance", {0.f, 200.f}, sizes),
       straight("softening_history", {0.f, 0.f, 200.f}, sizes)},
      unit_noise, {});
  for (const std::size_t n_effects : {0u, 1u, 2u, 3u})
    EXPECT_GT(ask(observer, n_effects, 500).right, 0.75) << n_effects;
}

TEST(IdealObserver, IsRightAsOftenAsItSays) {
  // Calibration with the true relative frequencies, for partly similar effects of either sign.
  const std::vector<double> sizes{0.005, 0.02, 0.1, 0.4};
  const IdealObserver observer(
      {straight("stiffness", {100.f, 30.f}, sizes), straight("mass", {90.f, 60.f, 10.f}, sizes),
       straight("reference_gain", {20.f, 80.f, 50.f, 5.f}, sizes),
       straight("delay", {0.f, 40.f, 90.f}, sizes)},
      unit_noise, {});
  double right = 0., said = 0.;
  const double asked[] = {2. / 14., 9. / 14., 2. / 14., 1. / 14.};
  for (std::size_t n_effects = 0; n_effects < 4; ++n_effects) {
    const Rates rates = ask(observer, n_effects, 1500);
    right += asked[n_effects] * rates.right;
    said += asked[n_effects] * rates.said;
  }
  EXPECT_NEAR(right, said, 0.04);
  EXPECT_GT(right, 0.4);
}

TEST(IdealObserver, WhereSensorsAreALittleOffTheirSpreadIsNoEffect) {
  // What tells the two effects apart lies along the spread.
  const std::vector<double> sizes{0.002, 0.02, 0.2};
  const std::vector<EffectLadder> ladders{straight("viscoelastic", {100.f}, sizes),
                                          straight("flow_lag", {100.f, 30.f}, sizes)};
  const IdealObserver knows(ladders, unit_noise, {}),
      allows(ladders, unit_noise, {}, {along({0.f, 20.f}, 1.)});
  const Rates with = ask(knows, 1, 1000), without = ask(allows, 1, 1000);
  EXPECT_GT(with.right, without.right + 0.1);
}

TEST(IdealObserver, AllowsForTheSpreadInAFurtherExperimentToo) {
  // The usual session shows the sum of effect and spread, 2.8 standard deviations of which are the
  // effect, a further experiment the spread alone: one sensor has one spread.
  const IdealObserver observer({straight("sample_repeat", {6.f}, {1.})}, unit_noise, {},
                               {along({1.f, 0.f, 0.f, 0.f, 5.f}, 2.)}, {4, 6});
  std::mt19937_64 random(7);
  int right = 0, right_after = 0;
  constexpr int n = 500;
  for (int i = 0; i < n; ++i) {
    const ObservedSensor sensor = observer.draw(i % 2 == 0 ? 0 : 1, random);
    right += observer.answer(sensor).right ? 1 : 0;
    right_after += observer.answer(sensor, 1).right ? 1 : 0;
  }
  EXPECT_LT(right, 0.95 * n);
  EXPECT_GT(right_after, 0.98 * n);
}

/// Fit takes of the usual session, those of a set first.
struct OrderedTakes {
  std::vector<Take> all;
  std::vector<std::size_t> block_ends;  // lines of the set, and all lines
};

OrderedTakes beginning_with(RecordSet set) {
  OrderedTakes out;
  std::size_t n = 0;
  const auto add = [&](const std::vector<Take>& takes) {
    for (const Take& take : takes) {
      const bool is_there = std::find(out.all.begin(), out.all.end(), take) != out.all.end();
      if (is_there || take.split != signals::Split::fit) continue;
      out.all.push_back(take);
      n += take.n_samples / 2 - 1;
    }
    out.block_ends.push_back(n);
  };
  add(takes_of(set));
  add(usual_takes());
  return out;
}

/// Ladders of a few effects that are alike in base records, and tell apart in others.
std::vector<EffectLadder> few_ladders(const UnexplainedChange& change) {
  std::vector<EffectLadder> out;
  for (const char* id : {"delay", "sensor_lowpass", "sensor_gain", "reference_gain"}) {
    const Unknown& unknown = find_unknown(id);
    EffectLadder ladder{.unknown = &unknown, .sizes = {}, .changes = {}};
    for (const double share : {0.03, 0.3, 1.}) {
      World world = change.plain();
      unknown.apply(world, share * unknown.largest, 0.5);
      ladder.sizes.push_back(share * unknown.largest);
      ladder.changes.push_back(change_of(change, world, unknown.random));
    }
    out.push_back(ladder);
  }
  return out;
}

TEST(IdealObserver, IsNotRightMoreOftenWhereRecordsAreTakenAway) {
  World plain;
  plain.joint.scale = usual_turn;
  for (const RecordSet set : {RecordSet::base_only, RecordSet::no_rest}) {
    const OrderedTakes takes = beginning_with(set);
    const UnexplainedChange change(plain, {.takes = takes.all});
    const IdealObserver observer(few_ladders(change), change.noise(1e-5, 0.05), {}, {},
                                 takes.block_ends);
    std::mt19937_64 random(8);
    int with_set = 0, with_all = 0;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i) {
      const ObservedSensor sensor = observer.draw(i % 4 == 0 ? 2 : 1, random);
      with_set += observer.answer(sensor).right ? 1 : 0;
      with_all += observer.answer(sensor, 1).right ? 1 : 0;
    }
    EXPECT_LE(with_set, with_all + 0.02 * n) << to_string(set);
    if (set == RecordSet::base_only) {
      EXPECT_LT(with_set, with_all - 0.05 * n) << "wind tells both gains apart";
    }
  }
}

TEST(IdealObserver, AsksNoCalibrationWhereTheyAreUnknown) {
  const std::vector<double> sizes{0.001, 0.01, 0.05, 0.1, 0.4};
  const std::vector<EffectLadder> ladders{
      straight("stiffness", {100.f}, sizes),
      straight("damping", {0.f, 20.f}, sizes),
      straight("sensor_gain", {0.f, 0.f, 100.f}, sizes),
      straight("reference_gain", {0.f, 10.f, 100.f}, sizes),
      straight("drag_error", {0.f, 0.f, 0.f, 30.f}, sizes),
      straight("delay", {0.f, 0.f, 0.f, 0.f, 1000.f}, {0.001, 0.02})};
  const IdealObserver observer(ladders, unit_noise, {.asks_calibrations = false});
  std::mt19937_64 random(9);
  for (int i = 0; i < 100; ++i) {
    const ObservedSensor sensor = observer.draw(1, random);
    ASSERT_EQ(named_unknowns()[sensor.unknowns.front()].id, "delay");
  }
}

TEST(IdealObserver, SeesThePowerOfAnUnmeasuredWind) {
  // Known change of the power of n lines by the share p of their variance: d^2 = n p^2 / 2.
  constexpr double p = 3.;
  EffectLadder ladder{.unknown = &find_unknown("sample_repeat"),
                      .sizes = {1.},
                      .changes = {{.moment = std::vector<std::complex<double>>(n_lines),
                                   .wind_power = std::vector<double>(n_lines, p)}}};
  const IdealObserver observer({ladder}, unit_noise, {});
  const double d = std::sqrt(n_lines * p * p / 2.);
  const double border = 0.5 * d + std::log(2. / 9.) / d;
  EXPECT_NEAR(ask(observer, 1, 4000).right, normal_cdf(d - border), 0.01);
}

}  // namespace
}  // namespace vibrissa::trial
