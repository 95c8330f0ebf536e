#include "signals/spectra/channel_check.h"

#include <algorithm>
#include <cmath>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::signals {
namespace {

void check_finite(const std::string& task, std::span<const double> x, const std::string& name) {
  const auto bad = std::ranges::find_if_not(x, [](double value) { return std::isfinite(value); });
  if (bad != x.end())
    throw UserError(task + ": sample " + std::to_string(bad - x.begin()) + " of the " + name +
                    " is not finite");
}

}  // namespace

void check_channel(const std::string& task, std::span<const double> x, const std::string& name,
                   double sampling_rate_hz) {
  if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
    throw UserError(task + ": sampling rate " + to_text(sampling_rate_hz) +
                    " Hz is not positive and finite");
  check_finite(task, x, name);
}

void check_channels(const std::string& task, std::span<const double> input,
                    std::span<const double> output, double sampling_rate_hz) {
  check_channel(task, input, "input", sampling_rate_hz);
  if (input.size() != output.size())
    throw UserError(task + ": input has " + std::to_string(input.size()) + " samples, output " +
                    std::to_string(output.size()));
  check_finite(task, output, "output");
}

}  // namespace vibrissa::signals
