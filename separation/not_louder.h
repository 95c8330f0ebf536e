#pragma once

#include <memory>
#include <vector>

#include "separation/filters/separator.h"

namespace vibrissa::separation {

/// Keeps a separator from making a quiet stretch louder. Vibration and wind are not correlated, so
/// the moment without its vibration is never louder than the moment. Where the running power of
/// the wind estimate exceeds that of the moment, the vibration estimate v of the separator does not
/// fit there (its filter was adapted to a louder stretch) and is scaled by the gain that leaves the
/// least running power, g = mean(M v) / mean(v^2) between 0 and 1. The running means are
/// exponential with the given time constant. Same latency, name and units as the separator within.
/// Proven by tests/separation/not_louder_test.cc.
class NotLouder : public Separator {
 public:
  NotLouder(std::unique_ptr<Separator> within, std::size_t memory_samples);

  void process(std::span<const double> base_acceleration, std::span<const double> base_moment,
               std::span<double> wind_moment) override;
  void reset() override;
  std::string name() const override { return within_->name(); }
  std::size_t latency_samples() const override { return within_->latency_samples(); }

 private:
  /// Sums of M^2, (M - v)^2, v^2 and M v.
  struct Powers {
    double moment = 0., wind = 0., vibration = 0., cross = 0.;
  };
  double calmed(double moment, double wind);

  std::unique_ptr<Separator> within_;
  std::size_t half_memory_, n_recent_ = 0;
  std::vector<double> late_moment_;  // ring of the last moments, as many as the latency
  std::size_t oldest_ = 0;
  std::vector<double> block_;  // moments of the samples at work
  Powers recent_, before_;     // the last n_recent_ samples, and half the memory before them
};

}  // namespace vibrissa::separation
