#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <random>

#include "separation/model/sampled_bvrm.h"
#include "separation/model/simulation.h"
#include "separation/nonlinear/nonlinear_bank.h"
#include "signals/base/number_text.h"
#include "signals/files/record_io.h"
#include "tests/apps/program.h"
#include "tests/signals/rate.h"

namespace vibrissa::apps {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using signals::test::rate_hz;

/// White base acceleration and the noisy moment of a sensor with one mode.
signals::Record measured(const std::size_t n) {
  separation::Bvrm model;
  model.modes = {separation::make_modal_term(31.47, 0.027, -9e-6)};
  model.direct_term_kg_m = -2e-7;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> a(n);
  for (double& x : a) x = normal(random);
  auto moment = separation::simulate(model, a, rate_hz);
  double power = 0.;
  for (const double m : moment) power += m * m / static_cast<double>(n);
  for (double& m : moment) m += 0.05 * std::sqrt(power) * normal(random);
  signals::Record record(rate_hz, n);
  record.set_channel(signals::channel::base_acceleration, std::move(a));
  record.set_channel(signals::channel::base_moment, std::move(moment));
  return record;
}

TEST(Identify, FindsTheSensorByEveryMethodAndSaysWhich) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  signals::write_record(record, measured(6000));
  for (const std::string method : {"output-error", "srivc", "frequency"}) {
    const auto result = vibrissa("identify '" + record +
                                 "' --order 2 --hold first_order --json --method " + method);
    ASSERT_EQ(result.status, 0) << result.errors;
    const json found = result.json();
    EXPECT_EQ(found["method"], method);
    EXPECT_NEAR(found["modes"][0]["frequency_hz"].get<double>(), 31.47, 0.3) << method;
    // Welch's segments have leakage at such a sharp resonance, so the model is less accurate.
    EXPECT_GT(found["fit_percent"].get<double>(), method == "frequency" ? 75. : 94.) << method;
  }
  const auto unknown = vibrissa("identify '" + record + "' --method arx");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("output-error, srivc, frequency"));
}

TEST(Identify, BeginsWithWhetherTheResultCanBeBelieved) {
  const Folder folder;
  const std::string record = folder.file("r.csv"), noise = folder.file("noise.csv");
  signals::write_record(record, measured(6000));
  const auto good = vibrissa("identify '" + record + "' -o '" + folder.file("m.json") + "'");
  ASSERT_EQ(good.status, 0) << good.errors;
  EXPECT_THAT(good.output, StartsWith("Usable from"));
  EXPECT_THAT(good.output, HasSubstr("the model above is of the whole record"));
  const json found = vibrissa("identify '" + record + "' --json").json();
  EXPECT_EQ(found["usable"], true);
  EXPECT_EQ(found["modes"].size(), 1u);
  EXPECT_GT(found["band_hz"][1].get<double>(), 31.);
  signals::Record unrelated = measured(3000);
  const auto other = measured(6000).channel(signals::channel::base_moment);
  unrelated.set_channel(signals::channel::base_moment, {other.end() - 3000, other.end()});
  signals::write_record(noise, unrelated);
  EXPECT_THAT(vibrissa("identify '" + noise + "' -o '" + folder.file("n.json") + "'").output,
              AllOf(StartsWith("Not usable: "), HasSubstr("residual on"), Not(HasSubstr("poles"))));
}

TEST(Identify, NamesTwoClocksFirst) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  signals::Record late = measured(6000);
  const auto a = late.channel(signals::channel::base_acceleration);
  std::vector<double> shifted(a.begin(), a.end());
  std::rotate(shifted.begin(), shifted.end() - 10, shifted.end());
  late.set_channel(signals::channel::base_acceleration, shifted);
  signals::write_record(record, late);
  const auto result = vibrissa("identify '" + record + "' -o '" + folder.file("m.json") + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, StartsWith("The moment leads the base acceleration by 2"));
  EXPECT_THAT(result.output, HasSubstr("two clocks"));
  EXPECT_THAT(result.output, HasSubstr("31.4"));
}

TEST(Separate, SaysWhatAModelWouldLeaveWhereNoWindBlows) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  signals::write_record(record, measured(6000));
  const auto result = vibrissa("separate '" + record + "' -o '" + folder.file("w.csv") + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("Advice: without wind"));
  EXPECT_THAT(result.output, HasSubstr("vibrissa identify"));
}

TEST(Identify, OfAFewHundredSamplesEndsWithATableAndAModel) {
  const Folder folder;
  const std::string record = folder.file("r.csv"), model = folder.file("model.json");
  signals::write_record(record, measured(300));
  const auto result = vibrissa("identify --order 2 '" + record + "' -o '" + model + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("31."));
  EXPECT_TRUE(std::filesystem::exists(model));
}

