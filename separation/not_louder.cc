#include "separation/not_louder.h"

#include <algorithm>
#include <utility>

namespace vibrissa::separation {

namespace {

constexpr std::size_t samples_at_once = 256;

}  // namespace

NotLouder::NotLouder(std::unique_ptr<Separator> within, std::size_t memory_samples)
    : within_(std::move(within)),
      half_memory_(std::max<std::size_t>(1, memory_samples / 2)),
      late_moment_(within_->latency_samples(), 0.),
      block_(samples_at_once) {}

void NotLouder::reset() {
  within_->reset();
  std::ranges::fill(late_moment_, 0.);
  oldest_ = 0;
  n_recent_ = 0;
  recent_ = before_ = {};
}

void NotLouder::process(std::span<const double> base_acceleration,
                        std::span<const double> base_moment, std::span<double> wind_moment) {
  for (std::size_t first = 0; first < wind_moment.size(); first += samples_at_once) {
    const std::size_t n = std::min(samples_at_once, wind_moment.size() - first);
    // The result may overwrite the moment.
    std::copy_n(base_moment.begin() + static_cast<std::ptrdiff_t>(first), n, block_.begin());
    const auto wind = wind_moment.subspan(first, n);
    within_->process(base_acceleration.subspan(first, n), base_moment.subspan(first, n), wind);
    for (std::size_t i = 0; i < n; ++i) {
      double moment = block_[i];
      if (!late_moment_.empty()) {
        std::swap(moment, late_moment_[oldest_]);
        oldest_ = (oldest_ + 1) % late_moment_.size();
      }
      wind[i] = calmed(moment, wind[i]);
    }
  }
}

double NotLouder::calmed(double moment, double wind) {
  const double vibration = moment - wind;
  recent_.moment += moment * moment;
  recent_.wind += wind * wind;
  recent_.vibration += vibration * vibration;
  recent_.cross += moment * vibration;
  const Powers all{.moment = before_.moment + recent_.moment,
                   .wind = before_.wind + recent_.wind,
                   .vibration = before_.vibration + recent_.vibration,
                   .cross = before_.cross + recent_.cross};
  if (++n_recent_ == half_memory_) {
    n_recent_ = 0;
    before_ = recent_;
    recent_ = {};
  }
  if (!(all.wind > all.moment)) return wind;
  const double gain = all.vibration > 0. ? std::clamp(all.cross / all.vibration, 0., 1.) : 0.;
  return moment - gain * vibration;
}

}  // namespace vibrissa::separation
