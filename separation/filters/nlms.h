#pragma once

#include <string>
#include <vector>

#include "separation/filters/normalised_lms.h"
#include "separation/filters/separator.h"

namespace vibrissa::separation {

/// Normalised LMS filter from base acceleration to base moment: the reference method in the time
/// domain, without latency. See NormalisedLms. Proven by tests/separation/filters/nlms_test.cc.
class Nlms : public Separator {
 public:
  /// Throws UserError for options out of range, with the option's name.
  explicit Nlms(const NlmsOptions& options) : lms_(options, "NLMS filter") {}

  void process(std::span<const double> base_acceleration, std::span<const double> base_moment,
               std::span<double> wind_moment) override;
  void reset() override { lms_.clear(); }
  std::string name() const override { return "NLMS"; }
  std::size_t latency_samples() const override { return 0; }
  std::vector<double> impulse_response() const { return {lms_.taps().begin(), lms_.taps().end()}; }

 private:
  NormalisedLms lms_;
};

}  // namespace vibrissa::separation
