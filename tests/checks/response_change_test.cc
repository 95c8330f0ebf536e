#include "checks/response_change.h"

#include <gmock/gmock.h>

#include "tests/checks/record_generator.h"

namespace vibrissa::checks {
namespace {

using test::Drive;

// A thousandth of stationary records may be called changing: of 60, three have a chance of 3e-5.
TEST(ResponseChange, IsRareInStationaryRecords) {
  std::size_t n_found = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed)
    n_found += response_change(test::good_record(Drive::random, 5000 + seed)).has_value();
  EXPECT_LE(n_found, 2u);
}

TEST(ResponseChange, IsFoundWhereTheMountCameLoose) {
  std::size_t n_found = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    n_found +=
        response_change(test::bad_record(test::Fault::changing, 6000 + seed).record).has_value();
  EXPECT_GE(n_found, 15u);
}

}  // namespace
}  // namespace vibrissa::checks
