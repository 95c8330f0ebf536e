#include "diagnosis/nominal/nominal_identification.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "diagnosis/nominal/base_path_identification.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"
#include "separation/identification/identify_frequency.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

using signals::DatasetRecord;
namespace channel = signals::channel;

std::vector<const DatasetRecord*> choose(const signals::Dataset& dataset, bool base, bool wind) {
  std::vector<const DatasetRecord*> alone, combined;
  for (const DatasetRecord& entry : dataset.records) {
    const signals::Excitation e = entry.excitation;
    if (entry.setup != signals::BenchSetup{}) continue;
    if (base && !e.base) continue;
    if (wind && !e.wind) continue;
    if (base && !entry.record.has(channel::base_acceleration)) continue;
    if (wind && !entry.record.has(channel::wind_speed)) continue;
    (e.base && e.wind ? combined : alone).push_back(&entry);
  }
  return alone.empty() ? combined : alone;
}

std::vector<double> signed_squares(std::span<const double> wind) {
  std::vector<double> out(wind.begin(), wind.end());
  for (double& u : out) u *= std::abs(u);
  return out;
}

/// What a simulation that holds or interpolates its samples feels of a line (Franklin, Powell,
/// Workman, 3rd ed., 1998, 6.3), without its images above half the sampling rate.
Complex felt(const separation::Hold hold, const Complex s, const double step_s) {
  if (hold == separation::Hold::band_limited || s == 0.) return 1.;
  const Complex x = s * step_s, held = (1. - std::exp(-x)) / x;
  return hold == separation::Hold::zero_order ? held : held * held * std::exp(x);
}

/// One column for each unknown of the wind path: gain and rate of each mode, direct term.
Eigen::MatrixXcd wind_columns(const NominalModel& model, const PreparedRecord& record,
                              const separation::Hold hold) {
  std::vector<Complex> spectrum = spectrum_of(signed_squares(record.wind));
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    spectrum[k] *= felt(hold, record.line_s(k), 1. / record.sampling_rate_hz);
  const auto n_modes = static_cast<Eigen::Index>(model.modes.size());
  const auto n_bins = static_cast<Eigen::Index>(record.n_bins());
  Eigen::MatrixXcd columns(n_bins, 2 * n_modes + 1);
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    std::vector<Complex> whole(spectrum.size());
    for (std::size_t k = 0; k < whole.size(); ++k) {
      const Complex s = record.line_s(k);
      Complex response = 1.;
      if (c < 2 * n_modes) {
        StructuralMode mode = model.modes[static_cast<std::size_t>(c / 2)];
        mode.wind_gain = c % 2 == 0 ? 1. : 0.;
        mode.wind_rate = c % 2 == 0 ? 0. : 1.;
        response = mode.wind_response(s);
      }
      whole[k] = response * spectrum[k];
    }
    const std::vector<Complex> bins = bins_of_lines(record, whole);
    for (Eigen::Index b = 0; b < n_bins; ++b) columns(b, c) = bins[static_cast<std::size_t>(b)];
  }
  return columns;
}

/// Without a base path the wind's own response gives the poles.
void set_wind_poles(NominalModel& model, const std::vector<const DatasetRecord*>& entries) {
  const signals::Record& record = entries.front()->record;
  const std::vector<double> force = signed_squares(record.channel(channel::wind_speed));
  const auto response = signals::welch_response(force, record.channel(channel::base_moment),
                                                record.sampling_rate_hz(),
                                                {std::min<std::size_t>(1024, force.size() / 4)});
  const auto fit = separation::identify_frequency(response, {.order = 2});
  for (const separation::ModalTerm& term : fit.model.modes)
    model.modes.push_back(
        {.frequency_rad_s = std::sqrt(term.a0), .damping_ratio = term.damping_ratio()});
}

