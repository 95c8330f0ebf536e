#include "diagnosis/response/joint_simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "diagnosis/records/spectrum.h"
#include "diagnosis/response/difference_integrator.h"
#include "signals/model/base_velocity.h"

namespace vibrissa::diagnosis {
namespace {

constexpr auto n_lanes = static_cast<std::size_t>(Lanes::SizeAtCompileTime);

std::size_t warm_up(const PreparedRecord& record, std::size_t factor) {
  const std::size_t n = record.n_samples * factor;
  return record.periodic ? n - n / 2 : 0;
}

/// All steps of a record on the fine time grid, zero after its end. Periodic records are in steady
/// state, so their last part is prepended.
std::vector<double> all_steps(const PreparedRecord& record, std::span<const Complex> spectrum,
                              std::size_t factor, std::size_t n_steps) {
  const std::vector<double> x = upsampled(spectrum, record.n_samples, factor);
  const auto before = static_cast<std::ptrdiff_t>(warm_up(record, factor));
  std::vector<double> out(n_steps, 0.);
  std::copy(x.begin(), x.end(), std::copy(x.end() - before, x.end(), out.begin()));
  return out;
}

/// One lane per record; zero where it has no signal.
std::vector<Lanes> interleaved(const std::vector<std::vector<double>>& of_lanes,
                               std::size_t n_steps) {
  const std::vector<double> none(n_steps, 0.);
  std::array<const double*, n_lanes> x{};
  x.fill(none.data());
  for (std::size_t lane = 0; lane < of_lanes.size(); ++lane)
    if (!of_lanes[lane].empty()) x[lane] = of_lanes[lane].data();
  std::vector<Lanes> out(n_steps);
  // An inner loop over the lanes would be compiled to slow scattered stores.
  for (std::size_t i = 0; i < n_steps; ++i)
    out[i] << x[0][i], x[1][i], x[2][i], x[3][i], x[4][i], x[5][i], x[6][i], x[7][i];
  return out;
}

/// Signals of the linear part.
struct FineSignals {
  std::vector<Lanes> y, y_rate, wind{}, base_velocity{};
  Lanes wind_share = Lanes::Zero();
};

std::vector<Complex> base_velocity(const PreparedRecord& record) {
  std::vector<Complex> velocity(record.n_samples / 2 + 1, 0.);
  for (std::size_t k = 1; k < velocity.size() && k < record.acceleration.size(); ++k) {
    const Complex s = record.line_s(k);
    if (gives_velocity(s)) velocity[k] = record.acceleration[k] / s;
  }
  return velocity;
}

FineSignals fine_signals(const Chain& chain, std::span<const ElasticMoment> elastic,
                         std::size_t factor, std::size_t n_steps) {
  std::vector<std::vector<double>> y, y_rate, wind, base;
  Lanes wind_share = Lanes::Zero();
  bool any_wind = false;
  for (std::size_t lane = 0; lane < elastic.size(); ++lane) {
    const PreparedRecord& record = *elastic[lane].record;
    const auto fine = [&](std::span<const Complex> spectrum) {
      return all_steps(record, spectrum, factor, n_steps);
    };
    y.push_back(fine(elastic[lane].spectrum));
    std::vector<Complex> rate = elastic[lane].spectrum;
    for (std::size_t k = 0; k < rate.size(); ++k) rate[k] *= record.line_s(k);
    y_rate.push_back(fine(rate));
    wind.emplace_back();
    base.emplace_back();
    if (!chain.relative_wind.on || record.wind.empty()) continue;
    any_wind = true;
    wind_share(static_cast<Eigen::Index>(lane)) = record.wind_share;
    wind.back() = fine(spectrum_of(record.wind));
    base.back() = fine(base_velocity(record));
  }
  FineSignals out{.y = interleaved(y, n_steps),
                  .y_rate = interleaved(y_rate, n_steps),
                  .wind_share = wind_share};
  if (any_wind) {
    out.wind = interleaved(wind, n_steps);
    out.base_velocity = interleaved(base, n_steps);
  }
  return out;
}

/// With 25 points per period of the first mode the error of the exponential rule is below half a
/// percent of the addition.
std::size_t refinement(const JointModel& joint, double sampling_rate_hz) {
  const double wanted_hz = 25. * joint.frequency_rad_s / (2. * std::numbers::pi);
  return static_cast<std::size_t>(std::clamp(std::ceil(wanted_hz / sampling_rate_hz), 1., 16.));
}

/// Records of one sampling rate and readout under one chain, at most one per lane.
class SideBySide {
 public:
  SideBySide(const DynamicTask& task, std::span<const ElasticMoment> elastic)
      : rate_hz_(elastic.front().record->sampling_rate_hz),
        factor_(refinement(*task.joint, rate_hz_)),
        dt_(1. / (rate_hz_ * static_cast<double>(factor_))),
        elastic_(elastic),
        fine_(fine_signals(*task.chain, elastic, factor_, n_fine_steps())),
        integrator_(*task.chain, task.joint->dynamic(), record_numbers(), dt_),
        moving_(task.chain->relative_wind),
        rotation_(elastic.front().record->readout == signals::Readout::rotation) {
    for (std::size_t lane = 0; lane < elastic.size(); ++lane) {
      const std::size_t before = warm_up(*elastic[lane].record, factor_);
      start_(static_cast<Eigen::Index>(lane)) = static_cast<double>(before);
    }
    wind_gain_ =
        fine_.wind_share * task.chain->structure.modes.front().wind_gain * task.chain->drag_factor;
  }

