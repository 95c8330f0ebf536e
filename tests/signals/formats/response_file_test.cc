#include "signals/files/response_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "signals/base/error.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals::formats {
namespace {

using signals::test::TemporaryFolder;
using ::testing::HasSubstr;

FrequencyResponse response_at(const std::vector<double>& frequency_hz) {
  FrequencyResponse response{
      .frequency_hz = frequency_hz, .value = {}, .coherence = {}, .standard_deviation = {}};
  for (const double f : frequency_hz)
    response.value.push_back(-2e-5 / std::complex<double>(1. - f * f / 1400., 0.1 * f / 37.));
  return response;
}

void expect_equal(const Uff58Function& function, const FrequencyResponse& response) {
  EXPECT_EQ(function.function_type, 4);
  EXPECT_TRUE(function.is_complex);
  EXPECT_EQ(function.abscissa_axis.quantity, 18);
  EXPECT_EQ(function.denominator_axis.quantity, 12);
  EXPECT_THAT(function.id_lines[1], HasSubstr("exp(+j w t)"));
  ASSERT_EQ(function.values.size(), response.value.size());
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    EXPECT_LT(std::abs(function.values[i] - response.value[i]),
              1e-12 * std::abs(response.value[i]));
    const double f = function.abscissa.empty()
                         ? function.abscissa_start + static_cast<double>(i) * function.abscissa_step
                         : function.abscissa[i];
    EXPECT_NEAR(f, response.frequency_hz[i], 2e-5 * response.frequency_hz[i]) << i;
  }
}

/// The one function that a file of this name holds.
Uff58Function written(const FrequencyResponse& response, const std::string& file,
                      const std::string& name) {
  const TemporaryFolder folder;
  write_response(folder.path() / file, response, name);
  const auto functions = read_uff58(folder.path() / file);
  EXPECT_EQ(functions.size(), 1U);
  return functions.empty() ? Uff58Function{} : functions.front();
}

TEST(ResponseFile, OfEvenLinesIsAFunctionOfType4WithAnEvenAbscissa) {
  const auto response = response_at({2., 4., 6., 8., 10., 12.});
  const Uff58Function function = written(response, "r.uff", "bench");
  EXPECT_EQ(function.id_lines[0], "bench");
  EXPECT_TRUE(function.abscissa.empty());
  EXPECT_DOUBLE_EQ(function.abscissa_step, 2.);
  expect_equal(function, response);
}

TEST(ResponseFile, KeepsUnevenFrequencies) {
  const auto response = response_at({1., 3.1623, 10., 31.623, 37.3, 200.});
  const Uff58Function function = written(response, "r.unv", "model");
  EXPECT_EQ(function.abscissa.size(), 6U);
  expect_equal(function, response);
}

FrequencyResponse of_a_bench() {
  std::vector<double> f;
  for (int i = 1; i < 400; ++i) f.push_back(500. / 2048. * i);
  FrequencyResponse response = response_at(f);
  for (std::size_t i = 0; i < f.size(); ++i) {
    response.coherence.push_back(1. - 0.001 * static_cast<double>(i));
    response.standard_deviation.push_back(1e-7 * (1. + static_cast<double>(i)));
  }
  return response;
}

class EveryResponseFile : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Endings, EveryResponseFile, ::testing::Values("r.uff", "r.mat", "r.csv"));

TEST_P(EveryResponseFile, KeepsFrequenciesCoherenceAndDeviation) {
  const FrequencyResponse response = of_a_bench();
  const TemporaryFolder folder;
  write_response(folder.path() / GetParam(), response, "bench");
  const FrequencyResponse back = read_response(folder.path() / GetParam());
  ASSERT_EQ(back.value.size(), response.value.size());
  ASSERT_EQ(back.coherence.size(), response.value.size());
  ASSERT_EQ(back.standard_deviation.size(), response.value.size());
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    EXPECT_NEAR(back.frequency_hz[i], response.frequency_hz[i], 1e-13 * response.frequency_hz[i]);
    EXPECT_LT(std::abs(back.value[i] - response.value[i]), 1e-12 * std::abs(response.value[i]));
    EXPECT_NEAR(back.coherence[i], response.coherence[i], 1e-12);
    EXPECT_NEAR(back.standard_deviation[i], response.standard_deviation[i], 1e-18);
  }
}

TEST(ResponseFile, StatesItsConventionInCsv) {
  const TemporaryFolder folder;
  write_response(folder.path() / "r.csv", of_a_bench(), "bench");
  std::ifstream in(folder.path() / "r.csv");
  std::string line;
  std::getline(in, line);
  EXPECT_THAT(line, ::testing::AllOf(HasSubstr("# "), HasSubstr("exp(+j w t), one-sided, Hz")));
}

TEST(ResponseFile, LeavesOutWhatIsNotKnownOfEveryLine) {
  FrequencyResponse response = of_a_bench();
  response.coherence[7] = std::nan("");
  const auto functions = uff58_of(response, "bench");
  ASSERT_EQ(functions.size(), 2U);
  EXPECT_EQ(functions[1].function_type, general_function);
}

TEST(ResponseFile, RefusesAnUnknownEndOfTheName) {
  EXPECT_THAT([] { write_response("r.xlsx", response_at({1.}), "x"); },
              ::testing::ThrowsMessage<UserError>(
                  ::testing::AllOf(HasSubstr("r.xlsx"), HasSubstr(".uff"), HasSubstr(".mat"))));
}

}  // namespace
}  // namespace vibrissa::signals::formats
