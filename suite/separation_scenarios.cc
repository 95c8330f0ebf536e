#include "suite/separation_scenarios.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "case/recorded_input.h"
#include "case/rig.h"
#include "reproduction/paper_rig.h"
#include "reproduction/paper_trials.h"
#include "signals/excitation/swept_sine.h"
#include "signals/model/oscillator_step.h"
#include "signals/spectra/fft.h"

namespace vibrissa::suite {

namespace {

namespace fs = std::filesystem;
using signals::channel::base_acceleration;
using signals::channel::base_moment;

constexpr double rate_hz = 500.;

sensor_case::Case rig_case(const ScenarioRig& rig, const double noise_m_s2) {
  sensor_case::Case parameters = reproduction::paper::rig_case(rate_hz, rig.duration_s);
  parameters.records.seed = rig.seed;
  parameters.records.accelerometer_noise_m_s2 = noise_m_s2;
  parameters.records.moment_noise_n_m = reproduction::paper::moment_noise_n_m;
  return parameters;
}

std::size_t n_samples(const ScenarioRig& rig) {
  return rig_case(rig, 0.).records.n_samples();
}

std::vector<double> turbulence(const ScenarioRig& rig) {
  constexpr double length_scale_m = 0.18;  // the spectrum is centred on 1.6 Hz
  return reproduction::paper::turbulent_wind(rig_case(rig, 0.), length_scale_m);
}

std::vector<double> lines(const ScenarioRig& rig, const std::vector<double>& frequency_hz,
                          const double peak_g) {
  return reproduction::paper::multisine(rig_case(rig, 0.), frequency_hz,
                                        peak_g * reproduction::paper::g_m_s2,
                                        signals::MultisinePhase::schroeder);
}

// Repeated sweeps from 5 to 200 Hz in ten seconds, with equal time for each octave.
std::vector<double> swept_sine(const ScenarioRig& rig) {
  const auto sweep = signals::sample({.low_hz = 5.,
                                      .high_hz = 200.,
                                      .peak = 0.4 * reproduction::paper::g_m_s2,
                                      .n_samples = static_cast<std::size_t>(10. * rate_hz)},
                                     rate_hz);
  std::vector<double> a(n_samples(rig));
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = sweep[i % sweep.size()];
  return a;
}

// Half-sine pulses of 20 ms, one to two seconds apart, as if something touches the whisker.
std::vector<double> contacts(const ScenarioRig& rig) {
  std::vector<double> u(n_samples(rig), 0.);
  constexpr std::size_t width = 10;
  for (std::size_t start = 250, k = 0; start + width < u.size(); start += 500 + 37 * (++k % 13)) {
    for (std::size_t i = 0; i <= width; ++i) {
      u[start + i] = 6. * std::sin(std::numbers::pi * static_cast<double>(i) / width);
    }
  }
  return u;
}

Scenario measure(const ScenarioRig& rig, const std::string& name, const std::string& about,
                 sensor_case::Inputs inputs,
                 const double noise_m_s2 = reproduction::paper::accelerometer_noise_m_s2) {
  auto records = sensor_case::measure_on_rig(rig.sensor, rig_case(rig, noise_m_s2), inputs);
  return {name, about, std::move(records.both), std::move(records.true_wind_moment_n_m),
          std::move(records.vibration_only)};
}

const std::vector<double> paper_lines_hz = {12., 15., 19., 23., 26., 29.};
const std::vector<double> broad_lines_hz = {2., 5., 9., 16., 27., 32., 38., 60., 95., 140., 200.};

std::vector<Scenario> noisy_references(const ScenarioRig& rig) {
  std::vector<Scenario> scenarios;
  const auto a = lines(rig, broad_lines_hz, 0.4);
  double power = 0.;
  for (const double x : a) power += x * x / static_cast<double>(a.size());
  for (const int snr_db : {0, 10, 20, 30, 40}) {
    scenarios.push_back(measure(rig, "reference at " + std::to_string(snr_db) + " dB",
                                "accelerometer noise at this level below the vibration",
                                {a, turbulence(rig)},
                                std::sqrt(power * std::pow(10., -0.1 * snr_db))));
  }
  return scenarios;
}

// The accelerometer measures nothing above 40 Hz, although the vibration continues there.
void remove_high_band(signals::Record& record) {
  const auto a = record.channel(base_acceleration);
  signals::RealFft fft(a.size());
  std::copy(a.begin(), a.end(), fft.time().begin());
  fft.forward();
  for (std::size_t k = 0; k < fft.spectrum().size(); ++k) {
    const double frequency_hz = static_cast<double>(k) * rate_hz / static_cast<double>(a.size());
    fft.spectrum()[k] *= frequency_hz > 40. ? 0. : 1.;
  }
  fft.inverse();
  record.set_channel(base_acceleration, {fft.time().begin(), fft.time().end()});
}

Scenario missing_band(const ScenarioRig& rig) {
  auto scenario =
      measure(rig, "missing reference band", "the accelerometer measures nothing above 40 Hz",
              {lines(rig, broad_lines_hz, 0.4), turbulence(rig)});
  remove_high_band(scenario.record);
  remove_high_band(*scenario.vibration_only);
  return scenario;
}

// The model is identified before the sensor softens, and used while it softens.
Scenario drifting(const ScenarioRig& rig) {
  const auto a = lines(rig, broad_lines_hz, 0.4);
  auto scenario =
      measure(rig, "drifting resonance", "the first resonance falls by 5 % during the record",
              {a, turbulence(rig)});
  const auto fixed = signals::simulate(rig.sensor, {rate_hz, a.size(), a}).base_moment;
  const auto moved =
      drifting_moment(rig.sensor, 0.95 * rig.sensor.modes[0].frequency_hz, a, rate_hz);
  const auto measured = scenario.record.channel(base_moment);
  std::vector<double> moment(measured.begin(), measured.end());
  for (std::size_t i = 0; i < moment.size(); ++i) moment[i] += moved[i] - fixed[i];
  scenario.record.set_channel(base_moment, std::move(moment));
  return scenario;
}

sensor_case::RecordedInput recording(const fs::path& file, const std::string& column,
                                     const double recorded_hz) {
  sensor_case::RecordedInput input;
  input.file = file;
  input.column = column;
  input.sampling_rate_hz = recorded_hz;
  input.remove_mean = true;
  return input;
}

bool is_there(const ScenarioRig& rig, const fs::path& file, const std::string& scenario,
              std::vector<std::string>& left_out) {
  if (!rig.recordings.empty() && fs::exists(rig.recordings / file)) return true;
  left_out.push_back(scenario + ": the file " + file.string() +
                     " is missing in the folder of recordings (--recordings)");
  return false;
}

void add_recorded(const ScenarioRig& rig, std::vector<Scenario>& scenarios,
                  std::vector<std::string>& left_out) {
  const fs::path bus = "transit_vehicle_vibration_500Hz/L83_4940_Alexyho_Svantnerova.csv";
  const fs::path tunnel = "wind_tunnel_velocity_1000Hz/z100mm.csv";
  const fs::path drone = "drone_imu_euroc_200Hz/imu0_first120s.csv";
  if (is_there(rig, bus, "bus and tunnel", left_out) &&
      is_there(rig, tunnel, "bus and tunnel", left_out)) {
    ScenarioRig short_rig = rig;
    short_rig.duration_s = std::min(rig.duration_s, 23.12);  // the wind's first whole record
    auto wind = recording(rig.recordings / tunnel, "u_mps", 1000.);
    wind.remove_mean = false;
    wind.n_rows = 23120;
    auto u =
        sensor_case::load_input(wind, signals::channel::wind_speed, rate_hz, n_samples(short_rig));
    const double highest = *std::max_element(u.begin(), u.end());
    for (double& speed : u) speed *= 4. / highest;
    scenarios.push_back(measure(
        short_rig, "bus and tunnel", "recorded vibration of a bus, recorded wind up to 4 m/s",
        {sensor_case::load_input(recording(rig.recordings / bus, "z_mps2", 500.), base_acceleration,
                                 rate_hz, n_samples(short_rig)),
         std::move(u)}));
  }
  if (is_there(rig, drone, "drone", left_out)) {
    scenarios.push_back(
        measure(rig, "drone", "recorded vibration of a drone, turbulent wind",
                {sensor_case::load_input(recording(rig.recordings / drone, "acc_x_mps2", 200.),
                                         base_acceleration, rate_hz, n_samples(rig)),
                 turbulence(rig)}));
  }
}

double along(const std::array<double, 3>& x, const std::array<double, 3>& axis) {
  return x[0] * axis[0] + x[1] * axis[1] + x[2] * axis[2];
}

}  // namespace

std::vector<double> drifting_moment(const signals::ReducedModel& model, const double last_hz,
                                    const std::vector<double>& acceleration,
                                    const double sampling_rate_hz) {
  const auto& mode = model.modes.front();
  const double participation = along(mode.participation, model.axial_direction);
  const double lever = along(mode.moment_participation, model.moment_axis());
  signals::ReducedModel rest = model;
  rest.modes.erase(rest.modes.begin());
  for (auto& at_speed : rest.wind.modal_coefficient) at_speed.erase(at_speed.begin());
  rest.sensitivities.clear();
  auto moment =
      signals::simulate(rest, {sampling_rate_hz, acceleration.size(), acceleration}).base_moment;
  double q = 0., p = 0.;  // scaled by the step, see OscillatorStep
  const double h = 1. / sampling_rate_hz;
  for (std::size_t i = 0; i < moment.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(moment.size());
    const double f_hz = mode.frequency_hz + share * (last_hz - mode.frequency_hz);
    const auto step =
        signals::make_oscillator_step(2. * std::numbers::pi * f_hz * h, mode.damping_ratio);
    // The static part of this mode, which the other modes' response contains, is subtracted.
    moment[i] += lever * (step.stiffness * q + step.damping * p + participation * acceleration[i]);
    const double f0 = -participation * acceleration[i];
    const double f1 = i + 1 < moment.size() ? -participation * acceleration[i + 1] : f0;
    const double dq = step.qq * q + step.qp * p + step.q_old * f0 + step.q_new * f1;
    p += step.pq * q + step.pp * p + step.p_old * f0 + step.p_new * f1;
    q += dq;
  }
  return moment;
}

std::vector<Scenario> make_scenarios(const ScenarioRig& rig, std::vector<std::string>& left_out) {
  std::vector<Scenario> scenarios;
  auto simulation = reproduction::paper_simulation_records(rig.simulated_sensor);
  scenarios.push_back({"paper's simulation", "1 kHz, no noise, ten lines up to 1.5 g, turbulence",
                       std::move(simulation.both), std::move(simulation.true_wind_moment_n_m),
                       std::move(simulation.vibration_only)});
  scenarios.push_back(measure(rig, "paper's experiment", "six lines from 12 to 29 Hz, turbulence",
                              {lines(rig, paper_lines_hz, 0.4), turbulence(rig)}));
  scenarios.push_back(measure(rig, "broad multisine", "eleven lines from 2 to 200 Hz, turbulence",
                              {lines(rig, broad_lines_hz, 0.4), turbulence(rig)}));
  add_recorded(rig, scenarios, left_out);
  scenarios.push_back(measure(rig, "swept sine", "5 to 200 Hz in ten seconds, turbulence",
                              {swept_sine(rig), turbulence(rig)}));
  scenarios.push_back(measure(rig, "contacts", "half-sine contact pulses of 20 ms as the stimulus",
                              {lines(rig, broad_lines_hz, 0.4), contacts(rig)}));
  for (auto& scenario : noisy_references(rig)) scenarios.push_back(std::move(scenario));
  scenarios.push_back(missing_band(rig));
  scenarios.push_back(drifting(rig));
  return scenarios;
}

}  // namespace vibrissa::suite
