#include "benchmarks/trial/session.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "benchmarks/trial/drive.h"
#include "benchmarks/trial/joint.h"
#include "benchmarks/trial/plant.h"
#include "benchmarks/trial/reading.h"
#include "benchmarks/trial/sampler.h"
#include "flow/wind.h"

namespace vibrissa::trial {
namespace {

constexpr std::size_t fine_factor = 16, margin = 512;
constexpr double fine_hz = rate_hz * fine_factor, run_up_s = 1.5;
/// Eddies smaller than fin and probe are averaged by both.
constexpr double smallest_eddy_hz = 150.;

std::size_t run_up(const Take& take) {
  const std::size_t n =
      take.period_samples > 0 ? take.period_samples : static_cast<std::size_t>(run_up_s * rate_hz);
  return n * fine_factor;
}

std::vector<double> stage_motion(const Take& take, const std::size_t n, const std::uint64_t seed) {
  if (take.base_rms == 0.) return std::vector<double>(n, 0.);
  if (take.period_samples == 0)
    return band_noise(n, fine_hz, take.low_hz, take.high_hz, take.base_rms, seed);
  const std::vector<double> period = odd_multisine(take.period_samples * fine_factor, fine_hz,
                                                   take.low_hz, take.high_hz, take.base_rms, seed);
  std::vector<double> out(n);
  // The record begins after the run-up, which is whole periods.
  for (std::size_t i = 0; i < n; ++i) out[i] = period[i % period.size()];
  return out;
}

std::vector<double> gusty(const double mean, const double intensity, const double length_scale,
                          const std::size_t n, const std::uint64_t seed) {
  flow::WindParameters wind;
  wind.mean_speed = mean;
  wind.turbulence_intensity = intensity;
  wind.length_scale = length_scale;
  wind.maximum_speed = 10. * mean;
  return below(flow::make_wind(wind, fine_hz, n, seed), fine_hz, smallest_eddy_hz);
}

std::vector<double> wind_at_probe(const Take& take, const std::size_t n, const std::uint64_t seed) {
  if (take.wind_mean == 0.) return std::vector<double>(n, 0.);
  return gusty(take.wind_mean, take.gustiness, 0.15, n, seed);
}

/// The wind that the sensor feels: delayed, with gusts that the probe does not see.
std::vector<double> wind_at_sensor(const World& world, const Take& take,
                                   const std::vector<double>& probe, const std::uint64_t seed) {
  std::vector<double> out = probe;
  if (world.unseen > 0. && take.wind_mean > 0.) {
    const std::vector<double> gusts = gusty(take.wind_mean, world.unseen, 0.05, out.size(), seed);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += gusts[i] - take.wind_mean;
  }
  if (world.flow_lag_s > 0.) {
    const double late = std::exp(-1. / (fine_hz * world.flow_lag_s));
    double state = out.front();
    for (double& u : out) u = state = late * state + (1. - late) * u;
  }
  return out;
}

/// Van der Pol's oscillator as the wake: q'' + e w (q^2 - 1) q' + w^2 q = 0, w = 2 pi St u / D.
class Wake {
 public:
  explicit Wake(double coefficient, double phase)
      : coefficient_(coefficient), q_(2. * std::cos(phase)), p_(std::sin(phase)) {}
  /// The share of u|u| that it adds.
  double next(double speed) {
    if (coefficient_ == 0.) return 0.;
    constexpr double strouhal = 0.17, width = 8.5e-3, stiffness = 0.3;
    const double w = 2. * std::numbers::pi * strouhal * std::abs(speed) / width;
    const double h = w / fine_hz;
    p_ += h * (-q_ - stiffness * (q_ * q_ - 1.) * p_);
    q_ += h * p_;
    return 0.5 * coefficient_ * q_;
  }

 private:
  double coefficient_, q_, p_;
};

/// What the drive moves the base at: it neither starts nor drifts.
std::vector<double> base_velocity(const std::vector<double>& acceleration) {
  const auto free_of_mean = [](std::vector<double> x) {
    const double sum = std::accumulate(x.begin(), x.end(), 0.);
    for (double& value : x) value -= sum / static_cast<double>(x.size());
    return x;
  };
  const std::vector<double> a = free_of_mean(acceleration);
  std::vector<double> v(a.size(), 0.);
  for (std::size_t i = 1; i < v.size(); ++i) v[i] = v[i - 1] + 0.5 * (a[i - 1] + a[i]) / fine_hz;
  return free_of_mean(std::move(v));
}

class Bench {
 public:
  Bench(const Structure& structure, const World& world, const Session& session)
      : world_(world),
        session_(session),
        structure_(structure),
        plant_(make_plant(structure, world)),
        step_(plant_, 1. / fine_hz),
        hinge_effect_(plant_.c * step_.next.col(input::hinge) + plant_.d.col(input::hinge)),
        joint_(world.joint, structure.joint_stiffness_n_m, 1. / fine_hz) {}

