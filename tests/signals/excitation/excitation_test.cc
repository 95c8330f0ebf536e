#include "signals/excitation/excitation.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "signals/base/error.h"
#include "signals/excitation/multisine.h"
#include "signals/files/record_io.h"
#include "signals/spectra/fft.h"
#include "tests/signals/peak.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using test::peak;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using vibrissa::signals::test::TemporaryFolder;

TEST(Excitation, MultisineHasPowerAtItsExcitedLinesAlone) {
  for (const auto grid : {LineGrid::full, LineGrid::odd, LineGrid::random_odd}) {
    const auto excitation = design_excitation({.grid = grid, .phase = PhaseRule::random});
    const auto& drive = excitation.drives.front();
    const auto spectrum = real_fft(drive.period);
    std::vector<double> wanted(spectrum.size(), 0.);
    for (const auto& line : excitation.lines) {
      EXPECT_NEAR(line.frequency_hz, static_cast<double>(line.order) * 500. / 2048., 1e-12);
      wanted[line.order] = line.amplitude;
    }
    for (std::size_t k = 0; k < spectrum.size(); ++k)
      EXPECT_NEAR(std::abs(spectrum[k]) / 1024., wanted[k], 1e-14);
  }
}

// The form that the description states, evaluated on denser time.
TEST(Excitation, PeaksAsAskedBetweenTheSamplesTooWithTheStatedCrestFactor) {
  for (const auto phase : {PhaseRule::schroeder, PhaseRule::random, PhaseRule::optimised}) {
    const auto excitation = design_excitation(
        {.low_hz = 5., .high_hz = 60., .grid = LineGrid::odd, .phase = phase, .peak = 3.9});
    const auto& drive = excitation.drives.front();
    Multisine sum{{}, {}, drive.phase_rad};
    for (const auto& line : excitation.lines) {
      if (line.role != LineRole::excited) continue;
      sum.frequency_hz.push_back(line.frequency_hz);
      sum.amplitude.push_back(line.amplitude);
    }
    const auto dense = sum.sample(500. * 16., 2048 * 16);
    EXPECT_NEAR(peak(dense), 3.9, 0.02) << name_of(phase);
    EXPECT_NEAR(crest_factor(dense), drive.crest_factor, 0.01);
    for (std::size_t i = 0; i < 2048; ++i) EXPECT_NEAR(drive.period[i], dense[16 * i], 1e-11);
  }
}

TEST(Excitation, OptimisedPhasesBeatSchroedersAndRandomOnes) {
  const auto crest = [](PhaseRule phase) {
    return design_excitation({.grid = LineGrid::full, .phase = phase}).drives[0].crest_factor;
  };
  EXPECT_LT(crest(PhaseRule::optimised), 1.45);
  EXPECT_GT(crest(PhaseRule::schroeder), 1.6);
  EXPECT_GT(crest(PhaseRule::random), 2.5);
}

TEST(Excitation, RealisationsDifferInPhaseAndShareTheirLinesAndPeak) {
  const auto excitation = design_excitation({.phase = PhaseRule::random, .n_realisations = 3});
  ASSERT_EQ(excitation.drives.size(), 3u);
  EXPECT_NE(excitation.drives[0].phase_rad, excitation.drives[1].phase_rad);
  EXPECT_NE(excitation.drives[1].phase_rad, excitation.drives[2].phase_rad);
  for (const auto& drive : excitation.drives) {
    EXPECT_LE(peak(drive.period), 1. + 1e-12);
    EXPECT_GT(peak(drive.period), 0.9);
  }
}

TEST(Excitation, LevelsAreExactMultiplesOfEachRealisation) {
  const auto excitation =
      design_excitation({.phase = PhaseRule::random, .levels = {0.25, 1.}, .n_realisations = 2});
  ASSERT_EQ(excitation.drives.size(), 4u);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(excitation.drives[r].level, 0.25);
    EXPECT_EQ(excitation.drives[r].realisation, r + 1);
    for (std::size_t i = 0; i < 2048; ++i)
      EXPECT_EQ(excitation.drives[r].period[i], 0.25 * excitation.drives[2 + r].period[i]);
  }
}

TEST(Excitation, EqualDesignsAreEqualAndOtherSeedsDiffer) {
  for (const auto kind : {ExcitationKind::multisine, ExcitationKind::noise}) {
    const auto period = [&](std::uint64_t seed) {
      return design_excitation({.kind = kind, .phase = PhaseRule::random, .seed = seed})
          .drives[0]
          .period;
    };
    EXPECT_EQ(period(1), period(1));
    EXPECT_NE(period(1), period(2));
  }
}

TEST(Excitation, SendsTheLeadInAndThePeriodsToBeKept) {
  const auto excitation =
      design_excitation({.kind = ExcitationKind::sweep, .n_periods = 3, .n_lead_in_periods = 2});
  const auto x = excitation.samples(excitation.drives[0]);
  ASSERT_EQ(x.size(), 5 * 2048u);
  for (std::size_t i = 2048; i < x.size(); ++i) EXPECT_EQ(x[i], x[i - 2048]);
}

