#include "tests/checks/record_generator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "separation/model/simulation.h"
#include "signals/excitation/band_noise.h"
#include "signals/excitation/multisine.h"
#include "signals/excitation/swept_sine.h"

namespace vibrissa::checks::test {
namespace {

using diagnosis::FindingKind;
using Samples = std::vector<double>;
namespace channel = signals::channel;

double rms(const Samples& x) {
  double sum = 0.;
  for (const double v : x) sum += v * v;
  return std::sqrt(sum / double(x.size()));
}

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double logarithmic(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  std::size_t one_of(std::size_t n) { return std::size_t(uniform(0., double(n))) % n; }
  bool sometimes() { return uniform(0., 1.) < 0.33; }
  void add_noise(Samples& x, double deviation) {
    std::normal_distribution<double> normal(0., deviation);
    for (double& v : x) v += normal(random_);
  }
  std::uint64_t seed() { return random_(); }

 private:
  std::mt19937_64 random_;
};

struct Rig {
  double rate_hz = 0., first_hz = 0.;
  separation::Bvrm sensor;
  double level_m_s2 = 0., noise_db = 0.;
  std::size_t n = 0;
};

Rig drawn_rig(Draw& draw) {
  Rig rig;
  const std::array<double, 5> rates{250., 500., 833., 1000., 2000.};
  rig.rate_hz = rates[draw.one_of(rates.size())];
  rig.first_hz = draw.uniform(0.06, 0.12) * rig.rate_hz;
  const double gain = draw.logarithmic(1e-7, 1e-4);
  const std::size_t n_modes = 1 + draw.one_of(3);
  for (std::size_t k = 0; k < n_modes; ++k)
    rig.sensor.modes.push_back(separation::make_modal_term(rig.first_hz * (1. + 1.1 * double(k)),
                                                           draw.logarithmic(0.02, 0.08),
                                                           -gain / (1. + 4. * double(k))));
  rig.sensor.direct_term_kg_m = -0.1 * gain;
  rig.level_m_s2 = draw.logarithmic(0.5, 15.);
  rig.noise_db = draw.uniform(20., 60.);
  rig.n = 6000 + 2000 * draw.one_of(6);
  return rig;
}

Samples scaled(Samples x, double level) {
  const double factor = level / rms(x);
  for (double& v : x) v *= factor;
  return x;
}

Samples hits(const Rig& rig, Draw& draw, std::size_t n_hits) {
  Samples x(rig.n, 0.);
  const std::size_t apart = rig.n / n_hits, width = 6;
  for (std::size_t h = 0; h < n_hits; ++h) {
    const double peak = 20. * rig.level_m_s2 * draw.uniform(0.7, 1.3);
    for (std::size_t i = 0; i < width; ++i)
      x[h * apart + apart / 10 + i] =
          peak * std::pow(std::sin(std::numbers::pi * (double(i) + 0.5) / double(width)), 2);
  }
  return x;
}

Samples multisine(const Rig& rig, Draw& draw) {
  const std::size_t period = draw.sometimes() ? 1024 : 2048;
  const double step = rig.rate_hz / double(period);
  Samples lines;
  for (double f = step; f < 0.4 * rig.rate_hz; f += 2. * step)
    if (f > 0.01 * rig.rate_hz) lines.push_back(f);
  const auto sum = signals::make_multisine(lines, 1., signals::MultisinePhase::random, draw.seed());
  return sum.sample(rig.rate_hz, rig.n);
}

Samples drive_of(const Rig& rig, Drive drive, Draw& draw) {
  const double low = 0.01 * rig.rate_hz, high = 0.4 * rig.rate_hz;
  switch (drive) {
    case Drive::random:
      return scaled(signals::sample({low, high, 1., rig.n, draw.seed()}, rig.rate_hz),
                    rig.level_m_s2);
    case Drive::multisine:
      return scaled(multisine(rig, draw), rig.level_m_s2);
    case Drive::sweep: {
      // Four sweeps: the last third of the record, which scores a model, passes the resonances.
      const std::size_t one = rig.n / 4;
      const Samples sweep =
          signals::sample({low, high, signals::SweepLaw::linear, 1., one, one / 50}, rig.rate_hz);
      Samples x;
      for (std::size_t i = 0; i < rig.n; ++i) x.push_back(sweep[i % one]);
      return scaled(std::move(x), rig.level_m_s2);
    }
    case Drive::hits:
      return hits(rig, draw, 6);
  }
  return {};
}

void add_tone(Samples& x, double rate_hz, double f_hz, double amplitude, double phase) {
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] += amplitude * std::sin(2. * std::numbers::pi * f_hz * double(i) / rate_hz + phase);
}

void round_to(Samples& x, double step) {
  for (double& v : x) v = step * std::round(v / step);
}

/// What a logger adds to both channels.
void log_channels(const Rig& rig, Draw& draw, Samples& a, Samples& m) {
  const double noise = std::pow(10., -rig.noise_db / 20.);
  const bool has_hum = draw.sometimes(), has_steps = draw.sometimes(), drifts = draw.sometimes();
  const double offset_share = draw.uniform(-1., 1.);
  for (Samples* x : {&a, &m}) {
    const double size = rms(*x);
    draw.add_noise(*x, noise * size);
    if (has_hum) add_tone(*x, rig.rate_hz, 50., noise * size, draw.uniform(0., 6.));
    for (std::size_t i = 0; i < x->size(); ++i)
      (*x)[i] += size * (offset_share + (drifts ? 0.2 * double(i) / double(x->size()) : 0.));
    if (has_steps) round_to(*x, 16. * size / 4096.);
  }
}

signals::Record record_of(double rate_hz, Samples a, Samples m) {
  signals::Record record(rate_hz, a.size());
  record.set_channel(channel::base_acceleration, std::move(a));
  record.set_channel(channel::base_moment, std::move(m));
  return record;
}

Drive steady_drive(Draw& draw) {
  return std::array{Drive::random, Drive::multisine}[draw.one_of(2)];
}

struct Signals {
  Samples a, m;
};

/// Drive and moment without noise.
Signals ideal(const Rig& rig, Drive drive, Draw& draw) {
  Signals out;
  out.a = drive_of(rig, drive, draw);
  out.m = separation::simulate(rig.sensor, out.a, rig.rate_hz);
  return out;
}

void limit(Samples& x, double share) {
  Samples sizes;
  for (const double v : x) sizes.push_back(std::abs(v));
  std::sort(sizes.begin(), sizes.end());
  const double most = sizes[std::size_t((1. - share) * double(sizes.size()))];
  for (double& v : x) v = std::clamp(v, -most, most);
}

/// Sampled every eighth time without a low-pass.
Signals aliased(const Rig& rig, Draw& draw) {
  constexpr std::size_t times = 8;
  const double fast_hz = double(times) * rig.rate_hz;
  Samples a = signals::sample({0.01 * rig.rate_hz, 0.45 * fast_hz, 1., times * rig.n, draw.seed()},
                              fast_hz);
  a = scaled(std::move(a), rig.level_m_s2);
  const Samples m = separation::simulate(rig.sensor, a, fast_hz);
  Signals out;
  for (std::size_t i = 0; i < rig.n; ++i) {
    out.a.push_back(a[times * i]);
    out.m.push_back(m[times * i]);
  }
  return out;
}

/// Another sensor from two thirds of the record on: a mount that came loose.
void change_last_third(const Rig& rig, Draw& draw, Signals& signals) {
  separation::Bvrm loose = rig.sensor;
  const double factor = draw.uniform(0.75, 0.92);
  for (auto& mode : loose.modes) {
    mode.a0 *= factor * factor;
    mode.a1 *= factor;
    mode.b0 *= factor * factor;
  }
  const Samples m = separation::simulate(loose, signals.a, rig.rate_hz);
  for (std::size_t i = rig.n * 2 / 3; i < rig.n; ++i) signals.m[i] = m[i];
}

/// Wind moves the sensor, and the accelerometer shows its noise.
void remove_input(const Rig& rig, Draw& draw, Signals& signals) {
  signals.a.assign(rig.n, 0.);
  draw.add_noise(signals.a, draw.uniform(0.01, 0.08));
}

/// Both channels show the mains and noise.
void leave_hum(const Rig& rig, Draw& draw, Signals& signals) {
  const double mains_hz = draw.sometimes() ? 60. : 50.;
  for (Samples* x : {&signals.a, &signals.m}) {
    const double size = rms(*x);
    x->assign(rig.n, 0.);
    for (int h = 1; h <= 3 && h * mains_hz < 0.45 * rig.rate_hz; ++h)
      add_tone(*x, rig.rate_hz, h * mains_hz, size / h, draw.uniform(0., 6.));
    draw.add_noise(*x, 0.03 * size);
  }
}

}  // namespace

