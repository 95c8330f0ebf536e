#include "diagnosis/joint_simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "diagnosis/spectrum.h"
#include "signals/base_velocity.h"

namespace vibrissa::diagnosis {
namespace {

constexpr auto n_lanes = static_cast<std::size_t>(Lanes::SizeAtCompileTime);

/// Integrates what is added to the linear part, whose elastic joint moment is given.
class DifferenceIntegrator {
 public:
  DifferenceIntegrator(const Chain& chain, const JointModel& joint, const Lanes& record_number,
                       double dt)
      : dt_(dt), is_loaded_(chain.relative_wind.on), integrator_(joint, dt) {
    for (const JointLawMaker& maker : chain.joint) laws_.push_back(maker(record_number));
  }

  /// One step to (y, y_rate) of the linear part; load gives the extra wind load for a rate of the
  /// joint moment. Returns the change at the base.
  template <typename Load>
  JointIntegrator::AtBase advance(const Lanes& y, const Lanes& y_rate, const Lanes& t_s,
                                  const Load& load) {
    if (laws_.empty()) {
      for (int pass = 0; pass < 2; ++pass)
        external_ = load(y_rate + integrator_.elastic_rate(torque_, external_));
      return integrator_.accept(torque_, external_);
    }
    solve_torque(y, y_rate, t_s);
    if (is_loaded_) external_ = load(y_rate + integrator_.elastic_rate(torque_, external_));
    law_moment(y, y_rate, t_s, torque_, true);
    return integrator_.accept(torque_, external_);
  }

 private:
  /// The extra moment at the step's end acts back on the joint's rotation at once: a stiff law
  /// needs the solution of T = law(y(T)). Secant rule from the line through the steps before, with
  /// their slope.
  void solve_torque(const Lanes& y, const Lanes& y_rate, const Lanes& t_s) {
    Lanes from = 2. * torque_ - torque_before_;
    Lanes from_excess = law_moment(y, y_rate, t_s, from, false) - from;
    Lanes at = from - from_excess / slope_;
    for (int i = 0; i < 4 && is_open(from_excess, at); ++i) {
      const Lanes at_excess = law_moment(y, y_rate, t_s, at, false) - at;
      take_secant(from, from_excess, at, at_excess);
    }
    torque_before_ = torque_;
    torque_ = at;
  }

  /// Is the residual before the last correction large in any lane? What is left after it is far
  /// less. Plain loops here: Eigen's comparisons are not vectorised.
  static bool is_open(const Lanes& excess, const Lanes& at) {
    constexpr double tolerance = 1e-5;
    int n_open = 0;
    for (Eigen::Index i = 0; i < excess.size(); ++i)
      n_open += std::abs(excess(i)) > tolerance * std::abs(at(i)) ? 1 : 0;
    return n_open > 0;
  }

  void take_secant(Lanes& from, Lanes& from_excess, Lanes& at, const Lanes& at_excess) {
    const Lanes slopes = (at_excess - from_excess) / (at - from);
    from = at;
    from_excess = at_excess;
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const bool usable = at_excess(i) != 0. && slopes(i) < 0.;
      slope_(i) = usable ? slopes(i) : slope_(i);
      at(i) -= usable ? at_excess(i) / slope_(i) : 0.;
    }
  }

  Lanes law_moment(const Lanes& y, const Lanes& y_rate, const Lanes& t_s, const Lanes& assumed,
                   bool commit) {
    const Lanes elastic = y + integrator_.elastic(assumed, external_);
    const Lanes rate = y_rate + integrator_.elastic_rate(assumed, external_);
    Lanes sum = Lanes::Zero();
    for (const auto& law : laws_) sum += law->moment(elastic, rate, t_s, dt_, commit);
    return sum;
  }

