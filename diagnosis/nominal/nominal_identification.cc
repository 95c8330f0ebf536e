#include "diagnosis/nominal/nominal_identification.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "diagnosis/nominal/base_path_identification.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/response_record.h"
#include "diagnosis/records/spectrum.h"
#include "separation/identification/identify_frequency.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

using signals::DatasetRecord;
namespace channel = signals::channel;

/// The records with this excitation and its input: alone, where there are any.
std::vector<const DatasetRecord*> choose(const signals::Dataset& dataset,
                                         bool signals::Excitation::*moved,
                                         const std::string& input) {
  std::vector<const DatasetRecord*> alone, combined;
  for (const DatasetRecord& entry : dataset.records) {
    const signals::Excitation e = entry.excitation;
    if (entry.setup == signals::BenchSetup{} && e.*moved && entry.record.has(input))
      (e.base && e.wind ? combined : alone).push_back(&entry);
  }
  return alone.empty() ? combined : alone;
}

/// What a simulation that holds or interpolates its samples feels of a line (Franklin, Powell,
/// Workman, 3rd ed., 1998, 6.3), without its images above half the sampling rate.
Complex felt(const separation::Hold hold, const Complex s, const double step_s) {
  if (hold == separation::Hold::band_limited || s == 0.) return 1.;
  const Complex x = s * step_s, held = (1. - std::exp(-x)) / x;
  return hold == separation::Hold::zero_order ? held : held * held * std::exp(x);
}

/// One column for each unknown of the wind path: gain and rate of the mode, direct term.
Eigen::MatrixX3cd wind_columns(StructuralMode mode, const PreparedRecord& record,
                               const separation::Hold hold) {
  const std::vector<Complex> force = spectrum_of(signed_squares(record.wind));
  Eigen::MatrixX3cd columns(static_cast<Eigen::Index>(record.n_bins()), 3);
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    mode.wind_gain = c == 0 ? 1. : 0.;
    mode.wind_rate = c == 1 ? 1. : 0.;
    std::vector<Complex> lines = force;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const Complex s = record.line_s(k);
      lines[k] *=
          felt(hold, s, 1. / record.sampling_rate_hz) * (c == 2 ? 1. : mode.wind_response(s));
    }
    const std::vector<Complex> bins = bins_of_lines(record, lines);
    columns.col(c) = Eigen::Map<const Eigen::VectorXcd>(bins.data(), columns.rows());
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
  const std::vector<const DatasetRecord*> entries =
      choose(simulation, &signals::Excitation::wind, channel::wind_speed);
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
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(3, 3);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3);
  double power = 0., measured = 0.;
  const Chain base_only{.structure = without};
  for (const PreparedRecord& record : experiment.records) {
    // Only the mode that the records excite by wind can be identified; the rest is in the direct
    // term.
    const Eigen::MatrixX3cd columns = wind_columns(model.modes.front(), record, hold);
    const std::vector<Complex> left = difference(record.moment, simulate_mean(base_only, record));
    const Eigen::Map<const Eigen::VectorXcd> rest(left.data(), columns.rows());
    normal += (columns.adjoint() * columns).real();
    right += (columns.adjoint() * rest).real();
    power += rest.squaredNorm();
    measured += total_power(record.moment);
  }
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::VectorXd solution =
      scale.asDiagonal() *
      scaled.completeOrthogonalDecomposition().solve(scale.asDiagonal() * right);
  model.modes.front().wind_gain = solution(0);
  model.modes.front().wind_rate = solution(1);
  model.wind_direct = solution(2);
  model.has_wind = true;
  const double left = power - 2. * solution.dot(right) + solution.dot(normal * solution);
  if (measured > 0.) model.wind_misfit = std::sqrt(std::max(0., left) / measured);
}

/// Responses of the sensor as it was simulated, lowest level first.
std::vector<const signals::DatasetResponse*> by_level(const signals::Dataset& dataset) {
  std::vector<const signals::DatasetResponse*> out;
  for (const signals::DatasetResponse& entry : dataset.responses)
    if (entry.setup == signals::BenchSetup{}) out.push_back(&entry);
  std::ranges::stable_sort(out, {}, [](const signals::DatasetResponse* entry) {
    return std::ranges::max(entry->level_m_s2);
  });
  return out;
}

/// Peak of a response, and what one mode of constant resonance would have at the lowest line.
struct Peak {
  double frequency_hz = 0., amplitude = 0., gain = 0.;
  double lowest_hz = 0., lowest_gain = 0.;
};
Peak peak_of(const signals::DatasetResponse& response) {
  const std::vector<Complex> value = as_deflection(response);
  Peak out{.lowest_hz = response.frequency_hz.front(),
           .lowest_gain = std::abs(value.front()) / response.level_m_s2.front()};
  for (std::size_t i = 0; i < value.size(); ++i)
    if (const double gain = std::abs(value[i]) / response.level_m_s2[i]; gain > out.gain) {
      out.frequency_hz = response.frequency_hz[i];
      out.amplitude = std::abs(value[i]);
      out.gain = gain;
    }
  return out;
}

