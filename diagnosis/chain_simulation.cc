#include "diagnosis/chain_simulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "diagnosis/joint_model.h"
#include "diagnosis/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

Complex product(const std::vector<Filter>& filters, Complex s) {
  Complex value = 1.;
  for (const Filter& filter : filters) value *= filter(s);
  return value;
}

Complex sum(const std::vector<Filter>& filters, Complex s) {
  Complex value = 0.;
  for (const Filter& filter : filters) value += filter(s);
  return value;
}

/// Transfer functions of the chain at one frequency.
struct LinearPart {
  Complex base;     // reading of the accelerometer -> moment before the sensor
  Complex wind;     // u |u| -> moment before the sensor
  Complex elastic;  // moment before the sensor -> its elastic share in the joint
};

/// A joint K(s) (1 + D(s)) in place of K(s): with H = K B / (1 + K G) for the whisker pinned at its
/// base (B, G its rotation from the load and from a moment there) the moment becomes
/// H (1 + D) / (1 + D P), P = K G / (1 + K G); P from the joint model.
LinearPart linear_part(const Chain& chain, const std::optional<JointModel>& joint,
                       const Complex static_response, const Complex s) {
  const NominalModel& model = chain.structure;
  const Complex reference = product(chain.reference, s);
  const Complex input = reference * product(chain.mount, s);
  LinearPart part{.base = model.base_response(s), .wind = model.wind_response(s), .elastic = 1.};
  if (joint) {
    const Complex d = chain.relaxation.empty() ? Complex(0.) : sum(chain.relaxation, s);
    part.elastic = 1. / (joint->stiffness_ratio(s) * (1. + d));
    Complex change = 1.;
    if (!chain.relaxation.empty()) {
      // What the modes above the first do to H they do to 1 / (1 + K G), too: B is that of the
      // load.
      const Complex upper = part.base * (1. + joint->inertia_ratio(s)) / static_response;
      change = (1. + d) / (1. + d * (1. - joint->added_moment(s) * upper));
    }
    if (chain.inertia_factor != 1.) {
      const Complex inertia = joint->inertia_ratio(s, d);
      change *= (1. + inertia) / (1. + chain.inertia_factor * inertia);
    }
    part.base *= change;
    part.wind *= change;
  }
  part.base += sum(chain.parallel, s);
  part.base = part.base * input + sum(chain.feedthrough, s) * reference;
  return part;
}

std::optional<JointModel> joint_of(const Chain& chain) {
  if (chain.structure.modes.empty()) return std::nullopt;
  return JointModel(chain.structure.modes.front(), chain.joint_share, chain.joint_loss_factor);
}

std::vector<Complex> wind_force_spectrum(const Chain& chain, const PreparedRecord& record) {
  if (record.wind.empty()) return {};
  std::vector<double> u = record.wind;
  for (const auto& law : chain.wind) law(u, 1. / record.sampling_rate_hz);
  for (double& value : u) value *= chain.drag_factor * std::abs(value);
  return spectrum_of(u);
}

bool is_dynamic(const Chain& chain, const PreparedRecord& record) {
  return !chain.joint.empty() || (chain.relative_wind.on && !record.wind.empty());
}

/// What joint laws and an extra wind load add to the moment, by the joint model: the linear part of
/// the elastic joint moment is given, what is added to it is integrated.
class DifferenceIntegrator {
 public:
  DifferenceIntegrator(const Chain& chain, const PreparedRecord& record, double dt)
      : dt_(dt), is_loaded_(chain.relative_wind.on), integrator_(*joint_of(chain), dt) {
    for (const JointLawMaker& maker : chain.joint) laws_.push_back(maker(record.number));
  }

