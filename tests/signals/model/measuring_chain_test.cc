#include "signals/model/measuring_chain.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "signals/base/error.h"
#include "signals/model/band_limited_simulation.h"
#include "tests/signals/rate.h"

namespace vibrissa::signals {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using Signal = std::vector<double>;

constexpr std::size_t n_samples = 20'000;
using test::rate_hz;

ReducedModel sensor_model() {
  ReducedModel model;
  model.name = "symmetric";
  model.modes = {{37.3, 0.05, {0.01, 0., 0.}, {0., 7e-4, 0.}},
                 {37.3, 0.05, {0., 0.01, 0.}, {-7e-4, 0., 0.}}};
  model.rigid_moment[1][0] = 9e-6;
  model.rigid_moment[0][1] = -9e-6;
  model.wind = {
      .speed_m_s = {0.}, .modal_coefficient = {{4e-4, 0.}}, .moment_coefficient = {{0., 2e-6, 0.}}};
  return model;
}

Signal sine(double amplitude, double frequency_hz) {
  Signal x(n_samples);
  for (std::size_t i = 0; i < n_samples; ++i)
    x[i] = amplitude *
           std::sin(2. * std::numbers::pi * frequency_hz * static_cast<double>(i) / rate_hz);
  return x;
}

Record true_motion() {
  Record record(rate_hz, n_samples);
  record.set_channel(channel::base_acceleration, sine(3., 20.));
  record.set_channel(channel::cross_acceleration, sine(0.2, 31.));
  record.set_channel(channel::wind_speed, sine(2., 1.6));
  return record;
}

Signal channel_of(const Record& record, const std::string& name) {
  const auto values = record.channel(name);
  return {values.begin(), values.end()};
}

void expect_equal(const Record& a, const Record& b) {
  EXPECT_EQ(a.sampling_rate_hz(), b.sampling_rate_hz());
  ASSERT_EQ(a.channel_names(), b.channel_names());
  for (const auto& name : a.channel_names()) EXPECT_EQ(channel_of(a, name), channel_of(b, name));
}

Signal difference(const Signal& a, const Signal& b) {
  Signal result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] - b[i];
  return result;
}

double correlation(const Signal& a, const Signal& b) {
  const double ab = std::inner_product(a.begin(), a.end(), b.begin(), 0.);
  const double aa = std::inner_product(a.begin(), a.end(), a.begin(), 0.);
  const double bb = std::inner_product(b.begin(), b.end(), b.begin(), 0.);
  return ab / std::sqrt(aa * bb);
}

/// Mean 0, deviation as asked, no relation between neighbours, a Gaussian's fourth moment 3 s^4;
/// each within four standard errors.
void expect_white_gaussian(const Signal& noise, double standard_deviation) {
  const auto n = static_cast<double>(noise.size());
  double sum = 0., square = 0., fourth = 0., neighbours = 0.;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const double x = noise[i] / standard_deviation;
    sum += x;
    square += x * x;
    fourth += x * x * x * x;
    if (i > 0) neighbours += x * noise[i - 1] / standard_deviation;
  }
  EXPECT_NEAR(sum / n, 0., 4. / std::sqrt(n));
  EXPECT_NEAR(square / n, 1., 4. * std::sqrt(2. / n));
  EXPECT_NEAR(fourth / n, 3., 4. * std::sqrt(96. / n));
  EXPECT_NEAR(neighbours / n, 0., 4. / std::sqrt(n));
}

MeasuringChain nominal_chain(double sensor_noise_n_m, double reference_noise_m_s2) {
  MeasuringChain chain;
  chain.add(make_structure_element(sensor_model()));
  chain.add(make_sensor_noise(sensor_noise_n_m));
  chain.add(make_reference_noise(reference_noise_m_s2));
  return chain;
}

/// Writes its name into a channel, so that the order of links shows.
class Marker : public ChainElement {
 public:
  Marker(Link link, double digit) : link_(link), digit_(digit) {}
  Link link() const override { return link_; }
  std::string name() const override { return "marker"; }
  void pass(Record& record, std::mt19937_64&) const override {
    const double before = record.has("order") ? record.channel("order")[0] : 0.;
    record.set_channel("order", Signal(record.n_samples(), 10. * before + digit_));
  }

 private:
  Link link_;
  double digit_;
};

TEST(MeasuringChain, WithoutLinksIsTheIdentity) {
  expect_equal(MeasuringChain().measure(true_motion(), 1), true_motion());
}