TEST(Excitation, DescribesCrestFactorsLinesAndWhatTheyReveal) {
  const auto json = to_json(design_excitation({.levels = {0.5, 1.}}));
  EXPECT_EQ(json["schema"], "vibrissa-excitation-1");
  EXPECT_EQ(json["drives"].size(), 2u);
  EXPECT_LT(json["drives"][0]["crest_factor"].get<double>(), 1.5);
  std::size_t n_excited = 0;
  for (const auto& line : json["lines"]) {
    const std::string role = line["role"], reveals = line["reveals"];
    EXPECT_EQ(role == "excited", line["amplitude"].get<double>() > 0.);
    n_excited += role == "excited";
    if (role == "excited") continue;
    const std::string kind = role == "even detection" ? "even distortion" : "odd distortion";
    EXPECT_EQ(reveals.substr(0, kind.size()), kind);
  }
  EXPECT_EQ(json["drives"][0]["phase_rad"].size(), n_excited);
}

TEST(Excitation, FilesHoldTheSameDrive) {
  const TemporaryFolder folder;
  const auto excitation = design_excitation({.peak = 3., .levels = {0.5, 1.5}});
  EXPECT_EQ(excitation.full_scale(), 4.5);
  for (const auto& drive : excitation.drives) {
    const auto wanted = excitation.samples(drive);
    write_drive_record(folder.path() / "drive.csv", excitation, drive, "base_acceleration_m_s2");
    const Record record = read_record(folder.path() / "drive.csv");
    EXPECT_EQ(record.sampling_rate_hz(), 500.);
    EXPECT_THAT(record.channel("base_acceleration_m_s2"), ::testing::ElementsAreArray(wanted));
    write_drive_wav(folder.path() / "drive.wav", excitation, drive, WavFormat::float32);
    const auto sound = read_wav(folder.path() / "drive.wav").channels[0];
    ASSERT_EQ(sound.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
      EXPECT_NEAR(sound[i] * excitation.full_scale(), wanted[i], 4.5 * 6e-8);
  }
}

TEST(Excitation, IsWrittenInTheUnitOfItsChannel) {
  const test::TemporaryFolder folder;
  const DesignedExcitation excitation = design_excitation({.peak = 0.4, .unit = "g"});
  write_drive_record(folder.path() / "g.csv", excitation, excitation.drives[0],
                     channel::base_acceleration);
  const Record record = read_record(folder.path() / "g.csv");
  const auto a = record.channel(channel::base_acceleration);
  EXPECT_NEAR(*std::max_element(a.begin(), a.end()),
              9.80665 * std::ranges::max(excitation.samples(excitation.drives[0])), 1e-12);
  EXPECT_THROW(write_drive_record(folder.path() / "b.csv", excitation, excitation.drives[0],
                                  channel::base_moment),
               UserError);
}

TEST(Excitation, RefusesADesignThatContradictsItself) {
  const auto design = [](ExcitationDesign wanted) { return [=] { design_excitation(wanted); }; };
  EXPECT_THAT(
      design({.high_hz = 250.}),
      ThrowsMessage<UserError>(AllOf(HasSubstr("250 Hz"), HasSubstr("half the sampling rate"))));
  EXPECT_THAT(design({.sampling_rate_hz = 0.}), ThrowsMessage<UserError>(HasSubstr("rate 0 Hz")));
  EXPECT_THAT(design({.period_samples = 1}), ThrowsMessage<UserError>(HasSubstr("too short")));
  EXPECT_THAT(design({.peak = 0.}), ThrowsMessage<UserError>(HasSubstr("peak 0")));
  EXPECT_THAT(design({.levels = {}}), ThrowsMessage<UserError>(HasSubstr("no level")));
  EXPECT_THAT(design({.levels = {1., -1.}}), ThrowsMessage<UserError>(HasSubstr("level -1")));
  EXPECT_THAT(design({.n_realisations = 0}), ThrowsMessage<UserError>(HasSubstr("1 to 1000")));
  EXPECT_THAT(design({.n_periods = 0}), ThrowsMessage<UserError>(HasSubstr("one period")));
  EXPECT_THAT(design({.n_periods = 1u << 27}), ThrowsMessage<UserError>(HasSubstr("samples")));
  EXPECT_THAT(design({.kind = ExcitationKind::sweep, .fade_s = 3.}),
              ThrowsMessage<UserError>(HasSubstr("fade of 3 s")));
  EXPECT_THAT(design({.kind = ExcitationKind::sweep, .n_realisations = 2}),
              ThrowsMessage<UserError>(HasSubstr("one realisation")));
  EXPECT_THAT(design({.phase = PhaseRule::schroeder, .n_realisations = 2}),
              ThrowsMessage<UserError>(HasSubstr("one realisation")));
}

}  // namespace
}  // namespace vibrissa::signals
