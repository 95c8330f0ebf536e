#include "diagnosis/nominal/nominal_identification.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

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
  model.readout = readout_of(simulation);
  model.readout_is_given =
      !simulation.records.empty() && simulation.records.front().readout_is_given;
  const auto base = choose(simulation, &signals::Excitation::base, channel::base_acceleration);
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