  /// One step to (y, y_rate) of the linear part; load gives the extra wind load for a rate of the
  /// joint moment. Returns the change of the base moment.
  template <typename Load>
  double advance(double y, double y_rate, double t_s, const Load& load) {
    if (laws_.empty()) return advance_load(y_rate, load);
    // The extra moment at the step's end acts back on the joint's rotation at once: a stiff law
    // needs the solution of torque(y(T)) = T, found by the secant rule.
    double from = torque_, from_excess = excess(y, y_rate, t_s, from);
    double at = from + from_excess;
    for (int i = 0; i < 4 && std::abs(from_excess) > 1e-9 * std::abs(at); ++i) {
      const double at_excess = excess(y, y_rate, t_s, at);
      const double slope = (at_excess - from_excess) / (at - from);
      if (at_excess == 0. || !(slope < 0.)) break;
      from = at;
      from_excess = at_excess;
      at -= at_excess / slope;
    }
    torque_ = at;
    if (is_loaded_) external_ = load(rate_at(y_rate, at));
    const Eigen::Vector3d state = integrator_.moved(torque_, external_);
    const double rate = y_rate + integrator_.elastic_rate(state, torque_);
    torque(y + state(2), rate, t_s, true);
    integrator_.accept(state, torque_, external_);
    return integrator_.moment(state);
  }

 private:
  template <typename Load>
  double advance_load(double y_rate, const Load& load) {
    for (int pass = 0; pass < 2; ++pass) external_ = load(rate_at(y_rate, 0.));
    const Eigen::Vector3d state = integrator_.moved(0., external_);
    integrator_.accept(state, 0., external_);
    return integrator_.moment(state);
  }
  double rate_at(double y_rate, double torque) const {
    return y_rate + integrator_.elastic_rate(integrator_.moved(torque, external_), torque);
  }
  /// Law's moment less the one assumed.
  double excess(double y, double y_rate, double t_s, double assumed) {
    const Eigen::Vector3d state = integrator_.moved(assumed, external_);
    const double rate = y_rate + integrator_.elastic_rate(state, assumed);
    return torque(y + state(2), rate, t_s, false) - assumed;
  }
  double torque(double y, double y_rate, double t_s, bool commit) {
    double sum = 0.;
    for (const auto& law : laws_) sum += law->moment(y, y_rate, t_s, dt_, commit);
    return sum;
  }

  double dt_;
  bool is_loaded_;
  JointIntegrator integrator_;
  std::vector<std::unique_ptr<JointLaw>> laws_;
  double torque_ = 0., external_ = 0.;
};

/// Signals of the linear part on the fine grid.
struct FineSignals {
  std::vector<double> y, y_rate, wind, base_velocity;
};

FineSignals fine_signals(const Chain& chain, const PreparedRecord& record,
                         const std::vector<Complex>& joint, std::size_t factor) {
  const std::size_t n = record.n_samples;
  const double line_rad_s =
      2. * std::numbers::pi * record.sampling_rate_hz / static_cast<double>(n);
  FineSignals fine;
  fine.y = upsampled(joint, n, factor);
  std::vector<Complex> rate(joint.size());
  for (std::size_t k = 0; k < joint.size(); ++k)
    rate[k] = Complex(0., line_rad_s * static_cast<double>(k)) * joint[k];
  fine.y_rate = upsampled(rate, n, factor);
  if (chain.relative_wind.on && !record.wind.empty()) {
    fine.wind = upsampled(spectrum_of(record.wind), n, factor);
    // Slower than this the base hardly moves; integrating noise there would only drift.
    constexpr double slowest_hz = 0.5;
    std::vector<Complex> velocity(joint.size(), 0.);
    for (std::size_t k = 1; k < velocity.size() && k < record.acceleration.size(); ++k) {
      const double w = line_rad_s * static_cast<double>(k);
      if (w > 2. * std::numbers::pi * slowest_hz)
        velocity[k] = record.acceleration[k] / Complex(0., w);
    }
    fine.base_velocity = upsampled(velocity, n, factor);
  }
  return fine;
}

