#include "fem/motion/transient_run.h"

#include <cassert>
#include <utility>

namespace vibrissa::fem {

TransientRun::TransientRun(std::unique_ptr<DrivenSensor> sensor, const std::size_t n_samples,
                           const std::array<double, 3>& axial, const bool both_routes)
    : sensor_(std::move(sensor)), n_samples_(n_samples), axial_(axial), both_routes_(both_routes) {
  record();
}

void TransientRun::record() {
  const auto moment = sensor_->moment_by_reactions();
  add_moment(moment, axial_, output_);
  if (both_routes_) compare_routes(moment, sensor_->moment_by_balance(), output_);
  if (const auto energy = sensor_->energy()) output_.energy.push_back(*energy);
  output_.count = sensor_->count();
}

void TransientRun::advance() {
  assert(!is_done());
  sensor_->advance(n_done() - 1);
  if (const auto interval = sensor_->interval()) output_.intervals.push_back(*interval);
  record();
}

void TransientRun::restore(const TransientMemory& memory, TransientOutput output) {
  assert(!output.base_moment.empty() && output.base_moment.size() <= n_samples_);
  output_ = std::move(output);
  sensor_->restore(memory, n_done() - 1);
}

TransientOutput run_to_the_end(TransientRun run, const TransientObserver& observer) {
  while (true) {
    if (observer) observer(run.n_done() - 1, run.sensor().state());
    if (run.is_done()) return run.output();
    run.advance();
  }
}

}  // namespace vibrissa::fem
