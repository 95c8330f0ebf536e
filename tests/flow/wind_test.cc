#include <gmock/gmock.h>  // first: deal.II defines a macro of a name that gmock uses

#include "flow/wind.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <sstream>
#include <string>

#include "signals/base/error.h"

namespace vibrissa::flow {
namespace {

using dealii::ParameterHandler;
using signals::UserError;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double pi = std::numbers::pi;
constexpr double rate_hz = 200.;
constexpr std::size_t n_samples = 4096;
constexpr double resolution_hz = rate_hz / n_samples;

WindParameters wind_of(const WindKind kind) {
  WindParameters wind;
  wind.kind = kind;
  return wind;
}

/// Turbulence that clipping never touches.
WindParameters free_turbulence() {
  WindParameters wind = wind_of(WindKind::turbulent);
  wind.maximum_speed = 100.;
  return wind;
}

double density(const WindParameters& wind, const double frequency_hz) {
  return von_karman_density(frequency_hz, wind.mean_speed,
                            wind.turbulence_intensity * std::abs(wind.mean_speed),
                            wind.length_scale);
}

/// Simpson's rule in ln n.
double integral_of_density(const WindParameters& wind, const double low_hz, const double high_hz) {
  const int n = 20000;
  const double h = std::log(high_hz / low_hz) / n;
  double sum = 0.;
  for (int i = 0; i <= n; ++i) {
    const double f = low_hz * std::exp(i * h);
    sum += (i == 0 || i == n ? 1. : i % 2 == 1 ? 4. : 2.) * f * density(wind, f);
  }
  return sum * h / 3.;
}

double mean_of(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.) / static_cast<double>(x.size());
}

double mean_square_about(const double centre, const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.,
                         [centre](const double sum, const double u) {
                           return sum + (u - centre) * (u - centre);
                         }) /
         static_cast<double>(x.size());
}

/// One line of the discrete Fourier transform, by its definition.
std::complex<double> line(const std::vector<double>& x, const std::size_t k) {
  const std::complex<double> turn = std::polar(1., -2. * pi * static_cast<double>(k) / x.size());
  std::complex<double> sum = 0., phasor = 1.;
  for (const double u : x) sum += u * phasor, phasor *= turn;
  return sum;
}

// --- the density

TEST(VonKarmanDensity, IntegratesToTheVariance) {
  const WindParameters wind;
  const double variance = std::pow(wind.turbulence_intensity * wind.mean_speed, 2);
  EXPECT_NEAR(integral_of_density(wind, 1e-6, 1e10) / variance, 1., 2e-4);
}

TEST(VonKarmanDensity, StartsAtFourTimesTheIntegralTimeScale) {
  EXPECT_DOUBLE_EQ(von_karman_density(0., 2., 0.4, 0.1), 4. * 0.4 * 0.4 * 0.1 / 2.);
}

TEST(VonKarmanDensity, FallsWithTheFiveThirdsLawAtHighFrequency) {
  const double fall = von_karman_density(2e4, 2., 0.4, 0.1) / von_karman_density(1e4, 2., 0.4, 0.1);
  EXPECT_NEAR(std::log2(fall), -5. / 3., 1e-6);
}

TEST(VonKarmanDensity, DoesNotDependOnTheDirectionOfTheMean) {
  EXPECT_EQ(von_karman_density(3., -2., 0.4, 0.1), von_karman_density(3., 2., 0.4, 0.1));
}

// --- turbulent wind

TEST(TurbulentWind, HasExactlyTheMeanSpeed) {
  for (const std::size_t n : {2ul, 63ul, n_samples})
    EXPECT_NEAR(mean_of(make_wind(free_turbulence(), rate_hz, n, 3)), 2., 1e-13) << n;
}

// Each line's power is exponential with mean S df, so the variance of one record has the standard
// deviation sqrt(sum (S df)^2); 40 records, four deviations.
TEST(TurbulentWind, HasTheVarianceOfTheDensityOverTheRecordsBand) {
  const WindParameters wind = free_turbulence();
  const double n_records = 40.;
  double variance = 0.;
  for (std::uint64_t seed = 0; seed < n_records; ++seed)
    variance += mean_square_about(2., make_wind(wind, rate_hz, n_samples, seed)) / n_records;
  double spread = 0.;
  for (std::size_t k = 1; k <= n_samples / 2; ++k)
    spread += std::pow(density(wind, k * resolution_hz) * resolution_hz, 2);
  const double expected = integral_of_density(wind, 0.5 * resolution_hz, 0.5 * rate_hz);
  EXPECT_NEAR(variance, expected, 4. * std::sqrt(spread / n_records));
  EXPECT_LT(4. * std::sqrt(spread / n_records), 0.05 * expected) << "too few records to tell";
}

