#include "separation/filters/line_canceller.h"

#include <cassert>

#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

std::size_t checked_delay(const LineCancellerOptions& options) {
  if (options.delay_samples == 0)
    throw signals::UserError(
        "line canceller: delay_samples = 0 must be at least 1; without a delay the filter predicts "
        "the moment from itself and removes all of it");
  return options.delay_samples;
}

}  // namespace

LineCanceller::LineCanceller(const LineCancellerOptions& options)
    : past_(checked_delay(options)), lms_(options.lms, "line canceller") {}

void LineCanceller::process([[maybe_unused]] std::span<const double> base_acceleration,
                            std::span<const double> base_moment, std::span<double> wind_moment) {
  assert(base_acceleration.size() == wind_moment.size());
  assert(base_moment.size() == wind_moment.size());
  for (std::size_t i = 0; i < wind_moment.size(); ++i) {
    const double moment = base_moment[i];
    const double delayed = past_.samples()[past_.samples().size() - 1];
    past_.push(moment);
    wind_moment[i] = lms_.step(delayed, moment);
  }
}

void LineCanceller::reset() {
  past_.clear();
  lms_.clear();
}

}  // namespace vibrissa::separation