/// What joint laws and relative wind add to the moment, at the record's samples.
std::vector<double> dynamic_part(const Chain& chain, const PreparedRecord& record,
                                 const std::vector<Complex>& joint) {
  // 25 points a period of the first mode keep the exponential rule's error below half a percent
  // of what is added.
  const double wanted_hz =
      25. * chain.structure.modes.front().frequency_rad_s / (2. * std::numbers::pi);
  const auto factor =
      static_cast<std::size_t>(std::clamp(std::ceil(wanted_hz / record.sampling_rate_hz), 1., 16.));
  const FineSignals fine = fine_signals(chain, record, joint, factor);
  const double dt = 1. / (record.sampling_rate_hz * static_cast<double>(factor));
  DifferenceIntegrator integrator(chain, record, dt);
  const RelativeWind& relative = chain.relative_wind;
  const double wind_gain = chain.structure.modes.front().wind_gain * chain.drag_factor;
  const std::size_t n_fine = fine.y.size();
  std::vector<double> out(record.n_samples);
  // The record's own clock starts at its first sample: before it slow changes stand still.
  const auto run = [&](std::size_t from, bool keep) {
    for (std::size_t i = from; i < n_fine; ++i) {
      const auto load = [&](double rate) {
        if (fine.wind.empty()) return 0.;
        const double u = fine.wind[i];
        const double v = fine.base_velocity[i] + relative.velocity_per_moment_rate * rate;
        return wind_gain * ((u - v) * std::abs(u - v) - u * std::abs(u));
      };
      const double t_s = keep ? static_cast<double>(i) * dt : 0.;
      const double added = integrator.advance(fine.y[i], fine.y_rate[i], t_s, load);
      if (keep && i % factor == 0) out[i / factor] = added;
    }
  };
  // A periodic record is in steady state: its last part goes before it.
  if (record.periodic) run(n_fine / 2, false);
  run(0, true);
  return out;
}

/// Reading at t (1 + e) of a series given on a four times finer grid, by cubic interpolation.
std::vector<double> reclocked(std::span<const Complex> spectrum, std::size_t n, double rate_error) {
  constexpr std::size_t factor = 4;
  const std::vector<double> fine = upsampled(spectrum, n, factor);
  std::vector<double> out(n);
  const auto size = static_cast<std::ptrdiff_t>(fine.size());
  for (std::size_t i = 0; i < n; ++i) {
    const double place = static_cast<double>(i * factor) * (1. + rate_error);
    const double floor = std::floor(place), x = place - floor;
    const auto at = [&](std::ptrdiff_t d) {
      return fine[static_cast<std::size_t>(
          ((static_cast<std::ptrdiff_t>(floor) + d) % size + size) % size)];
    };
    const double a = at(-1), b = at(0), c = at(1), e = at(2);
    out[i] = b + x * (c - a / 3. - b / 2. - e / 6. +
                      x * ((a + c) / 2. - b + x * ((e - a) / 6. + (b - c) / 2.)));
  }
  return out;
}

std::vector<Complex> judged_bins(const PreparedRecord& record, std::vector<Complex> whole) {
  if (record.n_judged == record.n_samples) return {whole.begin() + 1, whole.end() - 1};
  const std::vector<double> samples = samples_of(whole, record.n_samples);
  const std::vector<Complex> part =
      spectrum_of(std::span(samples).subspan(record.first, record.n_judged));
  return {part.begin() + 1, part.end() - 1};
}

Complex line_s(const PreparedRecord& record, std::size_t k) {
  return {0., 2. * std::numbers::pi * record.sampling_rate_hz * static_cast<double>(k) /
                  static_cast<double>(record.n_samples)};
}

struct WholeSpectra {
  std::vector<Complex> moment;
  std::vector<LinearPart> linear;
  std::vector<Complex> sensor;
};