TEST(TurbulentWind, HasTheDensityOfVonKarmanInEveryBand) {
  const WindParameters wind = free_turbulence();
  const std::size_t n_records = 40, n_lines = 10;
  for (const std::size_t first : {1ul, 20ul, 100ul, 500ul, 1500ul, 2038ul}) {
    double ratio = 0.;
    for (std::uint64_t seed = 0; seed < n_records; ++seed) {
      const auto speed = make_wind(wind, rate_hz, n_samples, seed);
      for (std::size_t k = first; k < first + n_lines; ++k)
        ratio += 2. * std::norm(line(speed, k)) / (n_samples * rate_hz) /
                 density(wind, k * resolution_hz) / (n_records * n_lines);
    }
    EXPECT_NEAR(ratio, 1., 4. / std::sqrt(n_records * n_lines)) << first * resolution_hz << " Hz";
  }
}

// Of an exponential variable with mean 1: variance 1, whose estimate scatters by sqrt(8/n). Fixed
// amplitudes would give 0. A mean phasor of n random phases is longer than 4/sqrt(n) once in e^16.
TEST(TurbulentWind, HasRayleighAmplitudesAndUniformPhases) {
  const WindParameters wind = free_turbulence();
  const double n = 2000.;
  double spread = 0.;
  std::complex<double> phasor = 0.;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto speed = make_wind(wind, rate_hz, n_samples, seed);
    for (std::size_t k = 10; k < 110; ++k) {
      const std::complex<double> x = line(speed, k);
      const double power =
          2. * std::norm(x) / (n_samples * rate_hz) / density(wind, k * resolution_hz);
      spread += (power - 1.) * (power - 1.) / n;
      phasor += x / std::abs(x) / n;
    }
  }
  EXPECT_NEAR(spread, 1., 4. * std::sqrt(8. / n));
  EXPECT_LT(std::abs(phasor), 4. / std::sqrt(n));
}

// Two samples have the line at half the rate alone, half a line wide; three have one whole line.
TEST(TurbulentWind, HasTheRightPowerOnTheLastLineOfEvenAndOddRecords) {
  const WindParameters wind = free_turbulence();
  const std::uint64_t n_records = 4000;
  double even = 0., odd = 0.;
  for (std::uint64_t seed = 0; seed < n_records; ++seed) {
    even += mean_square_about(2., make_wind(wind, rate_hz, 2, seed)) / n_records;
    odd += mean_square_about(2., make_wind(wind, rate_hz, 3, seed)) / n_records;
  }
  EXPECT_NEAR(even / (density(wind, rate_hz / 2.) * rate_hz / 4.), 1.,
              4. * std::sqrt(2. / n_records));
  EXPECT_NEAR(odd / (density(wind, rate_hz / 3.) * rate_hz / 3.), 1.,
              4. * std::sqrt(1. / n_records));
}

TEST(TurbulentWind, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const WindParameters wind;
  const auto speed = make_wind(wind, rate_hz, 500, 17);
  EXPECT_EQ(make_wind(wind, rate_hz, 500, 17), speed);
  for (const std::uint64_t seed : {0ull, 16ull, 18ull, 17ull + (1ull << 32)})
    EXPECT_NE(make_wind(wind, rate_hz, 500, seed), speed) << seed;
}

TEST(TurbulentWind, IsClippedLastAndOnlyWhereItExceedsTheMaximumSpeed) {
  WindParameters wind = free_turbulence();
  const auto unclipped = make_wind(wind, rate_hz, n_samples, 5);
  wind.maximum_speed = 2.5;
  const auto clipped = make_wind(wind, rate_hz, n_samples, 5);
  for (std::size_t i = 0; i < n_samples; ++i)
    ASSERT_EQ(clipped[i], std::clamp(unclipped[i], -2.5, 2.5)) << i;
  EXPECT_GT(std::count(clipped.begin(), clipped.end(), 2.5), 0);
}