  signals::DatasetRecord record(const Take& take, std::uint64_t number) {
    const std::size_t before = run_up(take), length = take.n_samples * fine_factor;
    const std::size_t n = before + length + margin;
    const std::uint64_t drive = session_.seed * 1000 + take.drive * 10;
    const std::uint64_t noise = session_.seed * 1000 + 500 + number * 7;
    const std::vector<double> a = stage_motion(take, n, drive);
    Take sideways = take;
    sideways.base_rms *= 0.07;
    const std::vector<double> across = stage_motion(sideways, n, drive + 1);
    const std::vector<double> probe = wind_at_probe(take, n, drive + 2);
    const std::vector<double> felt = wind_at_sensor(world_, take, probe, noise + 1);
    const std::vector<double> moment = moved(a, felt, noise + 2);
    const FineRecord fine{a,      across,  probe,
                          moment, fine_hz, -static_cast<double>(before) / fine_hz};
    signals::DatasetRecord out{.name = take.name,
                               .record = read_out(world_, structure_, fine, take.n_samples, rate_hz,
                                                  noise + 3, session_.noise),
                               .excitation = {take.base_rms > 0., take.wind_mean > 0.},
                               .period_samples = take.period_samples,
                               .split = take.split};
    return out;
  }

 private:
  /// The base moment on the fine clock. What depends on the motion that it drives (hinge, the air's
  /// relative speed) is found by repeating the step.
  std::vector<double> moved(const std::vector<double>& a, const std::vector<double>& wind,
                            std::uint64_t seed) {
    const std::size_t n = a.size();
    std::mt19937_64 random(seed);
    Wake wake(world_.shedding, 6.28 * std::uniform_real_distribution<double>()(random));
    const bool free = world_.joint.is_linear();
    const int n_passes = world_.own_motion == 0. ? 1 : 3;
    const std::vector<double> tilt = stage_tilt(a), carried = base_velocity(a);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(plant_.a.rows());
    Eigen::VectorXd f = Eigen::VectorXd::Zero(input::n), y = Eigen::VectorXd::Zero(output::n);
    std::vector<double> out(n);
    for (std::size_t i = 0; i < n; ++i) {
      Eigen::VectorXd next = f;
      next(input::acceleration) = a[i];
      next(input::tilt_acceleration) = tilt[i];
      const double shed = wake.next(wind[i]);
      Eigen::VectorXd there = step_.transition * x + step_.now * f;
      const Eigen::VectorXd before = there;
      for (int pass = 0; pass < n_passes; ++pass) {
        const double velocity = carried[i] + y(output::wind_velocity);
        const double u = wind[i] - world_.own_motion * velocity;
        next(input::wind) = world_.drag * (u * std::abs(u) + shed * wind[i] * std::abs(wind[i]));
        next(input::hinge) = 0.;
        there = before + step_.next * next;
        y = plant_.c * there + plant_.d * next;
        if (!free) {
          next(input::hinge) = hinge_moment(y, a[i], f(input::hinge));
          there += step_.next.col(input::hinge) * next(input::hinge);
          y = plant_.c * there + plant_.d * next;
        }
      }
      joint_.advance(y(output::hinge_turn));
      x = there;
      f = next;
      out[i] = y(output::moment);
    }
    return out;
  }

  /// The hinge's moment m where it agrees with the turn that it leads to, by the secant rule. y:
  /// what there is without it.
  double hinge_moment(const Eigen::VectorXd& y, const double acceleration,
                      const double guess) const {
    const auto mismatch = [&](double m) {
      const Eigen::VectorXd moved = y + hinge_effect_ * m;
      return joint_.moment(moved(output::hinge_turn), moved(output::hinge_rate), acceleration) - m;
    };
    const double scale = 1e-9 * structure_.joint_stiffness_n_m * world_.joint.scale;
    double m0 = guess, e0 = mismatch(m0), m1 = m0 + e0, e1 = mismatch(m1);
    for (int k = 0; k < 20 && std::abs(e1) > scale && e1 != e0; ++k) {
      const double m2 = m1 - e1 * (m1 - m0) / (e1 - e0);
      m0 = m1;
      e0 = e1;
      e1 = mismatch(m1 = m2);
    }
    return m1;
  }