void set_wind_path(NominalModel& model, const signals::Dataset& simulation,
                   const separation::Hold hold) {
  const std::vector<const DatasetRecord*> entries = choose(simulation, false, true);
  if (entries.empty()) return;
  if (model.modes.empty()) set_wind_poles(model, entries);
  NominalModel without = model;
  signals::Dataset dataset;
  for (const DatasetRecord* entry : entries) {
    dataset.records.push_back(*entry);
    dataset.records.back().split = signals::Split::fit;
  }
  without.has_wind = true;
  const Experiment experiment =
      prepare_experiment(without, dataset, signals::Split::fit, InputNoise::as_measured);
  // Only modes that the records excite by wind can be identified; the rest is in the direct term.
  NominalModel in_band = model;
  in_band.modes.resize(1);
  const Eigen::Index n_unknowns = 3;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n_unknowns, n_unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n_unknowns);
  double power = 0., measured = 0.;
  Chain base_only{.structure = without};
  for (const PreparedRecord& record : experiment.records) {
    const Eigen::MatrixXcd columns = wind_columns(in_band, record, hold);
    const std::vector<Complex> base = simulate_mean(base_only, record);
    Eigen::VectorXcd rest(columns.rows());
    for (Eigen::Index b = 0; b < rest.size(); ++b)
      rest(b) = record.moment[static_cast<std::size_t>(b)] - base[static_cast<std::size_t>(b)];
    normal += (columns.adjoint() * columns).real();
    right += (columns.adjoint() * rest).real();
    power += rest.squaredNorm();
    measured += total_power(record.moment);
  }
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled =
      scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const Eigen::VectorXd solution =
      scale.cwiseInverse().asDiagonal() *
      scaled.completeOrthogonalDecomposition().solve(scale.cwiseInverse().asDiagonal() * right);
  model.modes.front().wind_gain = solution(0);
  model.modes.front().wind_rate = solution(1);
  model.wind_direct = solution(2);
  model.has_wind = true;
  const double left = power - 2. * solution.dot(right) + solution.dot(normal * solution);
  if (measured > 0.) model.wind_misfit = std::sqrt(std::max(0., left) / measured);
}

/// All records must have the same readout, because a model predicts one kind of reading.
signals::Readout readout_of(const signals::Dataset& simulation) {
  if (simulation.records.empty()) return signals::Readout::moment;
  const DatasetRecord& first = simulation.records.front();
  for (const DatasetRecord& entry : simulation.records)
    if (entry.readout != first.readout)
      throw signals::UserError("the simulation's records '" + first.name + "' and '" + entry.name +
                               "' differ in their readout: give all as moment or all as rotation");
  return first.readout;
}

/// Misfit of the model on the simulation's own records, base alone and with wind.
void set_misfits(NominalModel& model, const signals::Dataset& simulation) {
  double base_error = 0., base_power = 0., wind_error = 0., wind_power = 0.;
  for (const signals::Split split : {signals::Split::fit, signals::Split::held_out}) {
    if (std::none_of(simulation.records.begin(), simulation.records.end(),
                     [&](const DatasetRecord& e) {
                       return e.split == split && (e.excitation.base || e.excitation.wind);
                     }))
      continue;
    const Experiment experiment =
        prepare_experiment(model, simulation, split, InputNoise::as_measured);
    for (const PreparedRecord& record : experiment.records) {
      const std::vector<Complex> mean = simulate_mean({.structure = model}, record);
      double error = 0., power = 0.;
      for (std::size_t b = 0; b < mean.size(); ++b) {
        error += std::norm(mean[b] - record.moment[b]);
        power += std::norm(record.moment[b]);
      }
      (record.excitation.wind ? wind_error : base_error) += error;
      (record.excitation.wind ? wind_power : base_power) += power;
    }
  }
  // Records with another behaviour of the input between samples are misfitted by this prediction.
  if (base_power > 0.)
    model.base_misfit = model.base_misfit > 0.
                            ? std::min(model.base_misfit, std::sqrt(base_error / base_power))
                            : std::sqrt(base_error / base_power);
  if (wind_power > 0.)
    model.wind_misfit = std::min(model.wind_misfit, std::sqrt(wind_error / wind_power));
}

NominalModel identified(const signals::Dataset& simulation, const Holds holds) {
  NominalModel model;
  model.readout = readout_of(simulation);
  model.readout_is_given =
      !simulation.records.empty() && simulation.records.front().readout_is_given;
  const auto base = choose(simulation, true, false);
  const separation::Hold hold =
      base.empty() ? separation::Hold::band_limited : identify_base_path(model, base, holds);
  set_wind_path(model, simulation, hold);
  if (!model.has_base && !model.has_wind)
    throw signals::UserError(
        "the simulation's records determine neither the base nor the wind response: at least one "
        "needs excitation \"base\" with base_acceleration_m_s2 or \"wind\" with wind_speed_m_s");
  return model;
}

}  // namespace

NominalModel identify_nominal(const signals::Dataset& simulation) {
  // Simulations hold their input, interpolate it linearly or sample a continuous motion.
  constexpr std::array holds{separation::Hold::band_limited, separation::Hold::first_order,
                             separation::Hold::zero_order};
  NominalModel model = identified(simulation, holds);
  set_misfits(model, simulation);
  return model;
}

std::vector<StructuralMode> measured_modes(signals::Dataset real) {
  std::erase_if(real.records, [](const signals::DatasetRecord& entry) {
    return entry.split != signals::Split::fit;
  });
  try {
    constexpr std::array continuous{separation::Hold::band_limited};
    return identified(real, continuous).modes;
  } catch (const signals::UserError&) {
    return {};
  }
}

}  // namespace vibrissa::diagnosis
