#include "signals/record/column_unit.h"

#include <gtest/gtest.h>

#include <string>

namespace vibrissa::signals {
namespace {

void expect_parts(const std::string& column, const std::string& name, const std::string& unit) {
  const NamedUnit found = split_unit(column);
  EXPECT_EQ(found.name, name) << column;
  EXPECT_EQ(found.unit, unit) << column;
}

TEST(SplitUnit, TakesBracketsStrokesAndEndings) {
  expect_parts("ax [g]", "ax", "g");
  expect_parts("ax (g)", "ax", "g");
  expect_parts("M (mN m)", "M", "mN m");
  expect_parts("ax/g", "ax", "g");
  expect_parts("ax_g", "ax", "g");
  expect_parts("M_mNm", "M", "mN.m");
  expect_parts("ax_m_s2", "ax", "m/s2");
  expect_parts("Moment [mNm]", "Moment", "mNm");
  expect_parts("Excitation (Volts)", "Excitation", "Volts");
}

TEST(SplitUnit, LeavesOtherNamesWhole) {
  for (const std::string name : {"ax", "m_1", "Dev0/Ai0", "timestamp (-0700)", "Response (Trigger)",
                                 "m/s", "[g]", "", "a_b_c"})
    expect_parts(name, name, "");
}

TEST(UnitOfRatio, BracketsAUnitOfSeveralParts) {
  EXPECT_EQ(unit_of_ratio("N m", "g"), "N m/g");
  EXPECT_EQ(unit_of_ratio("N m", "m/s2"), "N m/(m/s2)");
}

TEST(TimeName, IsKnownWithAndWithoutAUnit) {
  for (const std::string name :
       {"t", "Time (s)", "Zeit [s]", "timestamp (-0700)", "millis", "X_Value", "t_ms", "epoc (ms)"})
    EXPECT_TRUE(is_time_name(name)) << name;
  for (const std::string name : {"count", "ax", "m", "temperature", "tx"})
    EXPECT_FALSE(is_time_name(name)) << name;
  EXPECT_EQ(unit_of_time_name("millis"), "ms");
  EXPECT_EQ(unit_of_time_name("t"), "");
}

TEST(FrequencyName, IsKnownInAnySpelling) {
  for (const std::string name : {"frequency_hz", "Freq_domain", "Frequency [Hz]", " freq"})
    EXPECT_TRUE(is_frequency_name(name)) << name;
  for (const std::string name : {"f", "time", "base_acceleration_m_s2", "infrequent"})
    EXPECT_FALSE(is_frequency_name(name)) << name;
}

}  // namespace
}  // namespace vibrissa::signals
