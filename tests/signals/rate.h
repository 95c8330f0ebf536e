#pragma once

namespace vibrissa::signals::test {

/// Sampling rate of the reference study's records.
inline constexpr double rate_hz = 500.;

}  // namespace vibrissa::signals::test
