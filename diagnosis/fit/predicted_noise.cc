#include "diagnosis/fit/predicted_noise.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "diagnosis/records/evaluated_samples.h"
#include "diagnosis/records/frequency_block.h"

namespace vibrissa::diagnosis {
namespace {

constexpr Eigen::Index n_regressors = 2;

/// Spectra of wind speed and of its square in the evaluated bins.
std::array<std::vector<Complex>, n_regressors> wind_bins(const PreparedRecord& record) {
  std::vector<double> square = record.wind;
  for (double& value : square) value *= value;
  return {evaluated_bins(record, record.wind), evaluated_bins(record, square)};
}

/// Frequency blocks in which process noise exists without wind, too. There the skirts of a tone are
/// as smooth as the wind spectrum, which would seem to predict them.
std::set<std::size_t> windless_blocks(const Experiment& experiment,
                                      const std::span<const WhitenedRecord> records) {
  std::map<std::size_t, std::pair<double, double>> shares;
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (experiment.records[r].excitation.wind) continue;
    for (std::size_t b = 0; b < records[r].own_share.size(); ++b) {
      auto& [own, count] = shares[frequency_block(experiment, experiment.records[r], b)];
      own += records[r].own_share[b];
      count += 1.;
    }
  }
  std::set<std::size_t> blocks;
  for (const auto& [block, share] : shares)
    if (share.first >= least_own_share * share.second) blocks.insert(block);
  return blocks;
}

/// Blocks of neighbouring bins that are large enough for a significant regression.
std::vector<std::vector<std::size_t>> blocks_of(const Experiment& experiment,
                                                const PreparedRecord& record,
                                                const std::set<std::size_t>& left_out) {
  constexpr std::size_t fewest = 8;
  std::vector<std::vector<std::size_t>> blocks;
  std::size_t last = 0;
  for (std::size_t b = 0; b < record.n_bins(); ++b) {
    const std::size_t block = frequency_block(experiment, record, b);
    if (left_out.contains(block)) continue;
    if (blocks.empty() || (block != last && blocks.back().size() >= fewest)) blocks.emplace_back();
    last = block;
    blocks.back().push_back(b);
  }
  return blocks;
}

struct Sums {
  double nats = 0., energy = 0.;

  void add(const Eigen::MatrixXcd& inputs, const Eigen::VectorXcd& error) {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> solver(inputs);
    constexpr double alike = 1e-6;
    solver.setThreshold(alike);
    const Eigen::VectorXcd theta = solver.solve(error);
    nats += (inputs * theta).squaredNorm() - static_cast<double>(solver.rank());
    energy += error.squaredNorm();
  }
};

void add_record(const Experiment& experiment, const PreparedRecord& record,
                const WhitenedRecord& residual, const std::set<std::size_t>& left_out, Sums& sums) {
  const auto wind = wind_bins(record);
  for (const std::vector<std::size_t>& bins : blocks_of(experiment, record, left_out)) {
    const auto n = static_cast<Eigen::Index>(bins.size());
    Eigen::MatrixXcd inputs(n, n_regressors);
    Eigen::VectorXcd error(n);
    double own = 0.;
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t b = bins[static_cast<std::size_t>(i)];
      own += residual.own_share[b];
      error(i) = residual.error[b];
      for (Eigen::Index j = 0; j < n_regressors; ++j)
        inputs(i, j) = wind[static_cast<std::size_t>(j)][b] / residual.deviation[b];
    }
    if (own < least_own_share * static_cast<double>(n) || n <= n_regressors) continue;
    for (Eigen::Index j = 0; j < n_regressors; ++j)
      if (const double norm = inputs.col(j).norm(); norm > 0.) inputs.col(j) /= norm;
    sums.add(inputs, error);
  }
}

}  // namespace

PredictedNoise predicted_noise(const Experiment& experiment,
                               const std::span<const WhitenedRecord> records) {
  Sums sums;
  const std::set<std::size_t> left_out = windless_blocks(experiment, records);
  for (std::size_t r = 0; r < records.size(); ++r)
    if (!experiment.records[r].wind.empty())
      add_record(experiment, experiment.records[r], records[r], left_out, sums);
  if (!(sums.energy > 0.) || !std::isfinite(sums.nats)) return {};
  return {.nats = sums.nats, .share = sums.nats / sums.energy};
}

}  // namespace vibrissa::diagnosis
