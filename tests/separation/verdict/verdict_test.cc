#include "separation/verdict/verdict.h"
#include "separation/verdict/coherence.h"
#include "separation/verdict/peak_phase.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "separation/model/simulation.h"
#include "separation/verdict/identification_json.h"
#include "tests/separation/moment_record.h"

namespace vibrissa::separation {
namespace {

using test::make_record;
using test::rate_hz;
using test::Signal;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

signals::Record noisy_record(const Signal& motion, const Bvrm& truth, double noise_share,
                             std::uint64_t seed) {
  const Signal moment = simulate(truth, motion, rate_hz);
  return make_record(motion, test::plus_noise(moment, noise_share * test::rms(moment), seed));
}

// Only below 60 Hz.
Signal slow_motion(std::size_t n, std::uint64_t seed) {
  return test::Lines(1., 60., 200, seed).sample(n, rate_hz);
}

FittedBvrm known_fit(const std::vector<ModalTerm>& modes, double relative_deviation) {
  Bvrm model{.modes = modes};
  const Eigen::VectorXd parameters = to_parameters(model, false);
  const Eigen::VectorXd variance = (relative_deviation * parameters).array().square().matrix();
  return make_fitted(parameters, variance.asDiagonal(), false, 0.);
}

TEST(Verdict, SaysForWhichBandAModelOfANoisySensorIsUsableAndHowGood) {
  const signals::Record record =
      noisy_record(test::white_noise(6000, 3., 1), test::sensor(1), 0.1, 2);
  const Verdict verdict = judge(identify_record(record), record);
  EXPECT_TRUE(verdict.usable);
  EXPECT_THAT(verdict.sentence, AllOf(StartsWith("Usable from"), HasSubstr("99."),
                                      HasSubstr("data that it has not seen")));
  EXPECT_EQ(verdict.determined.size(), 1u);
  EXPECT_LT(verdict.band.low_hz, 31.);
  EXPECT_GT(verdict.band.high_hz, 60.);
}

// 1.2 times the time in which the amplitude falls by e: the part that is not held out is shorter.
TEST(Verdict, TellsAModeThatDecaysWithinTheWholeRecord) {
  const double frequency_hz = 31., damping_ratio = 1e-3;
  const Bvrm truth{.modes = {make_modal_term(frequency_hz, damping_ratio, 1e-6)}};
  const auto n = static_cast<std::size_t>(1.2 * rate_hz /
                                          (2. * std::numbers::pi * frequency_hz * damping_ratio));
  const signals::Record record = noisy_record(test::white_noise(n, 3., 11), truth, 0.05, 12);
  const Verdict verdict = judge(identify_record(record), record);
  EXPECT_TRUE(verdict.usable);
  EXPECT_EQ(verdict.determined.size(), 1u);
}

// The end of the decay is no other hit.
TEST(Verdict, AsksForASecondHitToScoreTheModel) {
  Signal hit(4096, 0.);
  for (std::size_t i = 0; i < 5; ++i) hit[85 + i] = 40. * std::sin(0.5 * (1. + double(i)));
  hit = test::plus_noise(hit, 1e-3, 14);
  const signals::Record record = noisy_record(hit, test::sensor(1), 0.01, 13);
  const Verdict verdict = judge(identify_record(record), record);
  EXPECT_THAT(verdict.sentence, HasSubstr("record a second hit to score the model"));
}

TEST(Verdict, CallsNoiseNotUsable) {
  const signals::Record record =
      make_record(test::white_noise(4000, 1., 3), test::white_noise(4000, 1., 4));
  const Verdict verdict = judge(identify_record(record), record);
  EXPECT_FALSE(verdict.usable);
  EXPECT_THAT(verdict.sentence, StartsWith("Not usable: the model explains"));
}

TEST(Verdict, KnowsTheBandThatWasExcited) {
  const signals::Record record = noisy_record(slow_motion(8000, 5), test::sensor(1), 0.05, 6);
  const Band band = coherent_band(record);
  EXPECT_LT(band.low_hz, 5.);
  EXPECT_NEAR(band.high_hz, 60., 5.);
}

TEST(Verdict, SetsPolesApartThatTheDataDoNotTell) {
  const signals::Record record = noisy_record(slow_motion(8000, 7), test::sensor(1), 0.05, 8);
  Identification found;
  found.held_out_vaf_percent = 99.;
  found.duration_s = record.duration_s();
  const auto reasons_of = [&](const ModalTerm& mode, double deviation) {
    found.fit = known_fit({make_modal_term(30., 0.02, 1e-6), mode}, deviation);
    const Verdict verdict = judge(found, record);
    EXPECT_EQ(verdict.determined.size() + verdict.undetermined.size(), 2u);
    return verdict.undetermined.empty() ? std::string() : verdict.undetermined[0].reason;
  };
  EXPECT_EQ(reasons_of(make_modal_term(40., 0.02, 1e-6), 0.01), "");
  EXPECT_THAT(reasons_of(make_modal_term(150., 0.02, 1e-6), 0.01),
              HasSubstr("outside the band in which the moment follows the base acceleration, "));
  EXPECT_THAT(reasons_of(make_modal_term(40., 3., 1e-6), 0.01), HasSubstr("two real poles"));
  EXPECT_THAT(reasons_of(make_modal_term(40., 1e-6, 1e-6), 0.01), HasSubstr("does not decay"));
  EXPECT_THAT(reasons_of(make_modal_term(40., 0.02, 1e-6), 0.8), HasSubstr("not told from zero"));
  found.fit.end = FitEnd::step_limit;
  EXPECT_TRUE(judge(found, record).determined.empty());
}

TEST(Verdict, SaysADelayOfAUsableModelOnly) {
  const signals::Record record = noisy_record(slow_motion(8000, 7), test::sensor(1), 0.05, 8);
  Identification found;
  found.duration_s = record.duration_s();
  found.found_delay_s = Estimate{-0.02, 1e-4};
  found.fit = known_fit({make_modal_term(30., 0.02, 1e-6)}, 0.01);
  ModelEvidence evidence;
  for (const bool usable : {true, false}) {
    found.held_out_vaf_percent = usable ? 99. : 30.;
    evidence.verdict = judge(found, record);
    EXPECT_THAT(evidence.verdict.sentence, StartsWith(usable ? "The moment leads" : "Not usable"));
    EXPECT_EQ(identification_report(found, evidence, "").contains("delay_s"), usable);
  }
}

TEST(Verdict, TestsTheHoldOfAUsableModelOnly) {
  const signals::Record record =
      noisy_record(test::white_noise(4000, 3., 15), test::sensor(1), 0.05, 16);
  Identification found = identify_record(record);
  const auto [fit, held_out] = hold_out_last_third(record);
  EXPECT_FALSE(examine(found, fit, held_out).hold.trials.empty());
  found.held_out_vaf_percent = 30.;
  EXPECT_TRUE(examine(found, fit, held_out).hold.trials.empty());
}

signals::FrequencyResponse at_lines_of_an_analyser(const Bvrm& model) {
  signals::FrequencyResponse out;
  for (double f = 100.; f < 300.; f += 0.3125) out.frequency_hz.push_back(f);
  out.value = separation::response(model, out.frequency_hz);
  return out;
}

TEST(Verdict, TakesThePeakBetweenTwoLinesForAFrequencyWithoutDamping) {
  const Bvrm truth{.modes = {make_modal_term(212.1, 8e-4, 30.)}};
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  signals::FrequencyResponse response = at_lines_of_an_analyser(truth);
  for (auto& value : response.value) value += 2. * std::complex(normal(random), normal(random));
  const Verdict verdict = judge(identify_response(response, {.order = 2}), response);
  EXPECT_TRUE(verdict.determined.empty());
  ASSERT_EQ(verdict.frequency_only.size(), 1u);
  EXPECT_THAT(verdict.frequency_only[0].reason, HasSubstr("not resolved"));
  EXPECT_TRUE(verdict.undetermined.empty());
  EXPECT_FALSE(verdict.usable);
  EXPECT_THAT(verdict.sentence, StartsWith("Not usable as a model, only for the frequencies"));
}

// One record in a hundred is expected; segments that overlap are no independent ones.
TEST(CoherentLines, AreInOneUnrelatedRecordOfAHundred) {
  std::size_t n_records = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed)
    n_records += !coherent_lines(make_record(test::white_noise(4096, 1., seed),
                                             test::white_noise(4096, 1., 1000 + seed)))
                      ->lines.empty();
  EXPECT_LE(n_records, 10u);
  EXPECT_NEAR(coherence_limit(1, 2.), 0.99, 1e-12) << "one line, a line through two points";
}

// An analyser's coherence falls where the drive ends; the lines there are noise.
TEST(Verdict, GoesByTheLinesThatAModelWeightedByCoherenceExplains) {
  signals::FrequencyResponse response =
      at_lines_of_an_analyser({.modes = {make_modal_term(212., 0.02, 30.)}});
  std::mt19937_64 random(10);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    const bool is_driven = response.frequency_hz[i] < 250.;
    response.coherence.push_back(is_driven ? 0.99 : 0.1);
    const double noise = is_driven ? 0.07 : 2.1;  // sqrt((1 - g2) / (2 g2)) of the value
    response.value[i] +=
        noise * std::abs(response.value[i]) * std::complex(normal(random), normal(random));
  }
  IdentifiedResponse found;
  found.fit = known_fit({make_modal_term(212., 0.02, 30.), make_modal_term(290., 0.02, 1.)}, 0.01);
  const Verdict verdict = judge(found, response);
  EXPECT_NEAR(verdict.band.high_hz, 250., 2.);
  EXPECT_THAT(verdict.determined, ElementsAre(0u));
  EXPECT_THAT(verdict.sentence, HasSubstr("Coherence of the file: median 0.99"));
  response.coherence.clear();
  EXPECT_THAT(judge(found, response).determined, ElementsAre(0u, 1u));
}