TEST(MeasuringChain, PassesLinksInTheOrderOfTheirPlacesNotOfTheirAdding) {
  MeasuringChain chain;
  const std::vector links{Link::clock,     Link::sensor, Link::mount,
                          Link::reference, Link::wind,   Link::structure};
  const Signal digits{6., 4., 1., 5., 2., 3.};
  for (std::size_t i = 0; i < links.size(); ++i)
    chain.add(std::make_unique<Marker>(links[i], digits[i]));
  EXPECT_EQ(chain.measure(true_motion(), 1).channel("order")[0], 123456.);
}

TEST(MeasuringChain, PassesLinksAtOnePlaceInTheOrderOfTheirAdding) {
  MeasuringChain chain;
  for (const double digit : {1., 2., 3.}) chain.add(std::make_unique<Marker>(Link::sensor, digit));
  EXPECT_EQ(chain.measure(true_motion(), 1).channel("order")[0], 123.);
}

TEST(MeasuringChain, SameSeedGivesTheSameRecord) {
  const auto chain = nominal_chain(1e-6, 0.0785);
  expect_equal(chain.measure(true_motion(), 42), chain.measure(true_motion(), 42));
}

TEST(MeasuringChain, OtherSeedsGiveOtherNoise) {
  const auto chain = nominal_chain(1e-6, 0.0785);
  const auto clean = nominal_chain(0., 0.).measure(true_motion(), 0);
  const auto noise = [&](std::uint64_t seed, const std::string& name) {
    return difference(channel_of(chain.measure(true_motion(), seed), name),
                      channel_of(clean, name));
  };
  // The upper half of the seed counts, too.
  for (const std::uint64_t other :
       {std::uint64_t{43}, std::uint64_t{42} + (std::uint64_t{1} << 32)})
    for (const auto& name : {channel::base_moment, channel::base_acceleration})
      EXPECT_LT(std::abs(correlation(noise(42, name), noise(other, name))),
                4. / std::sqrt(static_cast<double>(n_samples)));
}