  /// Rotational acceleration of a stage that rocks below its own resonance.
  std::vector<double> stage_tilt(const std::vector<double>& a) const {
    std::vector<double> out(a.size(), 0.);
    if (world_.rocking == 0.) return out;
    const double w = 2. * std::numbers::pi * 180., h = 1. / fine_hz;
    double q = 0., p = 0.;
    for (std::size_t i = 0; i < a.size(); ++i) {
      p += h * (w * w * (a[i] - q) - 0.1 * w * p);
      q += h * p;
      out[i] = world_.rocking * q;
    }
    return out;
  }

  const World& world_;
  const Session& session_;
  const Structure& structure_;
  StateSpace plant_;
  FirstOrderHold step_;
  Eigen::VectorXd hinge_effect_;
  Joint joint_;
};

}  // namespace

std::vector<Take> usual_takes() {
  using signals::Split;
  return {
      {.name = "quiet", .n_samples = 2000, .drive = 1},
      {.name = "base_low", .base_rms = 0.8, .n_samples = 4096, .period_samples = 2048, .drive = 2},
      {.name = "base_high", .base_rms = 4.4, .n_samples = 4096, .period_samples = 2048, .drive = 3},
      {.name = "base_high_2",
       .base_rms = 4.4,
       .n_samples = 4096,
       .period_samples = 2048,
       .drive = 4},
      {.name = "wind", .wind_mean = 1.6, .n_samples = 5000, .drive = 5},
      {.name = "combined", .base_rms = 2.5, .wind_mean = 1.6, .n_samples = 5000, .drive = 6},
      {.name = "held_out",
       .base_rms = 2.9,
       .wind_mean = 2.,
       .n_samples = 5000,
       .split = Split::held_out,
       .drive = 7},
      {.name = "held_out_base",
       .base_rms = 1.8,
       .n_samples = 5000,
       .split = Split::held_out,
       .drive = 8}};
}

std::vector<Take> transfer_takes() {
  using signals::Split;
  return {{.name = "other_level",
           .base_rms = 6.,
           .n_samples = 4000,
           .split = Split::held_out,
           .drive = 21},
          {.name = "other_wind",
           .base_rms = 1.2,
           .wind_mean = 2.6,
           .n_samples = 4000,
           .split = Split::held_out,
           .drive = 22}};
}

std::vector<FurtherExperiment> further_experiments() {
  const auto multisine = [](const std::string& name, double rms, std::uint64_t drive) {
    return Take{
        .name = name, .base_rms = rms, .n_samples = 4096, .period_samples = 2048, .drive = drive};
  };
  FurtherExperiment levels{.name = "level_ladder", .takes = {}}, winds{"wind_ladder", {}},
      wide{"wide_band", {multisine("wide_band", 4.4, 51)}};
  for (const double factor : {0.25, 0.5, 1., 2.})
    levels.takes.push_back(
        multisine("level_" + std::to_string(levels.takes.size() + 1), 4.4 * factor, 41));
  for (const int speed : {1, 2, 3, 4}) {
    const std::string name = "wind_" + std::to_string(speed);
    const auto drive = static_cast<std::uint64_t>(60 + speed);
    winds.takes.push_back(
        {.name = name, .wind_mean = speed + 0., .n_samples = 2500, .drive = drive});
    winds.takes.push_back({.name = name + "_base",
                           .base_rms = 2.5,
                           .wind_mean = speed + 0.,
                           .n_samples = 2500,
                           .drive = drive + 10});
  }
  wide.takes.front().low_hz = 1.;
  wide.takes.front().high_hz = 0.45 * rate_hz;
  const Take steady{
      .name = "steady_wind", .wind_mean = 2., .n_samples = 10000, .drive = 81, .gustiness = 0.01},
      quiet{.name = "quiet_long", .n_samples = 10000, .drive = 82};
  return {levels, winds, wide, {"steady_wind", {steady}}, {"quiet_record", {quiet}}};
}

signals::Dataset record_session(const Structure& structure, const World& world,
                                const Session& session) {
  Bench bench(structure, world, session);
  signals::Dataset out;
  std::uint64_t number = 0;
  for (const Take& take : session.takes) out.records.push_back(bench.record(take, ++number));
  return out;
}

}  // namespace vibrissa::trial
