#include "signals/base/unit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// From, to, scale: definitions of the International System and of the international mile and pound.
class Converts : public ::testing::TestWithParam<std::tuple<const char*, const char*, double>> {};

TEST_P(Converts, ByTheDefinitionOfTheUnit) {
  const auto& [from, to, scale] = GetParam();
  const UnitConversion conversion = convert_unit(from, to);
  EXPECT_NEAR(conversion.scale, scale, 1e-14 * scale) << from << " to " << to;
  EXPECT_EQ(conversion.offset, 0.);
}

INSTANTIATE_TEST_SUITE_P(
    Unit, Converts,
    ::testing::Values(std::tuple("g", "m/s2", 9.80665), std::tuple("mg", "m/s^2", 9.80665e-3),
                      std::tuple("g", "kg", 1e-3), std::tuple("mN mm", "N m", 1e-6),
                      std::tuple("Nmm", "N m", 1e-3), std::tuple("uNm", "N m", 1e-6),
                      std::tuple("N*m", "N m", 1.), std::tuple("\u00b5T", "T", 1e-6),
                      std::tuple("km/h", "m/s", 1. / 3.6), std::tuple("mph", "m/s", 0.44704),
                      std::tuple("m/s\u00b2", "m/s2", 1.), std::tuple("mm/s2", "m/s2", 1e-3),
                      std::tuple("mV", "V", 1e-3), std::tuple("ms", "s", 1e-3),
                      std::tuple("(uT).(N m/T)", "N m", 1e-6),
                      std::tuple("deg", "rad", 0.0174532925199432958), std::tuple("%", "1", 0.01)));

TEST(Unit, TemperaturesHaveAnOffset) {
  const UnitConversion conversion = convert_unit("degC", "K");
  EXPECT_DOUBLE_EQ(conversion.scale, 1.);
  EXPECT_NEAR(conversion.offset, 273.15, 1e-10);
}

TEST(Unit, RefusesWhatItDoesNotKnowAndWhatDoesNotFit) {
  EXPECT_THAT([] { convert_unit("furlongs per x", "m/s"); },
              ThrowsMessage<UserError>(HasSubstr("unit 'furlongs per x' is not known")));
  EXPECT_THAT([] { convert_unit("uT", "N m"); },
              ThrowsMessage<UserError>(HasSubstr("'uT' cannot be converted to 'N m'")));
  EXPECT_THROW(convert_unit("g", "N m"), UserError);
  EXPECT_THROW(convert_unit("((", "m"), UserError);
}

}  // namespace
}  // namespace vibrissa::signals
