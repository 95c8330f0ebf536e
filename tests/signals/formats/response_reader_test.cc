#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "signals/base/error.h"
#include "signals/files/response_file.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals::formats {
namespace {

using signals::test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

FrequencyResponse sensor_response() {
  FrequencyResponse response;
  for (int i = 1; i <= 40; ++i) {
    const double f = 2.5 * i;
    response.frequency_hz.push_back(f);
    response.value.push_back(-2e-5 / std::complex<double>(1. - f * f / 1400., 0.1 * f / 37.));
    response.coherence.push_back(1. - 1e-3 * i);
    response.standard_deviation.push_back(1e-8 * i / 3.);
  }
  return response;
}

class ResponseReader : public ::testing::Test {
 protected:
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }
  void expect_refusal(const std::filesystem::path& source, const ResponseChoice& choice,
                      const std::string& first, const std::string& second) const {
    EXPECT_THAT([&] { read_response(source, choice); },
                ThrowsMessage<UserError>(AllOf(HasSubstr(first), HasSubstr(second))));
  }
  /// A universal file of two functions in mN mm per g.
  std::filesystem::path two_functions() const {
    Uff58Function first = uff58_of(sensor_response(), "at the base").front();
    first.ordinate_axis.unit = "mN mm";
    first.denominator_axis.unit = "g";
    Uff58Function second = first;
    second.id_lines[0] = "at the tip";
    for (auto& value : second.values) value *= 2.;
    write_uff58(file("two.uff"), {first, second});
    return file("two.uff");
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(ResponseReader, ACoherenceAboveOneIsNone) {
  std::string text = "frequency_hz,response_real,response_imaginary,coh_2\n";
  for (int i = 1; i <= 20; ++i)
    text += std::to_string(i) + ",1,0.5," +
            (i == 1   ? "1.2462"
             : i == 2 ? "1.0000001"
                      : "0.9") +
            "\n";
  const FrequencyResponse found = read_response(write("above.csv", text), {""});
  ASSERT_EQ(found.coherence.size(), 20u);
  EXPECT_EQ(found.coherence[0], 0.);
  EXPECT_EQ(found.coherence[1], 1.);
  EXPECT_EQ(found.coherence[2], 0.9);
}

TEST_F(ResponseReader, GivesBackWhatIsWrittenToTheLastBitOrThirteenDigits) {
  const FrequencyResponse response = sensor_response();
  for (const std::string name : {"r.mat", "r.csv"}) {
    write_response(file(name), response, "bench");
    const FrequencyResponse found = read_response(file(name));
    EXPECT_EQ(found.frequency_hz, response.frequency_hz) << name;
    EXPECT_EQ(found.value, response.value) << name;
    EXPECT_EQ(found.coherence, response.coherence) << name;
    EXPECT_EQ(found.standard_deviation, response.standard_deviation) << name;
  }
  write_response(file("r.uff"), response, "bench");
  const FrequencyResponse found = read_response(file("r.uff"));
  ASSERT_EQ(found.value.size(), response.value.size());
  for (std::size_t i = 0; i < found.value.size(); ++i) {
    EXPECT_NEAR(found.frequency_hz[i], response.frequency_hz[i], 1e-5 * response.frequency_hz[i]);
    EXPECT_LT(std::abs(found.value[i] - response.value[i]), 1e-12 * std::abs(response.value[i]));
  }
}

TEST_F(ResponseReader, ReadsMagnitudeAndPhase) {
  const auto source = write("m.csv",
                            "frequency_hz,magnitude_n_m_s2_per_m,phase_deg\n"
                            "0,5,0\n10,2e-5,180\n20,4e-5,90\n");
  const FrequencyResponse found = read_response(source);
  ASSERT_EQ(found.value.size(), 2U) << "the line at 0 Hz is left out";
  EXPECT_LT(std::abs(found.value[0] - std::complex<double>(-2e-5, 0.)), 1e-19);
  EXPECT_LT(std::abs(found.value[1] - std::complex<double>(0., 4e-5)), 1e-19);
}

TEST_F(ResponseReader, TakesDecibelsForWhatTheyAre) {
  for (const std::string column : {"magnitude_dB", "magnitude_db", "magnitudeDB"}) {
    const auto response =
        read_response(write("m.csv", "frequency_hz," + column +
                                         ",phase_deg\n10,-20,90\n20,6.020599913279624,0\n"),
                      {});
    EXPECT_NEAR(response.value[0].imag(), 0.1, 1e-15) << column;
    EXPECT_NEAR(response.value[1].real(), 2., 1e-14) << column;
  }
}

TEST_F(ResponseReader, ConvertsUnitsOfTheFileAndThoseThatAreGiven) {
  const auto source = two_functions();
  const std::complex<double> expected = sensor_response().value[3] * 1e-6 / 9.80665;
  EXPECT_LT(std::abs(read_response(source, {"1"}).value[3] - expected), 1e-12 * std::abs(expected));
  const auto tip = read_response(source, {"at the tip[uT/g]*0.18[N m/T]"}).value[3];
  EXPECT_LT(std::abs(tip - 0.36 * expected), 1e-12 * std::abs(expected));
}

// 3 mN mm/g is 3e-6/9.80665 N m s^2/m, whatever the format that states it.
TEST_F(ResponseReader, ConvertsTheUnitThatATableStates) {
  for (const std::string head : {"f,H_real [mN mm/g],H_imaginary [mN mm/g]\n",
                                 "f,H_real,H_imaginary\nHz,mN mm/g,mN mm/g\n"}) {
    const auto found = read_response(write("u.csv", head + "1,3,0\n2,3,0\n3,3,0\n"), {"H"});
    EXPECT_NEAR(found.value[0].real(), 3e-6 / 9.80665, 1e-18) << head;
    EXPECT_EQ(found.unit, moment_per_acceleration);
    EXPECT_THAT(found.words, AllOf(HasSubstr("mN mm/g"), HasSubstr("converted to N m s^2/m")));
  }
  const auto magnitude =
      read_response(write("m.csv", "f,Magnitude [mN mm/g],Phase [deg]\n1,3,0\n2,3,0\n"));
  EXPECT_NEAR(magnitude.value[0].real(), 3e-6 / 9.80665, 1e-18);
  EXPECT_THAT(read_response(write("n.csv", "f,real,imaginary\n1,3,0\n")).words,
              HasSubstr("states no unit: taken as N m s^2/m"));
}

TEST_F(ResponseReader, KeepsAUnitOfAnotherQuantityThroughEveryFileThatStatesIt) {
  Uff58Function function = uff58_of(sensor_response(), "hammer").front();
  function.ordinate_axis.unit = "(1/N)*(m/s2)";
  function.denominator_axis.unit = "NONE";
  write_uff58(file("hammer.uff"), {function});
  expect_refusal(file("hammer.uff"), {}, "the response is in (1/N)*(m/s2)", "conversion factor");
  const ResponseChoice keep{.may_keep_unit = true};
  const FileResponse response = read_response(file("hammer.uff"), keep);
  for (const std::string name : {"again.csv", "again.uff"}) {
    write_response(file(name), response, "hammer", response.unit);
    const FileResponse found = read_response(file(name), keep);
    EXPECT_EQ(found.unit, "(1/N)*(m/s2)") << name;
    EXPECT_THAT(found.words, HasSubstr("not converted"));
    EXPECT_LT(std::abs(found.value[0] - sensor_response().value[0]), 1e-16);
  }
}

TEST_F(ResponseReader, RefusesWhatItCannotChooseOrConvert) {
  const auto source = two_functions();
  expect_refusal(source, {}, "1 'at the base', 2 'at the tip'", "choose one");
  expect_refusal(source, {"3"}, "has no response 3", "at the tip");
  expect_refusal(source, {"1[kg]"}, "cannot be converted", "moment per acceleration");
  Uff58Function bare = uff58_of(sensor_response(), "in teslas").front();
  bare.ordinate_axis.unit = "T";
  write_uff58(file("t.uff"), {bare});
  expect_refusal(file("t.uff"), {}, "in T/(m/s^2)", "0.18[N m/T]");
  expect_refusal(write("a.csv", "time_s,x\n0,1\n1,2\n"), {}, "a.csv",
                 "columns of the file: time_s, x");
  expect_refusal(write("b.csv", "f,x\n1,1\n2,2\n"), {}, "no response", "columns of the file: f, x");
  expect_refusal(write("c.csv", "f,real,imaginary\n1,1,1\n0.5,2,2\n"), {}, "c.csv: frequency 2",
                 "below");
  expect_refusal(write("d.csv", "f,real,imaginary\n1,1,1\n2,2,2\n"), {"H"}, "H_real",
                 "columns of the file: f");
  for (const char* nothing : {"f,real,imaginary\n", "f,real,imaginary\n0,1,1\n"})
    expect_refusal(write("e.csv", nothing), {}, "e.csv", "no line of a frequency response");
}

}  // namespace
}  // namespace vibrissa::signals::formats