// After many averages lines of low coherence are known well.
TEST(Verdict, TakesAPeakThatIsClearAtLowCoherence) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  signals::FrequencyResponse response =
      at_lines_of_an_analyser({.modes = {make_modal_term(212.1, 8e-4, 30.)}});
  for (auto& value : response.value) {
    value += 2. * std::complex(normal(random), normal(random));
    response.coherence.push_back(response.coherence.size() < 20 ? 0.55 : 0.33);
  }
  const Verdict verdict = judge(identify_response(response, {.order = 2}), response);
  ASSERT_EQ(verdict.frequency_only.size(), 1u);
  EXPECT_GT(verdict.band.high_hz, 213.);
}

TEST(Verdict, NamesTheBandOfAHitAndTheLinesOfAResponse) {
  const signals::FrequencyResponse response =
      at_lines_of_an_analyser({.modes = {make_modal_term(212., 0.02, 30.)}});
  IdentifiedResponse of_lines;
  of_lines.fit = known_fit({make_modal_term(400., 0.02, 30.)}, 0.01);
  EXPECT_THAT(judge(of_lines, response).undetermined.at(0).reason,
              HasSubstr("outside the lines of the response, 100 Hz to "));
  Signal hit(4096, 0.);
  for (std::size_t i = 0; i < 50; ++i) hit[85 + i] = std::sin(0.0628 * (0.5 + double(i)));
  const signals::Record record = noisy_record(hit, test::sensor(1), 0.01, 17);
  Identification of_hit;
  of_hit.n_hits = 1;
  of_hit.fit = known_fit({make_modal_term(200., 0.02, 1e-6)}, 0.01);
  EXPECT_THAT(judge(of_hit, record).undetermined.at(0).reason,
              HasSubstr("outside the band that the hit excites, "));
}