/// The hold is given once, to identify.
TEST(Separate, TakesTheInputBetweenSamplesAsTheModelWasFitted) {
  const Folder folder;
  const std::string record = folder.file("r.csv"), model = folder.file("model.json");
  signals::write_record(record, measured(3000));
  ASSERT_EQ(
      vibrissa("identify --order 2 --hold zero_order '" + record + "' -o '" + model + "'").status,
      0);
  const auto wind = [&](const std::string& options) {
    const std::string out = folder.file("wind.csv");
    const auto result =
        vibrissa("separate '" + record + "' --model '" + model + "' -o '" + out + "' " + options);
    EXPECT_EQ(result.status, 0) << result.errors;
    const bool is_told = result.errors.find("zero_order") != std::string::npos;
    EXPECT_EQ(is_told, options.find("first_order") != std::string::npos) << result.errors;
    return content(out);
  };
  EXPECT_EQ(wind(""), wind("--hold zero_order"));
  EXPECT_NE(wind(""), wind("--hold first_order"));
  EXPECT_EQ(wind("--stream"), wind("--stream --hold zero_order"));
}

TEST(Separate, SaysInOneLineThatIdentifyCalledTheModelNotUsable) {
  const Folder folder;
  const std::string record = folder.file("r.csv"), model = folder.file("model.json");
  signals::write_record(record, measured(3000));
  separation::SampledBvrm bvrm{{.modes = {separation::make_modal_term(31.47, 0.027, -9e-6)}}};
  const auto errors = [&](const std::string& options) {
    separation::write_bvrm(model, bvrm);
    return vibrissa("separate '" + record + "' --model '" + model + "' -q -o '" +
                    folder.file("w.csv") + "'" + options)
        .errors;
  };
  const std::string sentence = "Not usable: the model explains nothing.";
  for (const std::string options : {"", " --stream"}) {
    bvrm.verdict = {false, sentence};
    EXPECT_THAT(errors(options),
                StartsWith("warning: " + model + ": 'identify' said of this model: " + sentence));
    bvrm.verdict = std::nullopt;
    EXPECT_THAT(errors(options), Not(HasSubstr("this model")));
  }
  ASSERT_EQ(vibrissa("identify '" + record + "' --order 2 -o '" + model + "'").status, 0);
  EXPECT_TRUE(separation::read_bvrm(model).verdict->usable);
}

/// Two recordings of one hit each, one after the other, and then without the second hit.
TEST(Identify, ScoresAHitByTheOneInTheOtherPieceOfTheFile) {
  const Folder folder;
  const std::string file = folder.file("hits.csv");
  const separation::Bvrm sensor{.modes = {separation::make_modal_term(31.47, 0.01, -9e-6)}};
  for (const bool has_second : {true, false}) {
    std::string text = "time_s,base_acceleration_m_s2,base_moment_N_m\n";
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (const std::size_t n : {4000u, 2000u}) {
      std::vector<double> a(n, 0.);
      for (std::size_t i = 0; i < 3; ++i) a[50 + i] = n == 4000 || has_second ? 100. : 0.;
      const auto m = separation::simulate(sensor, a, rate_hz);
      for (std::size_t i = 0; i < n; ++i)
        text += signals::to_text(double(i) / rate_hz + (n == 2000 ? 100. : 0.)) + "," +
                signals::to_text(a[i] + 1e-3 * normal(random)) + "," +
                signals::to_text(m[i] + 1e-9 * normal(random)) + "\n";
    }
    std::ofstream(file) << text;
    const auto found =
        vibrissa("identify '" + file + "' --order 2 -o '" + folder.file("m.json") + "'");
    ASSERT_EQ(found.status, 0) << found.errors;
    EXPECT_EQ(found.output.find("record a second hit") == std::string::npos, has_second)
        << found.output;
    EXPECT_EQ(found.output.find("other piece of the file") != std::string::npos, has_second);
  }
}

