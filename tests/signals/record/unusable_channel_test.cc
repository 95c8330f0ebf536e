#include "signals/record/unusable_channel.h"

#include <gmock/gmock.h>

#include <cmath>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

Record record_of(std::vector<double> x) {
  Record record(500., x.size());
  record.set_channel("x_m_s2", std::move(x));
  return record;
}

TEST(UnusableChannel, IsOneThatIsConstantOrNotFinite) {
  EXPECT_FALSE(unusable_channel(record_of({1., 2., 1.}), "x_m_s2"));
  const auto constant = unusable_channel(record_of({-0., -0., -0.}), "x_m_s2");
  ASSERT_TRUE(constant);
  EXPECT_TRUE(constant->is_constant);
  EXPECT_EQ(constant->reason, "is constant at 0");
  const auto bad = unusable_channel(record_of({1., 2., 3., std::nan("")}), "x_m_s2");
  ASSERT_TRUE(bad);
  EXPECT_FALSE(bad->is_constant);
  EXPECT_EQ(bad->reason, "is not finite at sample 3 (0.006 s)");
  EXPECT_THROW(unusable_channel(record_of({1., 2.}), "y_m_s2"), UserError);
}

}  // namespace
}  // namespace vibrissa::signals