// A machine's tone that is in the moment alone: a ratio of spectra has a peak there, which is no
// answer to the base.
TEST(Verdict, GivesAPeakWhosePhaseRisesTheFrequencyOfItsAmplitude) {
  const Bvrm sensor{.modes = {make_modal_term(150., 0.02, 1.)}};
  const Bvrm other{.modes = {make_modal_term(192.6, 2e-4, 0.05)}};
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const signals::FrequencyResponse response = at_lines_of_an_analyser(sensor);
  const auto with_peak = [&](const bool conjugated) {
    signals::FrequencyResponse both = response;
    const auto peak = separation::response(other, response.frequency_hz);
    for (std::size_t i = 0; i < peak.size(); ++i)
      both.value[i] += (conjugated ? std::conj(peak[i]) : peak[i]) +
                       0.01 * std::complex(normal(random), normal(random));
    return both;
  };
  const signals::FrequencyResponse rising = with_peak(true), falling = with_peak(false);
  EXPECT_TRUE(phase_rises(rising, 192.6));
  EXPECT_FALSE(phase_rises(falling, 192.6));
  const Verdict verdict = judge(identify_response(rising, {.order = 4}), rising);
  EXPECT_EQ(verdict.determined.size(), 1u);
  EXPECT_TRUE(verdict.undetermined.empty());
  ASSERT_EQ(verdict.frequency_only.size(), 1u);
  EXPECT_THAT(verdict.frequency_only[0].reason, HasSubstr("the phase rises"));
  ASSERT_TRUE(verdict.frequency_only[0].peak_hz);
  EXPECT_NEAR(verdict.frequency_only[0].peak_hz->value, 192.6, 0.1);
  EXPECT_TRUE(verdict.usable) << verdict.sentence;
  // The sign convention of the file changes nothing.
  for (const auto& response : {falling, conjugate_of(falling)}) {
    const Verdict of_falling = judge(identify_response(response, {.order = 4}), response);
    EXPECT_EQ(of_falling.determined.size(), 1u);
    EXPECT_EQ(of_falling.frequency_only.size(), 1u);
    EXPECT_TRUE(of_falling.undetermined.empty());
    EXPECT_THAT(of_falling.sentence, StartsWith("Usable from"));
  }
}