TEST(Identify, TakesAColumnWithoutCalibrationForFrequencyAndDamping) {
  const Folder folder;
  const std::string record = folder.file("hall.csv");
  std::string text = "time_s,hall\n";
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 8000; ++i) {
    const double t = i / 500.;
    const double decay = 50. * std::exp(-0.02 * 2. * std::numbers::pi * 31. * t);
    text += signals::to_text(t) + "," +
            signals::to_text(decay * std::cos(2. * std::numbers::pi * 31. * t) +
                             0.01 * normal(random)) +
            "\n";
  }
  std::ofstream(record) << text;
  const std::string column = " --column 'base_moment=hall[uT]' ";
  for (const std::string way : {"--output-only", "--ring-down"}) {
    const auto found = vibrissa("identify '" + record + "'" + column + way);
    EXPECT_EQ(found.status, 0) << found.errors;
    EXPECT_THAT(found.errors, HasSubstr("amplitudes are in uT"));
    EXPECT_THAT(found.output, HasSubstr(way == "--ring-down" ? " uT: " : "31.0"));
    EXPECT_THAT(found.output, Not(HasSubstr("N m")));
  }
  EXPECT_EQ(vibrissa("identify '" + record + "'" + column).status, 2);
  const json found = vibrissa("identify '" + record + "' --ring-down --json" + column).json();
  EXPECT_EQ(found["unit"], "uT");
  EXPECT_NEAR(found["fitted"].front()["amplitude"].get<double>(), 35., 15.);
  EXPECT_NEAR(found["error_rms"].get<double>(), 0.01, 1e-3);
  EXPECT_NEAR(found["noise_rms"].get<double>(), 0.01, 5e-3);
  EXPECT_THAT(found.dump(), Not(HasSubstr("n_m")));
}

TEST(Separate, NeitherReplacesARecordingNorTrustsADeadAccelerometer) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  signals::Record dead = measured(3000);
  signals::write_record(record, dead);
  const std::string before = content(record);
  for (const std::string stream : {"", " --stream"}) {
    const auto result = vibrissa("separate '" + record + "' -o '" + record + "'" + stream);
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.errors, HasSubstr("is not overwritten"));
  }
  EXPECT_EQ(vibrissa("convert '" + record + "' '" + record + "'").status, 2);
  for (const std::string option : {"-o", "--c-header"})
    EXPECT_EQ(vibrissa("identify '" + record + "' " + option + " '" + record + "'").status, 2);
  EXPECT_EQ(vibrissa("bode '" + record + "' --response '" + record + "'").status, 2);
  EXPECT_EQ(vibrissa("simulate '" + record + "' -o '" + record + "'").status, 2);
  const std::string both = " '" + folder.file("new.json") + "'";
  EXPECT_EQ(vibrissa("identify '" + record + "' -o" + both + " --c-header" + both).status, 2);
  EXPECT_EQ(vibrissa("convert '" + record + "' '" + folder.file("r.xlsx") + "'").status, 2);
  EXPECT_EQ(content(record), before);
  dead.set_channel(signals::channel::base_acceleration, std::vector<double>(3000, 0.));
  signals::write_record(record, dead);
  const auto result = vibrissa("separate '" + record + "'");
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.errors, HasSubstr("base_acceleration_m_s2 is constant at 0"));
}

TEST(Identify, RefusesOrdersThatAreNone) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  signals::write_record(record, measured(300));
  for (const std::string option : {"--order -2", "--order 1000", "--period -1", "--lags -1"}) {
    const auto result = vibrissa("identify '" + record + "' " + option);
    EXPECT_EQ(result.status, 2) << option;
    EXPECT_LT(result.errors.size(), 200u) << result.errors;
  }
}

void write_moment_alone(const std::string& file, std::size_t n_samples) {
  const auto both = measured(n_samples);
  signals::Record moment_alone(rate_hz, both.n_samples());
  const auto m = both.channel(signals::channel::base_moment);
  moment_alone.set_channel(signals::channel::base_moment, {m.begin(), m.end()});
  signals::write_record(file, moment_alone);
}

/// A response of one mode that states this unit.
std::string response_csv(const std::string& unit) {
  const separation::Bvrm truth{.modes = {separation::make_modal_term(31., 0.05, 2.)}};
  std::ostringstream csv;
  csv << "frequency_hz,response_real [" << unit << "],response_imaginary [" << unit << "]\n";
  for (int k = 1; k <= 200; ++k) {
    const std::vector<double> f = {0.5 * k};
    const auto value = separation::response(truth, f)[0];
    csv << f[0] << "," << value.real() << "," << value.imag() << "\n";
  }
  return csv.str();
}