  std::size_t n_steps() const { return fine_.y.size(); }

  void begin(std::size_t i) {
    // The record's clock starts at its first sample; before it slow changes are constant.
    const Lanes t_s = (static_cast<double>(i) - start_).max(0.) * dt_;
    integrator_.begin(fine_.y[i], fine_.y_rate[i], t_s);
  }

  bool correct() {
    if (!integrator_.is_open()) return false;
    integrator_.correct();
    return true;
  }

  void end(std::size_t i) {
    const auto load = [&](const Lanes& rate) -> Lanes {
      if (fine_.wind.empty()) return Lanes::Zero();
      return wind_gain_ * relative_drag(moving_, fine_.wind[i], fine_.base_velocity[i], rate);
    };
    const JointIntegrator::AtBase added = integrator_.end(load);
    // Overwrites values that this step was the last to read.
    fine_.y[i] = rotation_ ? added.elastic : added.moment;
  }

  /// After all steps: the addition at each record's samples.
  std::vector<std::vector<double>> samples() const {
    std::vector<std::vector<double>> out;
    for (std::size_t lane = 0; lane < elastic_.size(); ++lane) {
      const PreparedRecord& record = *elastic_[lane].record;
      std::vector<double>& x = out.emplace_back(record.n_samples);
      const Lanes* next = &fine_.y[warm_up(record, factor_)];
      for (double& value : x) {
        value = (*next)(static_cast<Eigen::Index>(lane));
        next += factor_;
      }
    }
    return out;
  }

 private:
  std::size_t n_fine_steps() const {
    std::size_t n = 0;
    for (const ElasticMoment& e : elastic_)
      n = std::max(n, warm_up(*e.record, factor_) + e.record->n_samples * factor_);
    return n;
  }

  Lanes record_numbers() const {
    Lanes number = Lanes::Zero();
    for (std::size_t lane = 0; lane < elastic_.size(); ++lane)
      number(static_cast<Eigen::Index>(lane)) = static_cast<double>(elastic_[lane].record->number);
    return number;
  }

  double rate_hz_;
  std::size_t factor_;
  double dt_;
  std::span<const ElasticMoment> elastic_;
  FineSignals fine_;
  DifferenceIntegrator integrator_;
  RelativeWind moving_;
  bool rotation_;
  Lanes start_ = Lanes::Zero(), wind_gain_ = Lanes::Zero();
};

/// The additions for the records of a task, in its order.
std::vector<SideBySide> in_lanes(const DynamicTask& task) {
  std::vector<SideBySide> out;
  std::span<const ElasticMoment> left = task.elastic;
  while (!left.empty()) {
    const PreparedRecord& first = *left.front().record;
    const auto other = std::find_if(left.begin(), left.end(), [&](const ElasticMoment& e) {
      return e.record->sampling_rate_hz != first.sampling_rate_hz ||
             e.record->readout != first.readout;
    });
    const std::size_t n =
        std::min(n_lanes, static_cast<std::size_t>(std::distance(left.begin(), other)));
    out.emplace_back(task, left.first(n));
    left = left.subspan(n);
  }
  return out;
}

void step_in_turn(std::span<SideBySide> runs) {
  std::size_t n_steps = 0;
  for (const SideBySide& run : runs) n_steps = std::max(n_steps, run.n_steps());
  const auto for_each = [&](std::size_t i, const auto& work) {
    for (SideBySide& run : runs)
      if (i < run.n_steps()) work(run);
  };
  for (std::size_t i = 0; i < n_steps; ++i) {
    for_each(i, [&](SideBySide& run) { run.begin(i); });
    for (bool open = true; open;) {
      open = false;
      for_each(i, [&](SideBySide& run) { open = run.correct() || open; });
    }
    for_each(i, [&](SideBySide& run) { run.end(i); });
  }
}

}  // namespace

bool gives_velocity(const Complex s) {
  return s.imag() > 2. * std::numbers::pi * signals::slowest_base_motion_hz;
}

bool is_dynamic(const Chain& chain, const PreparedRecord& record) {
  return !chain.joint.empty() || (chain.relative_wind.on && !record.wind.empty());
}

std::vector<std::vector<std::vector<double>>> dynamic_parts(std::span<const DynamicTask> tasks) {
  std::vector<SideBySide> runs;
  std::vector<std::size_t> task_of_run;
  for (std::size_t i = 0; i < tasks.size(); ++i)
    for (SideBySide& run : in_lanes(tasks[i])) {
      runs.push_back(std::move(run));
      task_of_run.push_back(i);
    }
  step_in_turn(runs);
  std::vector<std::vector<std::vector<double>>> out(tasks.size());
  for (std::size_t j = 0; j < runs.size(); ++j)
    for (std::vector<double>& samples : runs[j].samples())
      out[task_of_run[j]].push_back(std::move(samples));
  return out;
}

}  // namespace vibrissa::diagnosis