// The moment moves by itself, and the ratio to the noise of a still base has phases of its own.
TEST(Verdict, FindsThePeakOfLinesWithoutAPhase) {
  constexpr double peak_hz = 192.594, half_width_hz = 0.2;
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> phase(-std::numbers::pi, std::numbers::pi);
  signals::FrequencyResponse response = at_lines_of_an_analyser({});
  for (std::size_t i = 0; i < response.value.size(); ++i)
    response.value[i] = std::polar(
        1. / std::hypot(response.frequency_hz[i] - peak_hz, half_width_hz), phase(random));
  EXPECT_NEAR(amplitude_peak_hz(response, 192.3), peak_hz, 0.01);
}

TEST(Verdict, WritesTheFrequencyOfTheAmplitudeIntoItsJson) {
  Verdict verdict;
  verdict.frequency_only = {{.mode = 0, .reason = "why", .peak_hz = Estimate{192.6, 0.09}}};
  nlohmann::json document = fitted_json(known_fit({make_modal_term(192.4, 2e-4, 1.)}, 0.1));
  add_verdict(verdict, document);
  EXPECT_EQ(document["frequency_only"][0]["frequency_hz"], 192.6);
  EXPECT_EQ(document["frequency_only"][0]["frequency_sd_hz"], 0.09);
}

TEST(Verdict, WritesADampingThatIsNotResolvedAsNull) {
  const signals::FrequencyResponse response =
      at_lines_of_an_analyser({.modes = {make_modal_term(212.1, 8e-4, 30.)}});
  IdentifiedResponse found;
  found.fit = known_fit({make_modal_term(212.1, 8e-4, 30.), make_modal_term(150., 0.02, 1.)}, 1e-3);
  found.order_words = "both select order 4";
  const auto document = identified_response_json(found, judge(found, response), "kg m");
  ASSERT_EQ(document["frequency_only"].size(), 1u) << document;
  EXPECT_TRUE(document["frequency_only"][0]["damping_ratio"].is_null());
  EXPECT_TRUE(document["frequency_only"][0]["damping_sd"].is_null());
  EXPECT_EQ(document["modes"][0]["damping_ratio"], found.fit.modes[0].damping_ratio.value);
  EXPECT_EQ(document["order_words"], found.order_words);
}

// An analyser's Hann window makes the lines beside a narrow peak, which looks like a second mode.
TEST(Verdict, TakesTheShapeOfTheWindowForNoMode) {
  const double spacing_hz = 0.3125, peak_hz = 192.594;
  std::mt19937_64 random(10);
  std::normal_distribution<double> normal;
  signals::FrequencyResponse response;
  for (double f = 100.; f < 300.; f += spacing_hz) {
    response.frequency_hz.push_back(f);
    // Transform of a Hann window at a line's distance from a steady tone, with its phase.
    const double d = (f - peak_hz) / spacing_hz;
    const double hann = d == 0. ? 1. : std::sin(M_PI * d) / (M_PI * d * (1. - d * d));
    response.value.push_back(std::polar(1000. * hann, 0.3 - M_PI * d) +
                             0.05 * std::complex(normal(random), normal(random)));
  }
  const IdentifiedResponse found = identify_response(response, {.order = 6});
  const Verdict verdict = judge(found, response);
  EXPECT_TRUE(verdict.determined.empty());
  const auto at_peak = std::ranges::min_element(found.fit.modes, {}, [&](const auto& mode) {
    return std::abs(mode.frequency_hz.value - peak_hz);
  });
  EXPECT_NEAR(at_peak->frequency_hz.value, peak_hz, 3. * at_peak->frequency_hz.standard_deviation);
}

// A straight line between the samples of a sum of lines is another motion: a small error that
// follows the input.
TEST(Verdict, DoesNotAccuseAFitThatIsExact) {
  const Bvrm truth = test::sensor(1);
  const signals::Record record = noisy_record(test::white_noise(6000, 3., 10), truth, 2e-4, 11);
  const Identification found = identify_record(record);
  const auto [fit, held_out] = hold_out_last_third(record);
  const ModelEvidence evidence = examine(found, fit, held_out);
  EXPECT_THAT(evidence.residual.words, HasSubstr("too small to tell"));
  EXPECT_EQ(evidence.hold.words, "");
}

}  // namespace
}  // namespace vibrissa::separation