/// The mode at small amplitude from the peaks of all levels, of both directions the higher one: the
/// square of their frequency changes in proportion to that of the amplitude (backbone of a cubic
/// spring; Nayfeh and Mook 1979, sec. 4.1). Its damping from the gain at the lowest peak, relative
/// to that at the lowest line.
std::optional<StructuralMode> mode_of_peaks(
    const std::vector<const signals::DatasetResponse*>& responses) {
  std::map<double, Peak> by_level;
  for (const signals::DatasetResponse* response : responses) {
    const Peak peak = peak_of(*response);
    const bool is_inside = peak.frequency_hz > response->frequency_hz.front() &&
                           peak.frequency_hz < response->frequency_hz.back();
    if (!is_inside) continue;
    Peak& highest = by_level[std::ranges::max(response->level_m_s2)];
    if (peak.amplitude > highest.amplitude) highest = peak;
  }
  if (by_level.empty()) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(by_level.size());
  Eigen::MatrixX2d line(n, 2);
  Eigen::VectorXd square(n);
  Eigen::Index row = 0;
  for (const auto& [level, peak] : by_level) {
    line.row(row) << 1., peak.amplitude * peak.amplitude;
    square(row++) = peak.frequency_hz * peak.frequency_hz;
  }
  const double highest = line.col(1).maxCoeff();
  line.col(1) /= highest;
  const double intercept =
      n > 1 ? Eigen::Vector2d(line.colPivHouseholderQr().solve(square))(0) : square(0);
  const Peak& lowest = by_level.begin()->second;
  const double r = lowest.lowest_hz * lowest.lowest_hz / intercept;
  if (!(intercept > 0.) || !(r < 1.)) return std::nullopt;
  return StructuralMode{.frequency_rad_s = 2. * std::numbers::pi * std::sqrt(intercept),
                        .damping_ratio = 0.5 * lowest.lowest_gain * (1. - r) / lowest.gain};
}

/// All records must have the same readout, because a model predicts one kind of reading.
signals::Readout common_readout(const signals::Dataset& simulation) {
  if (simulation.records.empty())
    return simulation.responses.empty() ? signals::Readout::moment
                                        : readout_of(simulation.responses.front().quantity);
  const DatasetRecord& first = simulation.records.front();
  for (const DatasetRecord& entry : simulation.records)
    if (entry.readout != first.readout)
      throw signals::UserError("the simulation's records '" + first.name + "' and '" + entry.name +
                               "' differ in their readout: give all as moment or all as rotation");
  return first.readout;
}

/// Misfit of the model on the simulation's own records, base alone and with wind.
void set_misfits(NominalModel& model, const signals::Dataset& simulation) {
  struct Misfit {
    double error = 0., power = 0.;
  } base, wind;
  for (const signals::Split split : {signals::Split::fit, signals::Split::held_out}) {
    if (std::ranges::none_of(simulation.records, [&](const DatasetRecord& e) {
          return e.split == split && (e.excitation.base || e.excitation.wind);
        }))
      continue;
    const Experiment experiment =
        prepare_experiment(model, simulation, split, InputNoise::as_measured);
    for (const PreparedRecord& record : experiment.records) {
      Misfit& of = record.excitation.wind ? wind : base;
      of.error +=
          total_power(difference(simulate_mean({.structure = model}, record), record.moment));
      of.power += total_power(record.moment);
    }
  }
  // Records with another behaviour of the input between samples are misfitted by this prediction.
  const auto lower = [](double& misfit, const Misfit& own) {
    if (!(own.power > 0.)) return;
    const double here = std::sqrt(own.error / own.power);
    misfit = misfit > 0. ? std::min(misfit, here) : here;
  };
  lower(model.base_misfit, base);
  lower(model.wind_misfit, wind);
}

NominalModel identified(const signals::Dataset& simulation, const Holds holds) {
  NominalModel model;
  model.readout = common_readout(simulation);
  model.readout_is_given = simulation.records.empty() ? !simulation.responses.empty()
                                                      : simulation.records.front().readout_is_given;
  const auto base = choose(simulation, &signals::Excitation::base, channel::base_acceleration);
  separation::Hold hold = separation::Hold::band_limited;
  if (!base.empty())
    hold = identify_base_path(model, base, holds);
  else if (const auto responses = by_level(simulation); !responses.empty())
    identify_base_path(model, responses);
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
  const auto is_kept_back = [](const auto& entry) { return entry.split != signals::Split::fit; };
  std::erase_if(real.records, is_kept_back);
  std::erase_if(real.responses, is_kept_back);
  if (const auto responses = by_level(real); real.records.empty() && !responses.empty()) {
    if (responses.size() > 1 || !responses.front()->phase_offset_is_known) {
      const auto mode = mode_of_peaks(responses);
      return mode ? std::vector{*mode} : std::vector<StructuralMode>{};
    }
  }
  try {
    constexpr std::array continuous{separation::Hold::band_limited};
    return identified(real, continuous).modes;
  } catch (const signals::UserError&) {
    return {};
  }
}

}  // namespace vibrissa::diagnosis
