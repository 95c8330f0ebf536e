#include "benchmarks/trial/detection_limit.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <list>
#include <numbers>

#include "benchmarks/trial/plant.h"
#include "signals/fft.h"

namespace vibrissa::trial {
namespace {

constexpr double half_power_at_one_percent = 6.63;

std::vector<std::complex<double>> change_of(const signals::Record& a, const signals::Record& b,
                                            const std::string& channel) {
  const auto x = a.channel(channel), y = b.channel(channel);
  std::vector<double> difference(x.size());
  double mean = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) mean += difference[i] = y[i] - x[i];
  for (double& d : difference) d -= mean / static_cast<double>(x.size());
  return signals::real_fft(difference);
}

}  // namespace

const Structure& structure_of(const SolidChange& change) {
  static std::list<std::pair<SolidChange, Structure>> solved;
  for (const auto& [there, structure] : solved)
    if (there == change) return structure;
  solved.emplace_front(change, solve_structure(change));
  return solved.front().second;
}

LikelihoodRatio::LikelihoodRatio(const World& plain, const Session& session)
    : plain_(plain), bare_(session) {
  bare_.noise = false;
  std::erase_if(bare_.takes, [](const Take& take) { return take.split != signals::Split::fit; });
  const Structure& structure = structure_of(plain.solid);
  records_ = record_session(structure, plain, bare_);
  const StateSpace plant = make_plant(structure, plain);
  for (const signals::DatasetRecord& entry : records_.records) {
    const std::size_t n_bins = entry.record.n_samples() / 2 + 1;
    const double n = static_cast<double>(entry.record.n_samples());
    std::vector<Line>& lines = lines_.emplace_back(n_bins);
    for (std::size_t k = 1; k + 1 < n_bins; ++k) {
      const std::complex<double> s(0.,
                                   2. * std::numbers::pi * static_cast<double>(k) * rate_hz / n);
      lines[k].gain = plant.response(s)(output::moment, input::acceleration);
      lines[k].noise =
          n * (plain.moment_noise * plain.moment_noise +
               std::norm(lines[k].gain) * plain.acceleration_noise * plain.acceleration_noise);
    }
  }
}

double LikelihoodRatio::noncentrality(const World& world, const bool random) const {
  const signals::Dataset with = record_session(structure_of(world.solid), world, bare_);
  double sum = 0.;
  for (std::size_t r = 0; r < records_.records.size(); ++r) {
    const signals::Record &a = records_.records[r].record, &b = with.records[r].record;
    const auto moment = change_of(a, b, signals::channel::base_moment);
    const auto motion = change_of(a, b, signals::channel::base_acceleration);
    for (std::size_t k = 1; k + 1 < moment.size(); ++k) {
      const Line& line = lines_[r][k];
      const double share = std::norm(moment[k] - line.gain * motion[k]) / line.noise;
      // One draw of a variance has twice its square's mean.
      sum += random ? 0.5 * share * share : 2. * share;
    }
  }
  return sum;
}

std::optional<double> detection_limit(const LikelihoodRatio& test, const Unknown& unknown,
                                      const double sign, const double shape) {
  const auto seen = [&](double size) {
    World world = test.plain();
    unknown.apply(world, sign * size, shape);
    return test.noncentrality(world, unknown.random);
  };
  if (unknown.fixed_size)
    return unknown.largest * std::sqrt(half_power_at_one_percent / seen(unknown.largest));
  double size = unknown.start, power = unknown.random ? 4. : 2.;
  double last_size = 0., last_seen = 0.;
  for (int i = 0; i < 6; ++i) {
    const double now = seen(size);
    if (size == unknown.largest && now < half_power_at_one_percent) return std::nullopt;
    if (std::abs(std::log(now / half_power_at_one_percent)) < 0.2) break;
    if (last_size > 0. && now != last_seen && last_size != size)
      power = std::clamp(std::log(now / last_seen) / std::log(size / last_size), 1., 12.);
    last_size = size;
    last_seen = now;
    const double factor = std::pow(half_power_at_one_percent / std::max(now, 1e-12), 1. / power);
    size = std::min(unknown.largest, size * std::clamp(factor, 0.02, 50.));
  }
  return unknown.hidden_below ? std::max(size, unknown.hidden_below(test.plain())) : size;
}

}  // namespace vibrissa::trial