TEST(Identify, GivesGainsInTheUnitOfTheResponse) {
  const Folder folder;
  const auto identified = [&](const std::string& unit, const std::string& options) {
    const std::string file = folder.write("h.csv", response_csv(unit));
    return vibrissa("identify '" + file + "' --order 2 --frequency-response " + options + " -o '" +
                    folder.file("m.json") + "'");
  };
  const auto rotation = identified("rad/(m/s^2)", "");
  ASSERT_EQ(rotation.status, 0) << rotation.errors;
  EXPECT_THAT(rotation.output, AllOf(HasSubstr("static gain [rad/(m/s^2)]"),
                                     HasSubstr(" rad/(m/s^2); order 2"), Not(HasSubstr("kg m"))));
  const json found = identified("rad/(m/s^2)", "--json").json();
  EXPECT_EQ(found["gain_unit"], "rad/(m/s^2)");
  EXPECT_NEAR(found["modes"][0]["static_gain"].get<double>(), 2., 1e-3);
  EXPECT_FALSE(found["modes"][0].contains("static_gain_kg_m"));
  EXPECT_THAT(identified("N m s^2/m", "").output, HasSubstr("static gain [kg m]"));
  EXPECT_EQ(identified("N m s^2/m", "--json").json()["gain_unit"], "kg m");
}

TEST(Identify, FindsResonanceAndDampingWithoutAnyInputChannel) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  write_moment_alone(record, 30000);
  const auto result = vibrissa("identify '" + record + "' --output-only --json");
  ASSERT_EQ(result.status, 0) << result.errors;
  const json found = result.json();
  ASSERT_EQ(found["modes"].size(), 1u);
  const json& mode = found["modes"][0];
  EXPECT_NEAR(mode["frequency_hz"].get<double>(), 31.47,
              4. * mode["frequency_sd_hz"].get<double>());
  EXPECT_NEAR(mode["damping_ratio"].get<double>(), 0.027, 4. * mode["damping_sd"].get<double>());
  EXPECT_LT(mode["damping_sd"].get<double>(), 0.01);
  EXPECT_THAT(found["words"].get<std::string>(), HasSubstr("no gain and no direct term"));
  const auto text = vibrissa("identify '" + record + "' --output-only");
  EXPECT_THAT(text.output, HasSubstr("damping ratio"));
}

TEST(Identify, GivesTheDampingOfADecayAgainstItsAmplitude) {
  const Folder folder;
  const std::string record = folder.file("flick.csv");
  signals::Record moment_alone(500., 2000);
  std::vector<double> moment(2000);
  for (std::size_t i = 100; i < moment.size(); ++i) {
    const double angle = 2. * std::numbers::pi * 31. * static_cast<double>(i - 100) / 500.;
    moment[i] = 1e-4 * std::exp(-0.02 * angle) * std::sin(angle) + (i % 2 == 0 ? 1e-7 : -1e-7);
  }
  moment_alone.set_channel(signals::channel::base_moment, moment);
  signals::write_record(record, moment_alone);
  const json found = vibrissa("identify '" + record + "' --ring-down --json").json();
  EXPECT_NEAR(found["law"]["frequency_hz"].get<double>(), 31. * std::hypot(1., 0.02), 0.01);
  EXPECT_NEAR(found["fitted"].back()["damping_ratio"].get<double>(), 0.02, 2e-4);
  EXPECT_EQ(found["damping_laws"], json({"viscous"}));
  const std::string out = folder.file("out");
  const auto text = vibrissa("identify '" + record + "' --ring-down -o '" + out + "'");
  EXPECT_THAT(text.output, HasSubstr("The damping is viscous"));
  EXPECT_THAT(text.output, HasSubstr("without a law"));
  EXPECT_EQ(json::parse(content(out + "/ring_down.json")), found);
  EXPECT_TRUE(std::filesystem::exists(out + "/figures/ring_down.png"));
  // The envelope meets the sine's own at its end: 1e-4 exp(-0.02 angle).
  const json figure = json::parse(content(out + "/figures/ring_down.json"));
  ASSERT_EQ(figure["panels"].size(), 3u);
  const json& upper = figure["panels"][0]["curves"][1];
  const double t = upper["x"].back().get<double>() - 0.2;
  EXPECT_NEAR(upper["y"].back().get<double>(),
              1e-4 * std::exp(-0.02 * 2. * std::numbers::pi * 31. * t), 2e-8);
  // All points of both panels have their interval.
  for (const int panel : {1, 2}) {
    const json& curves = figure["panels"][panel]["curves"];
    EXPECT_EQ(curves[0]["y_low"].size(), found["fitted"].size());
    EXPECT_EQ(curves[2]["x"].size(), 3 * found["measured"].size());
  }
  const auto again = vibrissa("identify '" + record + "' --ring-down -o '" + out + "'");
  EXPECT_EQ(again.status, 2);
}

TEST(Identify, OffersTheOutputAloneWhereTheInputIsMissing) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  write_moment_alone(record, 500);
  const auto result = vibrissa("identify '" + record + "'");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("--output-only"));
}

