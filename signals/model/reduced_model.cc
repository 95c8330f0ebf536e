#include "signals/model/reduced_model.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "signals/base/error.h"
#include "signals/base/lanes.h"
#include "signals/base/number_text.h"
#include "signals/model/oscillator_step.h"

namespace vibrissa::signals {

namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The model in the axial and the cross direction, each with its moment axis.
struct Plane {
  explicit Plane(const ReducedModel& model)
      : axial(model.axial_direction),
        cross(model.moment_axis()),
        axial_axis(cross),
        cross_axis{-axial[0], -axial[1], -axial[2]} {}

  Vector axial, cross, axial_axis, cross_axis;
};

double rigid_moment(const ReducedModel& model, const Vector& axis, const Vector& direction) {
  double sum = 0.;
  for (std::size_t i = 0; i < 3; ++i) sum += axis[i] * dot(model.rigid_moment[i], direction);
  return sum;
}

/// Position of a speed in the wind table: between two rows, at a fraction of the interval.
struct WindSample {
  std::size_t row = 0, next_row = 0;
  double share = 0.;
  double square = 0.;  // u |u|
};

WindSample locate(const WindLoad& wind, double speed_m_s) {
  const auto& speeds = wind.speed_m_s;
  const auto above = std::ranges::upper_bound(speeds, speed_m_s);
  const auto next = static_cast<std::size_t>(above - speeds.begin());
  WindSample sample;
  sample.square = speed_m_s * std::abs(speed_m_s);
  sample.row = next == 0 ? 0 : next - 1;
  sample.next_row = std::min(next, speeds.size() - 1);
  const double width = speeds[sample.next_row] - speeds[sample.row];
  sample.share = width > 0. ? (speed_m_s - speeds[sample.row]) / width : 0.;
  return sample;
}

double wind_moment(const WindLoad& wind, const WindSample& sample, const Vector& axis) {
  const double low = dot(wind.moment_coefficient[sample.row], axis);
  const double high = dot(wind.moment_coefficient[sample.next_row], axis);
  return (low + sample.share * (high - low)) * sample.square;
}

/// Eight modes in parallel (SIMD). Lanes without a mode stay zero.

struct ModeBlock {
  Lanes qq, qp, pq, pp, q_old, q_new, p_old, p_new, stiffness, damping;  // OscillatorStep
  Lanes axial_participation, cross_participation, axial_moment, cross_moment;
  std::vector<Lanes> wind_coefficient;  // [speed]

  ModeBlock(const ReducedModel& model, std::size_t first_mode, double sampling_rate_hz) {
    for (Lanes* lanes : {&qq, &qp, &pq, &pp, &q_old, &q_new, &p_old, &p_new, &stiffness, &damping,
                         &axial_participation, &cross_participation, &axial_moment, &cross_moment})
      lanes->setZero();
    wind_coefficient.assign(model.wind.speed_m_s.size(), Lanes::Zero());
    const Plane plane(model);
    const std::size_t n_used = std::min<std::size_t>(n_lanes, model.modes.size() - first_mode);
    for (std::size_t lane = 0; lane < n_used; ++lane) {
      const auto index = static_cast<Eigen::Index>(lane);
      const ReducedMode& mode = model.modes[first_mode + lane];
      set_step(index,
               make_oscillator_step(2. * std::numbers::pi * mode.frequency_hz / sampling_rate_hz,
                                    mode.damping_ratio));
      axial_participation[index] = dot(mode.participation, plane.axial);
      cross_participation[index] = dot(mode.participation, plane.cross);
      axial_moment[index] = dot(mode.moment_participation, plane.axial_axis);
      cross_moment[index] = dot(mode.moment_participation, plane.cross_axis);
      for (std::size_t row = 0; row < wind_coefficient.size(); ++row)
        wind_coefficient[row][index] = model.wind.modal_coefficient[row][first_mode + lane];
    }
  }

  void set_step(Eigen::Index lane, const OscillatorStep& step) {
    qq[lane] = step.qq;
    qp[lane] = step.qp;
    pq[lane] = step.pq;
    pp[lane] = step.pp;
    q_old[lane] = step.q_old;
    q_new[lane] = step.q_new;
    p_old[lane] = step.p_old;
    p_new[lane] = step.p_new;
    stiffness[lane] = step.stiffness;
    damping[lane] = step.damping;
  }

