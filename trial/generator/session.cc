#include "trial/generator/session.h"

#include <cmath>

#include "flow/wind.h"
#include "trial/generator/drive.h"
#include "trial/plant/modal_motion.h"
#include "trial/plant/reading.h"

namespace vibrissa::trial {
namespace {

constexpr double run_up_s = 1.5;
constexpr std::size_t margin = 32;  // samples
/// Fin and probe average eddies that are smaller than themselves.
constexpr double smallest_eddy_hz = 150.;

std::size_t run_up(const Take& take) {
  return take.period_samples > 0 ? take.period_samples
                                 : static_cast<std::size_t>(run_up_s * rate_hz);
}

class Bench {
 public:
  Bench(Motion& motion, const Structure& structure, const World& world, const Session& session)
      : motion_(motion), structure_(structure), world_(world), session_(session) {}

  signals::DatasetRecord record(const Take& take, std::uint64_t number) {
    const std::size_t steps = motion_.steps_per_sample();
    const std::size_t before = run_up(take) * steps;
    const std::size_t n = before + (take.n_samples + margin) * steps;
    const std::uint64_t drive = session_.seed * 1000 + take.drive * 10;
    const std::uint64_t noise = session_.seed * 1000 + 500 + number * 7;
    const std::vector<double> a = stage_motion(take, n, drive);
    Take sideways = take;
    sideways.base_rms *= 0.07;
    const std::vector<double> across = stage_motion(sideways, n, drive + 1);
    const std::vector<double> probe = wind_at_probe(take, n, drive + 2);
    const std::vector<double> felt = wind_at_sensor(take, probe, noise + 1);
    const std::vector<double> moment = motion_.base_moment(a, felt, noise + 2);
    const FineRecord fine{a,
                          across,
                          probe,
                          moment,
                          motion_.fine_hz(),
                          -static_cast<double>(before) / motion_.fine_hz()};
    signals::DatasetRecord out{
        .name = take.name,
        .record = read_out(world_, structure_, fine, take.n_samples, rate_hz, noise + 3,
                           {.noise = session_.noise, .wind = session_.has_wind_channel}),
        .excitation = {take.base_rms > 0., take.wind_mean > 0.},
        .period_samples = take.period_samples,
        .split = take.split};
    return out;
  }

 private:
  std::vector<double> stage_motion(const Take& take, const std::size_t n,
                                   const std::uint64_t seed) const {
    if (take.base_rms == 0.) return std::vector<double>(n, 0.);
    if (take.period_samples == 0)
      return band_noise(n, motion_.fine_hz(), take.low_hz, take.high_hz, take.base_rms, seed);
    const std::vector<double> period =
        odd_multisine(take.period_samples * motion_.steps_per_sample(), motion_.fine_hz(),
                      take.low_hz, take.high_hz, take.base_rms, seed);
    std::vector<double> out(n);
    // The record begins after the run-up, which consists of whole periods.
    for (std::size_t i = 0; i < n; ++i) out[i] = period[i % period.size()];
    return out;
  }

  std::vector<double> gusty(const double mean, const double intensity, const double length_scale,
                            const std::size_t n, const std::uint64_t seed) const {
    flow::WindParameters wind;
    wind.mean_speed = mean;
    wind.turbulence_intensity = intensity;
    wind.length_scale = length_scale;
    wind.maximum_speed = 10. * mean;
    return below(flow::make_wind(wind, motion_.fine_hz(), n, seed), motion_.fine_hz(),
                 smallest_eddy_hz);
  }

  std::vector<double> wind_at_probe(const Take& take, const std::size_t n,
                                    const std::uint64_t seed) const {
    if (take.wind_mean == 0.) return std::vector<double>(n, 0.);
    return gusty(take.wind_mean, take.gustiness, 0.15, n, seed);
  }

  /// Wind at the sensor: delayed, and with gusts that the probe does not measure.
  std::vector<double> wind_at_sensor(const Take& take, const std::vector<double>& probe,
                                     const std::uint64_t seed) const {
    std::vector<double> out = probe;
    if (world_.unseen > 0. && take.wind_mean > 0.) {
      const std::vector<double> gusts =
          gusty(take.wind_mean, world_.unseen, 0.05, out.size(), seed);
      for (std::size_t i = 0; i < out.size(); ++i) out[i] += gusts[i] - take.wind_mean;
    }
    if (world_.flow_lag_s > 0.) {
      const double late = std::exp(-1. / (motion_.fine_hz() * world_.flow_lag_s));
      double state = out.front();
      for (double& u : out) u = state = late * state + (1. - late) * u;
    }
    return out;
  }

  Motion& motion_;
  const Structure& structure_;
  const World& world_;
  const Session& session_;
};

/// A take with two periods of a multisine.
Take two_periods(const std::string& name, const double rms, const std::size_t period,
                 const std::uint64_t drive) {
  return {.name = name,
          .base_rms = rms,
          .n_samples = 2 * period,
          .period_samples = period,
          .drive = drive};
}

}  // namespace

std::vector<Take> usual_takes() {
  using signals::Split;
  return {{.name = "quiet", .n_samples = 2000, .drive = 1},
          two_periods("base_low", 0.8, 2048, 2),
          two_periods("base_high", 4.4, 2048, 3),
          two_periods("base_high_2", 4.4, 2048, 4),
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

std::vector<Take> short_takes() {
  return {{.name = "quiet", .n_samples = 2000, .drive = 1},
          two_periods("base_low", 0.8, 1024, 2),
          two_periods("base_high", 4.4, 1024, 3),
          {.name = "wind", .wind_mean = 1.6, .n_samples = 2500, .drive = 5},
          {.name = "combined", .base_rms = 2.5, .wind_mean = 1.6, .n_samples = 2500, .drive = 6},
          {.name = "held_out",
           .base_rms = 2.9,
           .wind_mean = 2.,
           .n_samples = 2500,
           .split = signals::Split::held_out,
           .drive = 7}};
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
  FurtherExperiment levels{.name = "level_ladder", .takes = {}}, winds{"wind_ladder", {}},
      wide{"wide_band", {two_periods("wide_band", 4.4, 2048, 91)}};
  for (const double factor : {0.25, 0.5, 1., 2.})
    levels.takes.push_back(
        two_periods("level_" + std::to_string(levels.takes.size() + 1), 4.4 * factor, 2048, 41));
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

signals::Dataset record_session(Motion& motion, const Structure& structure, const World& world,
                                const Session& session) {
  Bench bench(motion, structure, world, session);
  signals::Dataset out;
  std::uint64_t number = 0;
  for (const Take& take : session.takes) out.records.push_back(bench.record(take, ++number));
  return out;
}

signals::Dataset record_session(const Structure& structure, const World& world,
                                const Session& session) {
  ModalMotion motion(structure, world);
  return record_session(motion, structure, world, session);
}

}  // namespace vibrissa::trial