TEST(TurbulentWind, IsClippedOnBothSides) {
  WindParameters wind = wind_of(WindKind::turbulent);
  wind.mean_speed = -0.1;
  wind.turbulence_intensity = 5.;
  wind.maximum_speed = 0.15;
  const auto speed = make_wind(wind, rate_hz, n_samples, 5);
  EXPECT_EQ(*std::min_element(speed.begin(), speed.end()), -0.15);
  EXPECT_EQ(*std::max_element(speed.begin(), speed.end()), 0.15);
}

TEST(TurbulentWind, OfOneSampleIsTheMeanAndOfNoneIsEmpty) {
  EXPECT_THAT(make_wind(WindParameters(), rate_hz, 1, 0), testing::ElementsAre(2.));
  EXPECT_TRUE(make_wind(WindParameters(), rate_hz, 0, 0).empty());
}

// --- wind without chance

TEST(SteadyWind, IsTheMeanSpeed) {
  EXPECT_THAT(make_wind(wind_of(WindKind::steady), rate_hz, 3, 0), testing::Each(2.));
}

TEST(NoWind, IsStillWhateverTheMeanSpeed) {
  EXPECT_THAT(make_wind(wind_of(WindKind::none), rate_hz, 3, 0), testing::Each(0.));
}

TEST(SineWind, IsTheMeanPlusEachSineWithItsPhase) {
  WindParameters wind = wind_of(WindKind::sines);
  wind.sine_frequency_hz = {5., 20.};
  wind.sine_amplitude = {1., 0.25};
  wind.sine_phase_deg = {0., 90.};
  const auto speed = make_wind(wind, rate_hz, 400, 0);
  for (std::size_t i = 0; i < speed.size(); ++i) {
    const double t = i / rate_hz;
    EXPECT_NEAR(speed[i], 2. + std::sin(10. * pi * t) + 0.25 * std::cos(40. * pi * t), 1e-12) << i;
  }
}

TEST(SineWind, RefusesASineAtOrAboveHalfTheSamplingRate) {
  WindParameters wind = wind_of(WindKind::sines);
  for (const double frequency_hz : {100., 250.}) {
    wind.sine_frequency_hz = {frequency_hz};
    EXPECT_THAT([&] { make_wind(wind, rate_hz, 10, 0); },
                ThrowsMessage<UserError>(AllOf(HasSubstr("Sine frequencies"),
                                               HasSubstr("half the sampling rate of 200 Hz"))));
  }
  wind.sine_frequency_hz = {99.9};
  EXPECT_NO_THROW(make_wind(wind, rate_hz, 10, 0));
}

// --- the case file

WindParameters parsed(const std::string& entries) {
  ParameterHandler prm;
  WindParameters::declare(prm);
  std::istringstream in("subsection Wind\n" + entries + "\nend\n");
  prm.parse_input(in, "case.prm");
  WindParameters wind;
  wind.parse(prm);
  return wind;
}

TEST(WindParameters, AnEmptyCaseFileGivesTheDefaults) {
  const WindParameters wind = parsed(""), nominal;
  EXPECT_EQ(wind.kind, nominal.kind);
  EXPECT_EQ(wind.mean_speed, nominal.mean_speed);
  EXPECT_EQ(wind.sine_frequency_hz, nominal.sine_frequency_hz);
  EXPECT_EQ(wind.sine_amplitude, nominal.sine_amplitude);
  EXPECT_EQ(wind.sine_phase_deg, nominal.sine_phase_deg);
  EXPECT_EQ(wind.turbulence_intensity, nominal.turbulence_intensity);
  EXPECT_EQ(wind.length_scale, nominal.length_scale);
  EXPECT_EQ(wind.maximum_speed, nominal.maximum_speed);
  EXPECT_EQ(wind.profile, nominal.profile);
  EXPECT_EQ(wind.air.density, nominal.air.density);
  EXPECT_EQ(wind.air.kinematic_viscosity, nominal.air.kinematic_viscosity);
}