signals::Record good_record(const Drive drive, const std::uint64_t seed) {
  Draw draw(seed);
  Rig rig = drawn_rig(draw);
  if (drive == Drive::hits) rig.noise_db = draw.uniform(40., 60.);
  auto [a, m] = ideal(rig, drive, draw);
  log_channels(rig, draw, a, m);
  return record_of(rig.rate_hz, std::move(a), std::move(m));
}

BadRecord bad_record(const Fault fault, const std::uint64_t seed) {
  Draw draw(seed);
  Rig rig = drawn_rig(draw);
  if (fault == Fault::too_short) rig.n = 100 + draw.one_of(200);
  const Drive drive = fault == Fault::one_hit     ? Drive::hits
                      : fault == Fault::too_short ? Drive::random
                                                  : steady_drive(draw);
  Signals x = fault == Fault::aliased ? aliased(rig, draw) : ideal(rig, drive, draw);
  if (fault == Fault::drive_ended) {
    const auto end = std::size_t(draw.uniform(0.3, 0.75) * double(rig.n));
    std::fill(x.a.begin() + std::ptrdiff_t(end), x.a.end(), 0.);
    x.m = separation::simulate(rig.sensor, x.a, rig.rate_hz);
  }
  if (fault == Fault::one_hit) {
    x.a = hits(rig, draw, 1);
    x.m = separation::simulate(rig.sensor, x.a, rig.rate_hz);
    rig.noise_db = draw.uniform(40., 60.);
  }
  if (fault == Fault::changing) change_last_third(rig, draw, x);
  if (fault == Fault::no_input) remove_input(rig, draw, x);
  if (fault == Fault::hum_only) leave_hum(rig, draw, x);
  if (fault == Fault::opposite_sign)
    for (double& v : x.m) v = -v;
  const Samples true_a = x.a;
  if (fault == Fault::noise_alone)
    for (Samples* s : {&x.a, &x.m}) {
      const double size = rms(*s);
      s->assign(rig.n, 0.);
      draw.add_noise(*s, size);
    }
  log_channels(rig, draw, x.a, x.m);
  if (fault == Fault::clipped) limit(draw.sometimes() ? x.a : x.m, draw.uniform(0.005, 0.1));
  if (fault == Fault::few_steps) round_to(x.m, draw.uniform(1.3, 2.) * rms(x.m));
  if (fault == Fault::dead_moment) x.m.assign(x.m.size(), draw.sometimes() ? 0. : 3e-4);
  if (fault == Fault::dead_acceleration) x.a.assign(x.a.size(), draw.sometimes() ? 0. : 9.81);
  if (fault == Fault::swapped) std::swap(x.a, x.m);
  if (fault == Fault::unit_factor)
    for (double& v : x.a) v /= 9.80665;
  signals::Record record = record_of(rig.rate_hz, x.a, x.m);
  if (fault == Fault::unit_factor) {
    Samples second = true_a;
    draw.add_noise(second, 0.01 * rms(true_a));
    record.set_channel("base_acceleration_2_m_s2", std::move(second));
  }
  switch (fault) {
    case Fault::dead_moment:
      return {"dead moment", record, FindingKind::constant_channel, true};
    case Fault::dead_acceleration:
      return {"dead acceleration", record, FindingKind::constant_channel, true};
    case Fault::clipped:
      return {"clipped", record, FindingKind::clipped_channel};
    case Fault::drive_ended:
      return {"drive ended", record, FindingKind::drive_ended};
    case Fault::swapped:
      return {"swapped", record, FindingKind::swapped_columns, true};
    case Fault::aliased:
      return {"aliased", record, FindingKind::possible_aliasing};
    case Fault::one_hit:
      return {"one hit", record, FindingKind::one_hit};
    case Fault::noise_alone:
      return {"noise alone", record, FindingKind::no_coherence, true};
    case Fault::changing:
      return {"changing", record, FindingKind::changing_response};
    case Fault::no_input:
      return {"no input", record, FindingKind::no_base_motion, true};
    case Fault::hum_only:
      return {"hum only", record, FindingKind::hum, true};
    case Fault::few_steps:
      return {"few steps", record, FindingKind::few_steps};
    case Fault::too_short:
      return {"too short", record, FindingKind::too_short};
    case Fault::opposite_sign:
      return {"opposite sign", record, FindingKind::reversed_sign};
    case Fault::unit_factor:
      return {"unit factor", record, FindingKind::wrong_unit};
  }
  return {"", record, FindingKind::hum};
}

}  // namespace vibrissa::checks::test