  double dt_;
  bool is_loaded_;
  JointIntegrator integrator_;
  std::vector<std::unique_ptr<JointLaw>> laws_;
  Lanes torque_ = Lanes::Zero(), torque_before_ = Lanes::Zero(), external_ = Lanes::Zero();
  Lanes slope_ = Lanes::Constant(-1.);  // of law(y(T)) - T, at the step before
};

/// Signals of the linear part on the fine grid, a lane for each record. Periodic records are in
/// steady state: their last part goes before them.
struct FineSignals {
  explicit FineSignals(std::size_t n) : y(n, Lanes::Zero()), y_rate(n, Lanes::Zero()) {}
  std::vector<Lanes> y, y_rate, wind, base_velocity;
  Lanes wind_share = Lanes::Zero();
};

std::size_t warm_up(const PreparedRecord& record, std::size_t factor) {
  const std::size_t n = record.n_samples * factor;
  return record.periodic ? n - n / 2 : 0;
}

void fill_lane(std::vector<Lanes>& lanes, std::size_t lane, const std::vector<double>& x,
               std::size_t before) {
  const std::size_t n = x.size(), first = n - before;
  for (std::size_t i = 0; i < n + before; ++i)
    lanes[i](static_cast<Eigen::Index>(lane)) = x[i < before ? first + i : i - before];
}

std::vector<Complex> base_velocity(const PreparedRecord& record) {
  std::vector<Complex> velocity(record.n_samples / 2 + 1, 0.);
  for (std::size_t k = 1; k < velocity.size() && k < record.acceleration.size(); ++k) {
    const Complex s = record.line_s(k);
    if (gives_velocity(s)) velocity[k] = record.acceleration[k] / s;
  }
  return velocity;
}

void fill(FineSignals& fine, const Chain& chain, std::size_t lane, const ElasticMoment& elastic,
          std::size_t factor) {
  const PreparedRecord& record = *elastic.record;
  const std::size_t n = record.n_samples, before = warm_up(record, factor);
  fill_lane(fine.y, lane, upsampled(elastic.spectrum, n, factor), before);
  std::vector<Complex> rate = elastic.spectrum;
  for (std::size_t k = 0; k < rate.size(); ++k) rate[k] *= record.line_s(k);
  fill_lane(fine.y_rate, lane, upsampled(rate, n, factor), before);
  if (!chain.relative_wind.on || record.wind.empty()) return;
  fine.wind.resize(fine.y.size(), Lanes::Zero());
  fine.base_velocity.resize(fine.y.size(), Lanes::Zero());
  fine.wind_share(static_cast<Eigen::Index>(lane)) = record.wind_share;
  fill_lane(fine.wind, lane, upsampled(spectrum_of(record.wind), n, factor), before);
  fill_lane(fine.base_velocity, lane, upsampled(base_velocity(record), n, factor), before);
}

/// 25 points a period of the first mode keep the exponential rule's error below half a percent of
/// what is added.
std::size_t refinement(const JointModel& joint, double sampling_rate_hz) {
  const double wanted_hz = 25. * joint.frequency_rad_s / (2. * std::numbers::pi);
  return static_cast<std::size_t>(std::clamp(std::ceil(wanted_hz / sampling_rate_hz), 1., 16.));
}

/// Records of one sampling rate, no more than there are lanes.
std::vector<std::vector<double>> side_by_side(const Chain& chain, const JointModel& joint,
                                              std::span<const ElasticMoment> elastic) {
  const double rate_hz = elastic.front().record->sampling_rate_hz;
  const std::size_t factor = refinement(joint, rate_hz);
  std::size_t n_steps = 0;
  Lanes start = Lanes::Zero(), number = Lanes::Zero();
  struct Next {
    std::size_t step = 0, sample = 0;
  };
  std::array<Next, n_lanes> next{};  // where each record is sampled next
  std::vector<std::vector<double>> out;
  for (std::size_t lane = 0; lane < elastic.size(); ++lane) {
    const PreparedRecord& record = *elastic[lane].record;
    const std::size_t before = warm_up(record, factor);
    start(static_cast<Eigen::Index>(lane)) = static_cast<double>(before);
    next[lane] = {before, 0};
    number(static_cast<Eigen::Index>(lane)) = static_cast<double>(record.number);
    n_steps = std::max(n_steps, before + record.n_samples * factor);
    out.emplace_back(record.n_samples);
  }
  FineSignals fine(n_steps);
  for (std::size_t lane = 0; lane < elastic.size(); ++lane)
    fill(fine, chain, lane, elastic[lane], factor);
  const double dt = 1. / (rate_hz * static_cast<double>(factor));
  DifferenceIntegrator integrator(chain, joint, number, dt);
  const double velocity_per_rate = chain.relative_wind.velocity_per_moment_rate;
  const Lanes wind_gain =
      fine.wind_share * chain.structure.modes.front().wind_gain * chain.drag_factor;
  for (std::size_t i = 0; i < n_steps; ++i) {
    const auto load = [&](const Lanes& rate) -> Lanes {
      if (fine.wind.empty()) return Lanes::Zero();
      const Lanes& u = fine.wind[i];
      const Lanes felt = u - fine.base_velocity[i] - velocity_per_rate * rate;
      return wind_gain * (felt * felt.abs() - u * u.abs());
    };
    // A record's own clock starts at its first sample: before it slow changes stand still.
    const Lanes t_s = (static_cast<double>(i) - start).max(0.) * dt;
    const auto added = integrator.advance(fine.y[i], fine.y_rate[i], t_s, load);
    for (std::size_t lane = 0; lane < elastic.size(); ++lane)
      if (i == next[lane].step && next[lane].sample < out[lane].size()) {
        const bool rotation = elastic[lane].record->readout == signals::Readout::rotation;
        out[lane][next[lane].sample++] =
            (rotation ? added.elastic : added.moment)(static_cast<Eigen::Index>(lane));
        next[lane].step += factor;
      }
  }
  return out;
}

}  // namespace

bool gives_velocity(const Complex s) {
  return s.imag() > 2. * std::numbers::pi * signals::slowest_base_motion_hz;
}

bool is_dynamic(const Chain& chain, const PreparedRecord& record) {
  return !chain.joint.empty() || (chain.relative_wind.on && !record.wind.empty());
}

std::vector<std::vector<double>> dynamic_parts(const Chain& chain, const JointModel& joint,
                                               std::span<const ElasticMoment> elastic) {
  std::vector<std::vector<double>> out;
  while (!elastic.empty()) {
    const double rate_hz = elastic.front().record->sampling_rate_hz;
    const auto other = std::find_if(elastic.begin(), elastic.end(), [&](const ElasticMoment& e) {
      return e.record->sampling_rate_hz != rate_hz;
    });
    const std::size_t n =
        std::min(n_lanes, static_cast<std::size_t>(std::distance(elastic.begin(), other)));
    for (std::vector<double>& part : side_by_side(chain, joint, elastic.first(n)))
      out.push_back(std::move(part));
    elastic = elastic.subspan(n);
  }
  return out;
}

}  // namespace vibrissa::diagnosis