TEST(WindParameters, EveryEntryReachesItsOwnMember) {
  const WindParameters wind = parsed(
      "set Kind = sines\n set Mean speed = -1.5\n set Sine frequencies = 1, 2\n"
      "set Sine amplitudes = 0.1, 0.2\n set Sine phases = 30, -60\n"
      "set Turbulence intensity = 0.3\n set Length scale = 0.05\n set Maximum speed = 6\n"
      "set Profile = parabolic\n set Air density = 1.1\n set Air kinematic viscosity = 1.6e-5");
  EXPECT_EQ(wind.kind, WindKind::sines);
  EXPECT_EQ(wind.mean_speed, -1.5);
  EXPECT_THAT(wind.sine_frequency_hz, testing::ElementsAre(1., 2.));
  EXPECT_THAT(wind.sine_amplitude, testing::ElementsAre(0.1, 0.2));
  EXPECT_THAT(wind.sine_phase_deg, testing::ElementsAre(30., -60.));
  EXPECT_EQ(wind.turbulence_intensity, 0.3);
  EXPECT_EQ(wind.length_scale, 0.05);
  EXPECT_EQ(wind.maximum_speed, 6.);
  EXPECT_EQ(wind.profile, WindProfile::parabolic);
  EXPECT_EQ(wind.air.density, 1.1);
  EXPECT_EQ(wind.air.kinematic_viscosity, 1.6e-5);
}

TEST(WindParameters, KnowEveryKindOfWind) {
  EXPECT_EQ(parsed("set Kind = none").kind, WindKind::none);
  EXPECT_EQ(parsed("set Kind = steady").kind, WindKind::steady);
  EXPECT_EQ(parsed("set Kind = sines").kind, WindKind::sines);
  EXPECT_EQ(parsed("set Kind = turbulent").kind, WindKind::turbulent);
  EXPECT_EQ(parsed("set Kind = recorded").kind, WindKind::recorded);
  EXPECT_EQ(parsed("set Profile = uniform").profile, WindProfile::uniform);
}

TEST(WindParameters, AValueOutOfRangeIsRefusedWithItsLineAndEntry) {
  const auto refused = [](const std::string& entry, const std::string& name) {
    EXPECT_THAT([&] { parsed("set " + entry); },
                ThrowsMessage<std::exception>(AllOf(HasSubstr("Line <2>"), HasSubstr(name))))
        << entry;
  };
  refused("Kind = gusty", "none|steady|sines|turbulent|recorded");
  refused("Profile = logarithmic", "uniform|parabolic");
  refused("Mean speed = fast", "Mean speed");
  refused("Turbulence intensity = -0.1", "Turbulence intensity");
  refused("Length scale = 0", "Length scale");
  refused("Maximum speed = -4", "Maximum speed");
  refused("Sine frequencies = 5, -1", "Sine frequencies");
  refused("Air density = 0", "Air density");
  refused("Air kinematic viscosity = 0", "Air kinematic viscosity");
  refused("Gusts = 3", "Gusts");
}

TEST(WindParameters, EntriesThatDoNotFitEachOtherAreRefusedWithTheirNames) {
  const auto refused = [](const std::string& entries, const std::string& why) {
    EXPECT_THAT([&] { parsed(entries); },
                ThrowsMessage<UserError>(AllOf(HasSubstr("subsection Wind"), HasSubstr(why))))
        << entries;
  };
  refused("set Sine frequencies = 5, 7", "have 2, 1 and 1 values");
  refused("set Sine phases = 0, 10, 20", "have 1, 1 and 3 values");
  refused("set Sine frequencies = 0", "Sine frequencies is 0 Hz; it must be above zero");
  refused("set Kind = sines\nset Sine frequencies =\nset Sine amplitudes =\nset Sine phases =",
          "Sine frequencies is empty");
  refused("set Mean speed = 0", "Mean speed is 0 m/s; it must be other than zero");
  refused("set Mean speed = -5", "below Maximum speed (4 m/s)");
}

TEST(WindParameters, MeansThatTurbulenceCouldNotHaveAreFineForOtherWind) {
  EXPECT_NO_THROW(parsed("set Kind = steady\nset Mean speed = 0"));
  EXPECT_NO_THROW(parsed("set Kind = sines\nset Mean speed = 5"));
}

TEST(WindParameters, NumbersThatAreNotFiniteAreRefusedBeforeAnyWindIsMade) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double WindParameters::*const member :
       {&WindParameters::mean_speed, &WindParameters::turbulence_intensity,
        &WindParameters::length_scale, &WindParameters::maximum_speed}) {
    WindParameters wind;
    wind.*member = nan;
    EXPECT_THROW(make_wind(wind, rate_hz, 10, 0), UserError);
  }
  WindParameters wind = wind_of(WindKind::sines);
  wind.sine_amplitude = {nan};
  EXPECT_THAT([&] { wind.check(); }, ThrowsMessage<UserError>(HasSubstr("Sine amplitudes is nan")));
}

}  // namespace
}  // namespace vibrissa::flow
