#include "separation/stream_methods.h"

#include "separation/filters/kalman_filter.h"
#include "separation/filters/line_canceller.h"
#include "separation/filters/nlms.h"
#include "separation/filters/rls.h"
#include "separation/not_louder.h"
#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

using Made = std::unique_ptr<Separator>;

Made make_kalman(const FdafOptions& options) {
  KalmanOptions kalman;
  kalman.block_length = options.block_length;
  kalman.filter_length = options.filter_length;
  return std::make_unique<PartitionedKalman>(kalman);
}

Made make_nlms(const FdafOptions& options) {
  NlmsOptions nlms;
  nlms.filter_length = options.filter_length;
  return std::make_unique<Nlms>(nlms);
}

using Make = std::function<Made(const FdafOptions&)>;

// The running means span the memory of the filter.
Make not_louder(const Make& make) {
  return [make](const FdafOptions& options) -> Made {
    return std::make_unique<NotLouder>(make(options), options.filter_length + options.block_length);
  };
}

}  // namespace

const std::vector<StreamMethod>& stream_methods() {
  static const std::vector<StreamMethod> methods = {
      {"fdaf", "partitioned frequency-domain adaptive filter",
       not_louder([](const FdafOptions& o) -> Made { return std::make_unique<Fdaf>(o); })},
      {"kalman", "partitioned frequency-domain Kalman filter", not_louder(make_kalman)},
      {"nlms", "normalised least mean squares in the time domain", not_louder(make_nlms)},
      {"rls", "recursive least squares, 64 taps",
       not_louder([](const FdafOptions&) -> Made { return std::make_unique<Rls>(RlsOptions{}); })},
      {"line_canceller",
       "removes steady tones, which it predicts from the past of the moment; needs no "
       "accelerometer",
       not_louder([](const FdafOptions&) -> Made {
         return std::make_unique<LineCanceller>(LineCancellerOptions{});
       })}};
  return methods;
}

const StreamMethod& stream_method(const std::string& name) {
  std::string known;
  for (const auto& method : stream_methods()) {
    if (method.name == name) return method;
    known += (known.empty() ? "" : ", ") + method.name;
  }
  throw signals::UserError("unknown separation method '" + name + "'; known: " + known);
}

}  // namespace vibrissa::separation