WholeSpectra whole_spectra(const Chain& chain, const PreparedRecord& record) {
  const std::size_t n_lines = record.n_samples / 2 + 1;
  const std::vector<Complex> force = wind_force_spectrum(chain, record);
  const std::optional<JointModel> joint_model = joint_of(chain);
  const Complex static_response =
      chain.structure.has_base ? chain.structure.base_response(0.) : Complex(1.);
  WholeSpectra whole{std::vector<Complex>(n_lines), std::vector<LinearPart>(n_lines),
                     std::vector<Complex>(n_lines)};
  std::vector<Complex> joint(n_lines);
  const bool base = !record.acceleration.empty();
  const bool cross = !chain.cross.empty() && !record.cross_acceleration.empty();
  for (std::size_t k = 0; k < n_lines; ++k) {
    // At zero frequency filters may have poles; means are not judged.
    const Complex s = line_s(record, k);
    const LinearPart part = linear_part(chain, joint_model, static_response, s);
    whole.linear[k] = part;
    whole.sensor[k] = product(chain.sensor, s);
    Complex moment = 0.;
    if (base) moment += part.base * record.acceleration[k];
    if (!force.empty()) moment += part.wind * force[k];
    joint[k] = moment * part.elastic;
    if (cross) moment += sum(chain.cross, s) * record.cross_acceleration[k];
    whole.moment[k] = moment;
  }
  const bool dynamic = is_dynamic(chain, record);
  if (dynamic || !chain.readout.empty()) {
    std::vector<double> samples = samples_of(whole.moment, record.n_samples);
    if (dynamic) {
      const std::vector<double> added = dynamic_part(chain, record, joint);
      for (std::size_t i = 0; i < samples.size(); ++i) samples[i] += added[i];
    }
    for (const auto& law : chain.readout)
      for (double& value : samples) value = law(value);
    whole.moment = spectrum_of(samples);
  }
  for (std::size_t k = 0; k < n_lines; ++k) whole.moment[k] *= whole.sensor[k];
  if (chain.clock_rate_error != 0.)
    whole.moment = spectrum_of(reclocked(whole.moment, record.n_samples, chain.clock_rate_error));
  return whole;
}

}  // namespace

std::vector<Complex> simulate_mean(const Chain& chain, const PreparedRecord& record) {
  return judged_bins(record, whole_spectra(chain, record).moment);
}

Prediction simulate(const Chain& chain, const PreparedRecord& record) {
  WholeSpectra whole = whole_spectra(chain, record);
  Prediction prediction;
  prediction.mean = judged_bins(record, std::move(whole.moment));
  const std::size_t n_bins = record.n_bins();
  const double n = static_cast<double>(record.n_judged);
  prediction.moment_noise.assign(n_bins, n);
  prediction.acceleration_noise.assign(n_bins, 0.);
  if (!record.acceleration.empty())
    for (std::size_t b = 0; b < n_bins; ++b) {
      const std::size_t k = record.whole_line(b);
      prediction.acceleration_noise[b] =
          n * std::norm(whole.linear[k].base * whole.sensor[k]) * record.noise_share[k];
    }
  prediction.own_noise.assign(n_bins, 0.);
  prediction.ramp_variance = chain.ramp_variance_rate * n / record.sampling_rate_hz;
  if (!chain.noise.empty()) {
    const RecordView view{
        .base = record.excitation.base,
        .wind = record.excitation.wind,
        .sampling_rate_hz = record.sampling_rate_hz,
        .n_samples = record.n_judged,
        .wind_speed = record.wind.empty()
                          ? std::span<const double>{}
                          : std::span(record.wind).subspan(record.first, record.n_judged),
        .wind_response = [&](std::size_t k) {
          const std::size_t line = record.whole_line(k - 1);
          return whole.linear[line].wind * whole.sensor[line];
        }};
    for (const NoiseSource& source : chain.noise) source(view, prediction.own_noise);
  }
  return prediction;
}

}  // namespace vibrissa::diagnosis