  Lanes wind_force(const WindSample& wind) const {
    const Lanes& low = wind_coefficient[wind.row];
    const Lanes& high = wind_coefficient[wind.next_row];
    return (low + wind.share * (high - low)) * wind.square;
  }
};

/// Decayed motion becomes zero: subnormal numbers are about a hundred times slower.
void clear_negligible(Lanes& state) {
  constexpr double negligible = 1e-150;
  state = (state.abs() < negligible).select(0., state);
}

/// Adds sum L (w^2 q + 2 zeta w q' - f) of the modes of one block.
void add_modal_moment(const ModeBlock& modes, const ReducedInput& input,
                      std::span<const WindSample> wind, ReducedOutput& output) {
  const auto axial = input.base_acceleration, cross = input.cross_acceleration;
  Lanes q = Lanes::Zero(), p = Lanes::Zero(), old_force = Lanes::Zero();
  for (std::size_t i = 0; i < input.n_samples; ++i) {
    Lanes force = Lanes::Zero();
    if (!axial.empty()) force -= axial[i] * modes.axial_participation;
    if (!cross.empty()) force -= cross[i] * modes.cross_participation;
    if (!wind.empty()) force += modes.wind_force(wind[i]);
    if (i % 16 == 0) {
      clear_negligible(q);
      clear_negligible(p);
    }
    if (i > 0) {
      // The forces are computed first, to shorten the dependency between two states.
      const Lanes q_forced = modes.q_old * old_force + modes.q_new * force;
      const Lanes p_forced = modes.p_old * old_force + modes.p_new * force;
      const Lanes q_change = modes.qq * q + (modes.qp * p + q_forced);
      p += modes.pq * q + (modes.pp * p + p_forced);
      q += q_change;
    }
    const Lanes excess = modes.stiffness * q + modes.damping * p - force;
    output.base_moment[i] += (modes.axial_moment * excess).sum();
    output.cross_moment[i] += (modes.cross_moment * excess).sum();
    old_force = force;
  }
}

/// The moment of a sensor that follows its base at once: -J a + m(u) u|u|.
void add_static_moment(const ReducedModel& model, const ReducedInput& input,
                       std::span<const WindSample> wind, ReducedOutput& output) {
  const Plane plane(model);
  const auto add = [&](const Vector& axis, std::vector<double>& moment) {
    const auto follow = [&](std::span<const double> acceleration, const Vector& direction) {
      const double rigid = rigid_moment(model, axis, direction);
      for (std::size_t i = 0; i < acceleration.size(); ++i) moment[i] -= rigid * acceleration[i];
    };
    follow(input.base_acceleration, plane.axial);
    follow(input.cross_acceleration, plane.cross);
    for (std::size_t i = 0; i < wind.size(); ++i)
      moment[i] += wind_moment(model.wind, wind[i], axis);
  };
  add(plane.axial_axis, output.base_moment);
  add(plane.cross_axis, output.cross_moment);
}

[[noreturn]] void refuse(const ReducedModel& model, const std::string& what) {
  throw UserError("reduced model '" + model.name + "': " + what);
}

/// Empty without wind.
std::vector<WindSample> wind_samples(const ReducedModel& model, std::span<const double> speed_m_s) {
  if (std::ranges::all_of(speed_m_s, [](double u) { return u == 0.; })) return {};
  if (model.wind.speed_m_s.empty())
    refuse(model,
           "the input has wind, but the model has no wind load; compute the model with a wind "
           "load, or leave the wind out");
  std::vector<WindSample> samples;
  samples.reserve(speed_m_s.size());
  for (const double u : speed_m_s) samples.push_back(locate(model.wind, u));
  return samples;
}

}  // namespace

std::array<double, 3> ReducedModel::moment_axis() const {
  return {-axial_direction[1], axial_direction[0], 0.};
}

void check(const ReducedModel& model, const ReducedInput& input) {
  check(model);
  if (!(input.sampling_rate_hz > 0.) || !std::isfinite(input.sampling_rate_hz))
    refuse(model, "the input's sampling rate " + to_text(input.sampling_rate_hz) +
                      " Hz is not positive and finite");
  const auto check_length = [&](std::span<const double> x, const std::string& name) {
    if (!x.empty() && x.size() != input.n_samples)
      refuse(model, "the input " + name + " has " + std::to_string(x.size()) +
                        " samples instead of " + std::to_string(input.n_samples));
  };
  check_length(input.base_acceleration, "base_acceleration");
  check_length(input.cross_acceleration, "cross_acceleration");
  check_length(input.wind_speed, "wind_speed");
}

ReducedOutput simulate(const ReducedModel& model, const ReducedInput& input) {
  check(model, input);
  const std::vector<WindSample> wind = wind_samples(model, input.wind_speed);
  ReducedOutput output{.base_moment = std::vector<double>(input.n_samples, 0.),
                       .cross_moment = std::vector<double>(input.n_samples, 0.)};
  add_static_moment(model, input, wind, output);
  for (std::size_t first = 0; first < model.modes.size(); first += n_lanes)
    add_modal_moment(ModeBlock(model, first, input.sampling_rate_hz), input, wind, output);
  return output;
}

std::vector<std::complex<double>> base_response(const ReducedModel& model,
                                                std::span<const double> frequency_hz) {
  check(model);
  const Plane plane(model);
  std::vector<std::complex<double>> response;
  response.reserve(frequency_hz.size());
  for (const double f : frequency_hz) {
    std::complex<double> sum = -rigid_moment(model, plane.axial_axis, plane.axial);
    for (const ReducedMode& mode : model.modes) {
      const double ratio = f / mode.frequency_hz;
      const double gain =
          dot(mode.moment_participation, plane.axial_axis) * dot(mode.participation, plane.axial);
      const std::complex<double> resistance(1. - ratio * ratio, 2. * mode.damping_ratio * ratio);
      sum -= gain * ratio * ratio / resistance;
    }
    response.push_back(sum);
  }
  return response;
}

double steady_wind_moment(const ReducedModel& model, double speed_m_s) {
  check(model);
  if (model.wind.speed_m_s.empty())
    refuse(model, "has no wind load, so it has no steady wind moment");
  return wind_moment(model.wind, locate(model.wind, speed_m_s), model.moment_axis());
}

}  // namespace vibrissa::signals
