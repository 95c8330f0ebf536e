#pragma once

#include <span>
#include <string>

namespace vibrissa::signals {

/// Throws UserError that begins with the task unless the sampling rate is positive and the channel
/// finite.
void check_channel(const std::string& task, std::span<const double> x, const std::string& name,
                   double sampling_rate_hz);

/// Throws UserError that begins with the task unless the sampling rate is positive and both
/// channels are equally long and finite. Proven by tests/signals/spectra/local_polynomial_test.cc.
void check_channels(const std::string& task, std::span<const double> input,
                    std::span<const double> output, double sampling_rate_hz);

}  // namespace vibrissa::signals