TEST(Identify, RefusesWithoutAnInputWhatNeedsOne) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  signals::write_record(record, measured(500));
  for (const std::string option : {"-o model.json", "--c-header model.h", "--method srivc",
                                   "--hold zero_order", "--period 100", "--no-direct-term"}) {
    const auto result = vibrissa("identify '" + record + "' --output-only " + option);
    EXPECT_EQ(result.status, 2) << option;
    EXPECT_THAT(result.errors, HasSubstr("needs the base acceleration"));
  }
}

/// A moment of a mode with a cubic spring.
signals::Record measured_on_a_hard_joint(const std::size_t n) {
  separation::NonlinearBvrm model{
      .linear = {},
      .mode = 0,
      .law = {{.kind = separation::LawKind::cubic_stiffness, .coefficient = 3e10}}};
  model.linear.modes = {separation::make_modal_term(31.47, 0.027, -9e-6)};
  model.largest_deflection_m = model.largest_speed_m_s = 1.;
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  std::vector<double> a(n);
  for (double& x : a) x = 3. * normal(random);
  auto moment = separation::simulate(model, a, rate_hz, separation::Hold::first_order);
  for (double& m : moment) m += 1e-8 * normal(random);
  signals::Record record(rate_hz, n);
  record.set_channel(signals::channel::base_acceleration, std::move(a));
  record.set_channel(signals::channel::base_moment, std::move(moment));
  return record;
}

TEST(Identify, NonlinearGivesAModelThatSeparateTakesAlsoAsStream) {
  const Folder folder;
  const std::string record = quoted(folder.file("r.csv")), model = quoted(folder.file("m.json"));
  signals::write_record(folder.file("r.csv"), measured_on_a_hard_joint(6000));
  const auto result =
      vibrissa("identify " + record + " --nonlinear --hold first_order --c-header " +
               quoted(folder.file("m.h")) + " -o " + model + " --json");
  ASSERT_EQ(result.status, 0) << result.errors;
  const json found = result.json();
  ASSERT_EQ(found["law"].size(), 1u) << found.dump(1);
  EXPECT_EQ(found["law"][0]["term"], "cubic_stiffness");
  EXPECT_NEAR(found["law"][0]["coefficient"].get<double>(), 3e10,
              3. * found["law"][0]["coefficient_sd"].get<double>());
  EXPECT_THAT(content(folder.file("m.h")), HasSubstr("law of mode 1: cubic_stiffness"));
  const auto text = vibrissa("identify " + record + " --nonlinear --hold first_order -o " + model);
  EXPECT_THAT(text.output, HasSubstr("the record asks for cubic_stiffness"));
  const json bode = vibrissa("bode " + model + " --low 20 --high 50 --json").json();
  EXPECT_THAT(bode["words"].get<std::string>(), HasSubstr("small amplitude"));
  const auto& points = bode["points"];
  const auto peak = std::ranges::max_element(points, {}, [](const json& point) {
    return std::hypot(point["real"].get<double>(), point["imaginary"].get<double>());
  });
  EXPECT_NEAR((*peak)["frequency_hz"].get<double>(), 31.47, 0.1);
  for (const std::string stream : {"", " --stream"}) {
    const std::string output = folder.file("s" + std::to_string(stream.size()) + ".csv");
    const auto separated = vibrissa("separate " + record + " --model " + model + stream +
                                    " --quiet -o " + quoted(output));
    ASSERT_EQ(separated.status, 0) << separated.errors;
  }
  EXPECT_EQ(content(folder.file("s0.csv")), content(folder.file("s9.csv")));
}

TEST(Identify, NonlinearRefusesWhatItCannotUse) {
  const Folder folder;
  const std::string record = quoted(folder.file("r.csv"));
  signals::write_record(folder.file("r.csv"), measured(70));
  const auto short_record = vibrissa("identify " + record + " --nonlinear --order 6");
  EXPECT_EQ(short_record.status, 2);
  EXPECT_THAT(short_record.errors, HasSubstr("too few"));
  const auto method = vibrissa("identify " + record + " --nonlinear --method srivc");
  EXPECT_EQ(method.status, 2);
  EXPECT_THAT(method.errors, HasSubstr("--method is not used by --nonlinear"));
  const auto output_only = vibrissa("identify " + record + " --nonlinear --output-only");
  EXPECT_EQ(output_only.status, 2);
  EXPECT_THAT(output_only.errors, HasSubstr("--nonlinear"));
}

}  // namespace
}  // namespace vibrissa::apps
