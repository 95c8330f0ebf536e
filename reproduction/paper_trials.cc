#include "reproduction/paper_trials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "reproduction/paper_rig.h"
#include "separation/filters/bvrm_separator.h"
#include "separation/filters/fdaf.h"
#include "separation/identification/identify_frequency.h"
#include "separation/metrics/metrics.h"
#include "separation/model/simulation.h"
#include "signals/excitation/multisine.h"

namespace vibrissa::reproduction {

namespace {

constexpr double period_s = 1.;

// Ten lines with whole periods in one second, spread over the band, one of them near the resonance.
std::vector<double> simulation_lines() {
  return signals::multisine_lines(1., 200., 10, 1. / period_s);
}

separation::Identification identify_in_time(
    const signals::Record& record,
    const separation::IdentifyMethod method = separation::IdentifyMethod::output_error) {
  const auto [fit, held_out] = separation::hold_out_last_third(record);
  separation::IdentifyOptions options;
  options.method = method;
  options.hold = separation::Hold::band_limited;  // as for the motion of the rig between samples
  return separation::identify_bvrm(fit, held_out, options);
}

// One mode and a direct term, fitted to the lines of whole periods. The first period, which
// contains transients, and the last third, which is held out, are not used.
separation::Identification identify_from_periods(const signals::Record& record) {
  const double rate = record.sampling_rate_hz();
  const auto period = static_cast<std::size_t>(period_s * rate);
  const auto [settling_and_fit, held_out] = separation::hold_out_last_third(record, period);
  const auto fit = settling_and_fit.slice(period, settling_and_fit.n_samples() - period);
  separation::FrequencyFitOptions options;
  options.sampling = separation::Sampling{rate, separation::Hold::band_limited};
  separation::Identification identified;
  identified.hold = separation::Hold::band_limited;
  identified.order = options.order;
  identified.fit = separation::identify_frequency(
      signals::periodic_response(fit.channel(signals::channel::base_acceleration),
                                 fit.channel(signals::channel::base_moment), rate, period),
      options);
  const auto moment = held_out.channel(signals::channel::base_moment);
  identified.held_out_fit_percent = separation::fit_percent(
      moment, separation::simulate_like(identified.fit.model,
                                        held_out.channel(signals::channel::base_acceleration),
                                        moment, rate, identified.hold));
  return identified;
}

std::optional<double> convergence_s(const std::vector<double>& estimate,
                                    const std::vector<double>& truth, const double rate_hz) {
  std::vector<double> error(truth.size());
  std::transform(truth.begin(), truth.end(), estimate.begin(), error.begin(), std::minus<>());
  return separation::convergence_time_s(error, rate_hz);
}

double left_early_db(const std::vector<double>& estimate, const sensor_case::RigRecords& records) {
  const double rate = records.both.sampling_rate_hz();
  double left = 0., vibration = 0.;
  for (auto i = static_cast<std::size_t>(0.25 * rate); i < static_cast<std::size_t>(0.5 * rate);
       ++i) {
    left += std::pow(estimate[i] - records.true_wind_moment_n_m[i], 2);
    vibration += std::pow(records.true_vibration_moment_n_m[i], 2);
  }
  return 10. * std::log10(left / vibration);
}

PaperTrial separate(sensor_case::RigRecords records, separation::Identification identified,
                    const separation::FdafOptions& fdaf_options) {
  const auto& record = records.both;
  const double rate = record.sampling_rate_hz();
  separation::BvrmSeparator bvrm(identified.fit.model, rate, identified.hold);
  separation::Fdaf fdaf(fdaf_options);
  const auto scored = [&](separation::Separator& method) {
    return views::score(method.name(), separation::separate_record(method, record), record,
                        records.true_wind_moment_n_m, paper::settling_s);
  };
  const auto measured = record.channel(signals::channel::base_moment);
  std::vector<views::SeparatedSignal> separated = {
      scored(bvrm), scored(fdaf),
      views::score("nothing removed", {measured.begin(), measured.end()}, record,
                   records.true_wind_moment_n_m, paper::settling_s)};
  const auto convergence =
      convergence_s(separated[1].wind_moment_n_m, records.true_wind_moment_n_m, rate);
  const double early_db = left_early_db(separated[1].wind_moment_n_m, records);
  return {std::move(records), std::move(identified), std::move(separated), convergence, early_db};
}

// Share of the energy of the sensor's impulse response after this many taps.
double missing_energy(const signals::ReducedModel& model, const double rate_hz,
                      const std::size_t n_taps) {
  std::vector<double> impulse(4096, 0.);
  impulse[1] = 1.;
  const auto response = signals::simulate(model, {rate_hz, impulse.size(), impulse}).base_moment;
  const auto energy = [](const auto begin, const auto end) {
    double sum = 0.;
    for (auto i = begin; i != end; ++i) sum += *i * *i;
    return sum;
  };
  const auto cut = response.begin() + static_cast<std::ptrdiff_t>(std::min(n_taps, impulse.size()));
  return energy(cut, response.end()) / energy(response.begin(), response.end());
}

}  // namespace

sensor_case::RigRecords paper_simulation_records(const signals::ReducedModel& model) {
  const sensor_case::Case parameters = paper::rig_case(1000., 21.);
  return sensor_case::measure_on_rig(
      model, parameters,
      {paper::multisine(parameters, simulation_lines(), 1.5 * paper::g_m_s2,
                        signals::MultisinePhase::schroeder),
       paper::turbulent_wind(parameters, 0.1)});
}

PaperTrial simulate_paper_simulation(const PaperSensors& sensors) {
  auto records = paper_simulation_records(sensors.flow);
  auto identified = identify_in_time(records.vibration_only);
  return separate(std::move(records), std::move(identified), separation::paper_simulation_fdaf());
}

double held_out_fit_percent(const signals::Record& vibration_only,
                            const separation::IdentifyMethod method) {
  return identify_in_time(vibration_only, method).held_out_fit_percent;
}

PaperTrial simulate_paper_experiment(const PaperSensors& sensors) {
  sensor_case::Case parameters = paper::rig_case(500., 60.);
  parameters.records.accelerometer_noise_m_s2 = paper::accelerometer_noise_m_s2;
  parameters.records.moment_noise_n_m = paper::moment_noise_n_m;
  const std::vector<double> lines_hz = {12., 15., 19., 23., 26., 29.};
  // n S(n) of von Karman's density is largest at n L / U = 0.146; this length scale puts it at 1.6
  // Hz.
  constexpr double length_scale_m = 0.146 * 2. / 1.6;
  auto records =
      sensor_case::measure_on_rig(sensors.built, parameters,
                                  {paper::multisine(parameters, lines_hz, 0.4 * paper::g_m_s2,
                                                    signals::MultisinePhase::ascending),
                                   paper::turbulent_wind(parameters, length_scale_m)});
  auto identified = identify_from_periods(records.vibration_only);
  return separate(std::move(records), std::move(identified), separation::paper_experiment_fdaf());
}

std::vector<FdafReading> compare_fdaf_readings(const PaperSensors& sensors,
                                               const PaperTrial& experiment) {
  const auto& record = experiment.records.both;
  const auto& truth = experiment.records.true_wind_moment_n_m;
  const double rate = record.sampling_rate_hz();
  std::vector<FdafReading> readings;
  const auto add = [&](const std::string& name, const separation::FdafOptions& options) {
    separation::Fdaf fdaf(options);
    const auto scored = views::score(name, separation::separate_record(fdaf, record), record, truth,
                                     paper::settling_s);
    readings.push_back({name, options.block_length, fdaf.n_taps(), options.step.step,
                        *scored.sdr_db, *experiment.separated[2].sdr_db,
                        convergence_s(scored.wind_moment_n_m, truth, rate),
                        static_cast<double>(options.block_length) / (options.step.step * rate),
                        missing_energy(sensors.built, rate, fdaf.n_taps())});
  };
  auto options = separation::paper_experiment_fdaf();
  add("L = 200 is the block, filter covers the ring-down", options);
  options.filter_length = 200;
  add("L = 200 is block and filter", options);
  options = separation::paper_simulation_fdaf();
  add("L = 20 is the block, filter covers the ring-down", options);
  options.filter_length = 20;
  add("L = 20 is block and filter", options);
  return readings;
}

}  // namespace vibrissa::reproduction
