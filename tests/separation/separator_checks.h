#pragma once

#include <gmock/gmock.h>

#include <string>

#include "separation/filters/separator.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation::test {

/// The wind moment that a separator finds, in one go.
inline Signal run(Separator& separator, const Signal& base_acceleration,
                  const Signal& base_moment) {
  Signal wind(base_moment.size());
  separator.process(base_acceleration, base_moment, wind);
  return wind;
}

inline void expect_wind_unchanged_when_the_base_rests(Separator& separator) {
  const Signal wind = white_noise(1000, 1., 14);
  EXPECT_EQ(run(separator, Signal(1000, 0.), wind), wind);
}

/// That a separator cannot be made with these options, and why.
template <typename Method, typename Options>
void expect_refusal(const Options& options, const std::string& message) {
  EXPECT_THAT([&] { Method method(options); },
              testing::ThrowsMessage<signals::UserError>(testing::HasSubstr(message)));
}

}  // namespace vibrissa::separation::test
