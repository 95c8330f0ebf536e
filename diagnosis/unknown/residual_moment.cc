#include "diagnosis/unknown/unknown_cause.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// Response of the quantity before the sensor to a moment of the joint.
Complex response_to_joint(const JointModel& joint, const Complex s) {
  const Complex inertia = joint.changed_inertia(s), spring = joint.changed_stiffness_ratio(s);
  return inertia * joint.share /
         (spring * (1. + (1. - joint.share) * inertia) + joint.share * inertia);
}

/// s at an evaluated bin.
Complex bin_s(const PreparedRecord& record, const std::size_t b) {
  return record.line_s(record.whole_line(b));
}

/// Of all samples, one after the other.
ResidualCurve binned(const std::vector<double>& quantity, const std::vector<double>& moment) {
  constexpr std::size_t n_bins = 31;
  constexpr double fewest = 8.;
  ResidualCurve out;
  if (quantity.empty()) return out;
  const auto [low, high] = std::ranges::minmax(quantity);
  const double reach = std::max(-low, high);
  std::vector<double> n(n_bins, 0.), sum(n_bins, 0.), squares(n_bins, 0.);
  for (std::size_t i = 0; i < quantity.size(); ++i) {
    const double place = 0.5 * (quantity[i] / reach + 1.) * static_cast<double>(n_bins);
    const std::size_t b = std::min(n_bins - 1, static_cast<std::size_t>(std::max(0., place)));
    n[b] += 1.;
    sum[b] += moment[i];
    squares[b] += moment[i] * moment[i];
  }
  for (std::size_t b = 0; b < n_bins; ++b) {
    if (n[b] < fewest) continue;
    const double mean = sum[b] / n[b];
    out.x.push_back((2. * (static_cast<double>(b) + 0.5) / static_cast<double>(n_bins) - 1.) *
                    reach);
    out.mean.push_back(mean);
    out.deviation.push_back(std::sqrt(std::max(0., squares[b] / n[b] - mean * mean)));
  }
  return out;
}

}  // namespace

ResidualMoment residual_moment(const Experiment& experiment, const Chain& chain) {
  const std::optional<JointModel> joint = joint_of(chain);
  if (!joint) return {};
  std::vector<double> all_moments, all_angles, all_rates;
  const auto means = ChainSimulator(chain).means(experiment.records);
  LinearResponse response(chain);
  double largest = 0.;
  for (const PreparedRecord& record : experiment.records)
    for (std::size_t b = 0; b < record.n_bins(); ++b)
      largest = std::max(largest, std::abs(response_to_joint(*joint, bin_s(record, b))));
  constexpr double least = 0.1;
  for (std::size_t r = 0; r < experiment.records.size(); ++r) {
    const PreparedRecord& record = experiment.records[r];
    if (!record.excitation.base && !record.excitation.wind) continue;
    std::vector<Complex> moment(record.n_bins()), angle(record.n_bins()), rate(record.n_bins());
    for (std::size_t b = 0; b < record.n_bins(); ++b) {
      const Complex s = bin_s(record, b), to_joint = response_to_joint(*joint, s);
      const LinearPart part = response.at(s, record.readout, record.magnet);
      if (std::abs(to_joint) >= least * largest)
        moment[b] = (record.moment[b] - means[r][b]) / (to_joint * part.sensor) /
                    experiment.scales.joint_moment_n_m;
      angle[b] = record.moment[b] / part.sensor * part.elastic / experiment.scales.joint_moment_n_m;
      rate[b] = angle[b] * s / experiment.scales.first_mode_rad_s;
    }
    const auto append = [&](const std::vector<Complex>& bins, std::vector<double>& to) {
      const std::vector<double> samples = evaluated_samples(record, bins);
      to.insert(to.end(), samples.begin(), samples.end());
    };
    append(moment, all_moments);
    append(angle, all_angles);
    append(rate, all_rates);
  }
  return {binned(all_angles, all_moments), binned(all_rates, all_moments)};
}

}  // namespace vibrissa::diagnosis
