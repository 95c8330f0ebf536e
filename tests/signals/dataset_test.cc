#include "signals/dataset.h"

#include <gmock/gmock.h>

#include <cmath>

#include "signals/error.h"
#include "temporary_folder.h"

namespace vibrissa::signals {
namespace {

using testing::HasSubstr;

std::string csv(bool base, bool wind, std::size_t n = 128) {
  std::string text = "time_s,base_acceleration_m_s2,wind_speed_m_s,base_moment_N_m\n";
  for (std::size_t i = 0; i < n; ++i) {
    const double x = std::sin(0.7 * static_cast<double>(i));
    text += std::to_string(0.002 * static_cast<double>(i)) + "," + std::to_string(base ? x : 0.) +
            "," + std::to_string(wind ? 2. + x : 0.) + "," + std::to_string(x) + "\n";
  }
  return text;
}

class DatasetFolder : public testing::Test {
 protected:
  DatasetFolder() {
    folder_.file("a.csv", csv(true, false));
    folder_.file("b.csv", csv(true, true));
  }
  void describe(const std::string& entries, const std::string& more = "") {
    folder_.file("dataset.json", R"({"schema": "vibrissa-dataset-1", "sampling_rate_hz": 500)" +
                                     more + R"(, "records": [)" + entries + "]}");
  }
  void expect_refused(const std::string& entries, const std::string& why) {
    describe(entries);
    expect_error(why);
  }
  void expect_error(const std::string& why) {
    try {
      read_dataset(folder_.path());
      FAIL() << "was accepted; expected: " << why;
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), HasSubstr(why));
    }
  }
  testing::TemporaryFolder folder_;
};

}  // namespace
}  // namespace vibrissa::signals