TEST(MeasuringChain, NoiseOfSeveralChannelsAndLinksIsUnrelated) {
  const auto clean = nominal_chain(0., 0.).measure(true_motion(), 0);
  auto chain = nominal_chain(1e-6, 0.0785);
  const auto record = chain.measure(true_motion(), 7);
  std::vector<Signal> noises;
  for (const auto& name : {channel::base_moment, channel::cross_moment, channel::base_acceleration,
                           channel::cross_acceleration})
    noises.push_back(difference(channel_of(record, name), channel_of(clean, name)));
  chain.add(make_sensor_noise(1e-6));
  noises.push_back(difference(channel_of(chain.measure(true_motion(), 7), channel::base_moment),
                              channel_of(record, channel::base_moment)));
  for (std::size_t i = 0; i < noises.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_LT(std::abs(correlation(noises[i], noises[j])),
                4. / std::sqrt(static_cast<double>(n_samples)));
}

TEST(MeasuringChain, AddingALinkLeavesTheNoiseOfTheOthersAlone) {
  const auto before = nominal_chain(1e-6, 0.0785).measure(true_motion(), 42);
  auto chain = nominal_chain(1e-6, 0.0785);
  chain.add(std::make_unique<Marker>(Link::mount, 1.));
  chain.add(std::make_unique<Marker>(Link::reference, 2.));
  const auto after = chain.measure(true_motion(), 42);
  for (const auto& name : before.channel_names())
    EXPECT_EQ(channel_of(before, name), channel_of(after, name)) << name;
}

TEST(StructureElement, AddsTheMomentsOfTheReducedModel) {
  MeasuringChain chain;
  chain.add(make_structure_element(sensor_model()));
  const auto truth = true_motion();
  const auto record = chain.measure(truth, 1);
  const auto wanted = simulate_band_limited(
      sensor_model(), {.sampling_rate_hz = rate_hz,
                       .n_samples = n_samples,
                       .base_acceleration = truth.channel(channel::base_acceleration),
                       .cross_acceleration = truth.channel(channel::cross_acceleration),
                       .wind_speed = truth.channel(channel::wind_speed)});
  EXPECT_EQ(channel_of(record, channel::base_moment), wanted.base_moment);
  EXPECT_EQ(channel_of(record, channel::cross_moment), wanted.cross_moment);
  for (const auto& name : truth.channel_names())
    EXPECT_EQ(channel_of(record, name), channel_of(truth, name));
}

TEST(StructureElement, HasNoCrossMomentWithoutCrossAcceleration) {
  MeasuringChain chain;
  chain.add(make_structure_element(sensor_model()));
  Record truth(rate_hz, n_samples);
  truth.set_channel(channel::base_acceleration, sine(3., 20.));
  const auto record = chain.measure(truth, 1);
  EXPECT_TRUE(record.has(channel::base_moment));
  EXPECT_FALSE(record.has(channel::cross_moment));
}

TEST(StructureElement, RespondsToTheTrueAccelerationNotToTheMeasuredOne) {
  const auto clean = nominal_chain(0., 0.).measure(true_motion(), 3);
  const auto noisy = nominal_chain(0., 0.5).measure(true_motion(), 3);
  EXPECT_EQ(channel_of(clean, channel::base_moment), channel_of(noisy, channel::base_moment));
  EXPECT_NE(channel_of(clean, channel::base_acceleration),
            channel_of(noisy, channel::base_acceleration));
}

TEST(StructureElement, RefusesARecordWithoutAnyCause) {
  MeasuringChain chain;
  chain.add(make_structure_element(sensor_model()));
  EXPECT_THAT([&] { chain.measure(Record(rate_hz, 100), 1); },
              ThrowsMessage<UserError>(
                  testing::AllOf(HasSubstr("symmetric"), HasSubstr("base_acceleration_m_s2"))));
}

TEST(StructureElement, RefusesAModelThatCannotBe) {
  auto model = sensor_model();
  model.modes[0].frequency_hz = NAN;
  EXPECT_THAT([&] { make_structure_element(model); },
              ThrowsMessage<UserError>(HasSubstr("modes[0].frequency_hz")));
}

TEST(SensorNoise, IsWhiteAndGaussianOnTheMomentsAlone) {
  const auto clean = nominal_chain(0., 0.).measure(true_motion(), 3);
  const auto noisy = nominal_chain(1e-6, 0.).measure(true_motion(), 3);
  for (const auto& name : {channel::base_moment, channel::cross_moment})
    expect_white_gaussian(difference(channel_of(noisy, name), channel_of(clean, name)), 1e-6);
  for (const auto& name : true_motion().channel_names())
    EXPECT_EQ(channel_of(noisy, name), channel_of(clean, name));
}

TEST(ReferenceNoise, IsWhiteAndGaussianOnTheAccelerationsAlone) {
  const auto clean = nominal_chain(0., 0.).measure(true_motion(), 3);
  const auto noisy = nominal_chain(0., 0.0785).measure(true_motion(), 3);
  for (const auto& name : {channel::base_acceleration, channel::cross_acceleration})
    expect_white_gaussian(difference(channel_of(noisy, name), channel_of(clean, name)), 0.0785);
  for (const auto& name : {channel::base_moment, channel::cross_moment, channel::wind_speed})
    EXPECT_EQ(channel_of(noisy, name), channel_of(clean, name));
}

TEST(ReferenceNoise, OnTheAxialChannelDoesNotDependOnTheCrossChannel) {
  MeasuringChain chain;
  chain.add(make_reference_noise(0.0785));
  Record axial_alone(rate_hz, n_samples);
  axial_alone.set_channel(channel::base_acceleration, sine(3., 20.));
  const auto record = chain.measure(axial_alone, 3);
  EXPECT_EQ(channel_of(record, channel::base_acceleration),
            channel_of(chain.measure(true_motion(), 3), channel::base_acceleration));
  EXPECT_FALSE(record.has(channel::cross_acceleration));
}

TEST(Noise, RefusesAStandardDeviationThatIsNone) {
  EXPECT_THAT([] { make_sensor_noise(-1e-6); },
              ThrowsMessage<UserError>(HasSubstr("sensor noise: standard deviation -1e-06")));
  EXPECT_THAT([] { make_reference_noise(NAN); },
              ThrowsMessage<UserError>(HasSubstr("reference noise: standard deviation nan")));
}

TEST(Link, HasItsNameInTheChain) {
  EXPECT_EQ(to_string(Link::mount), "mount");
  EXPECT_EQ(to_string(Link::wind), "wind");
  EXPECT_EQ(to_string(Link::structure), "structure");
  EXPECT_EQ(to_string(Link::sensor), "sensor");
  EXPECT_EQ(to_string(Link::reference), "reference");
  EXPECT_EQ(to_string(Link::clock), "clock");
}

}  // namespace
}  // namespace vibrissa::signals
