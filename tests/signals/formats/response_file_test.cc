#include "signals/formats/response_file.h"

#include <gmock/gmock.h>

#include <cmath>

#include "signals/error.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals::formats {
namespace {

using signals::testing::TemporaryFolder;
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

TEST(ResponseFile, RefusesAnUnknownEndOfTheName) {
  EXPECT_THAT([] { write_response("r.xlsx", response_at({1.}), "x"); },
              ::testing::ThrowsMessage<UserError>(
                  ::testing::AllOf(HasSubstr("r.xlsx"), HasSubstr(".uff"), HasSubstr(".mat"))));
}

}  // namespace
}  // namespace vibrissa::signals::formats
