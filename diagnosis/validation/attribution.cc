#include "diagnosis/validation/attribution.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <random>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/student.h"

namespace vibrissa::diagnosis {
namespace {

/// More players than this take too long; the others count as always applied.
constexpr std::size_t most_players = 5;

/// Error power in each block in time, all records in turn; and how often each block counts.
using BlockPowers = Eigen::VectorXd;
using Weights = Eigen::VectorXd;

class ErrorOfChanges {
 public:
  ErrorOfChanges(const Experiment& fitted_on, const Experiment& records, const HypothesisFit& fit)
      : fitted_on_(fitted_on), records_(records), fit_(fit), changes_(fit.changes()) {}

  const std::vector<const Effect*>& changes() const { return changes_; }

  /// Power with some of the changes, one flag each.
  const BlockPowers& with(const std::vector<bool>& applied) {
    const auto found = known_.find(applied);
    if (found != known_.end()) return found->second;
    std::vector<double> out;
    const Chain chain = chain_with(applied);
    const auto means = ChainSimulator(chain).means(records_.records);
    for (std::size_t r = 0; r < records_.records.size(); ++r)
      if (records_.records[r].excitation.base || records_.records[r].excitation.wind)
        add_blocks(records_.records[r], difference(records_.records[r].moment, means[r]), out);
    return known_
        .emplace(applied, Eigen::Map<const Eigen::VectorXd>(out.data(),
                                                            static_cast<Eigen::Index>(out.size())))
        .first->second;
  }

 private:
  static void add_blocks(const PreparedRecord& record, const std::vector<Complex>& bins,
                         std::vector<double>& out) {
    const std::vector<double> error = evaluated_samples(record, bins);
    const std::size_t length = record.block_length();
    for (std::size_t i = 0; i < error.size(); ++i) {
      if (i % length == 0) out.push_back(0.);
      out.back() += error[i] * error[i];
    }
  }

  Chain chain_with(const std::vector<bool>& applied) const {
    Chain chain = fitted_on_.nominal_chain();
    if (std::ranges::count(applied, true) > 0) {
      chain.joint_share = fit_.x(index_of_joint_share);
      chain.joint_loss_factor = fit_.x(index_of_joint_loss);
      chain.higher_joint_share = fit_.x(index_of_higher_joint_share);
    }
    for (std::size_t c = 0; c < changes_.size(); ++c) {
      if (!applied[c]) continue;
      std::vector<double> values;
      for (std::size_t i = 0; i < fit_.fit_parameters.size(); ++i)
        if (fit_.fit_parameters[i].effect == changes_[c])
          values.push_back(
              fit_.fit_parameters[i].description.value(fit_.x(static_cast<Eigen::Index>(i))));
      changes_[c]->extend(chain, values, fitted_on_.scales);
    }
    return chain;
  }

  const Experiment& fitted_on_;
  const Experiment& records_;
  const HypothesisFit& fit_;
  std::vector<const Effect*> changes_;
  std::map<std::vector<bool>, BlockPowers> known_;
};

/// All flags have one value but one.
std::vector<bool> but_one(const std::size_t n, const std::size_t one, const bool value) {
  std::vector<bool> out(n, value);
  out[one] = !value;
  return out;
}

/// Does the 95 % interval of a calibration's first parameter exclude the nominal value?
bool has_moved(const HypothesisFit& fit, const Effect& effect) {
  const auto i = static_cast<Eigen::Index>(*fit.index(effect.id, 0));
  const Parameter& parameter = fit.fit_parameters[static_cast<std::size_t>(i)].description;
  const double way = fit.x(i) - parameter.coordinate(parameter.neutral);
  return std::abs(way) > signals::normal_quantile_975 * std::sqrt(fit.covariance(i, i));
}

/// The changes that matter most, with or without the others.
std::vector<std::size_t> players_of(ErrorOfChanges& errors, const double reducible) {
  constexpr double least = 0.002;
  const std::size_t n = errors.changes().size();
  const std::vector<bool> all(n, true), none(n, false);
  const double of_all = errors.with(all).sum(), of_none = errors.with(none).sum();
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t c = 0; c < n; ++c) {
    const double matters = std::max(std::abs(errors.with(but_one(n, c, true)).sum() - of_all),
                                    std::abs(of_none - errors.with(but_one(n, c, false)).sum()));
    if (matters > least * reducible) order.emplace_back(-matters, c);
  }
  std::sort(order.begin(), order.end());
  if (order.size() > most_players) order.resize(most_players);
  std::vector<std::size_t> out;
  for (const auto& [matters, c] : order) out.push_back(c);
  return out;
}

std::vector<double> shares_in(ErrorOfChanges& errors, const std::vector<std::size_t>& players,
                              const Weights& weights, const double reducible) {
  const std::size_t n = errors.changes().size();
  std::vector<bool> rest(n, true);
  for (const std::size_t c : players) rest[c] = false;
  const double nothing = errors.with(std::vector<bool>(n, false)).dot(weights);
  return shapley_values(players.size(), [&](std::size_t set) {
    if (set == 0) return 0.;
    std::vector<bool> applied = rest;
    for (std::size_t i = 0; i < players.size(); ++i)
      if ((set >> i & 1) != 0) applied[players[i]] = true;
    return (nothing - errors.with(applied).dot(weights)) / reducible;
  });
}

/// Percentile intervals of the shares over resampled blocks.
void set_intervals(ErrorOfChanges& errors, const std::vector<std::size_t>& players,
                   const Eigen::Index n_blocks, const double noise_per_block, Attribution& out) {
  constexpr std::size_t n_resamples = 200;
  constexpr Eigen::Index fewest_blocks = 8;
  if (n_blocks < fewest_blocks) return;
  std::mt19937_64 random(1);
  std::uniform_int_distribution<Eigen::Index> pick(0, n_blocks - 1);
  std::vector<std::vector<double>> values(players.size());
  const std::vector<bool> none(errors.changes().size(), false);
  for (std::size_t i = 0; i < n_resamples; ++i) {
    Weights weights = Weights::Zero(n_blocks);
    for (Eigen::Index block = 0; block < n_blocks; ++block) weights(pick(random)) += 1.;
    const double reducible =
        errors.with(none).dot(weights) - noise_per_block * static_cast<double>(n_blocks);
    if (!(reducible > 0.)) continue;
    const std::vector<double> shares = shares_in(errors, players, weights, reducible);
    for (std::size_t p = 0; p < players.size(); ++p) values[p].push_back(shares[p]);
  }
  for (std::size_t p = 0; p < players.size(); ++p) {
    if (values[p].size() < n_resamples / 2) continue;
    std::sort(values[p].begin(), values[p].end());
    const double last = static_cast<double>(values[p].size() - 1);
    out.changes[p].share_ci95 = {values[p][static_cast<std::size_t>(0.025 * last)],
                                 values[p][static_cast<std::size_t>(0.975 * last)]};
  }
}

}  // namespace

std::vector<double> shapley_values(const std::size_t n,
                                   const std::function<double(std::size_t)>& worth) {
  const std::size_t n_sets = std::size_t{1} << n;
  std::vector<double> worths(n_sets), values(n, 0.);
  for (std::size_t set = 0; set < n_sets; ++set) worths[set] = worth(set);
  for (std::size_t set = 0; set < n_sets; ++set) {
    const auto size = static_cast<std::size_t>(std::popcount(set));
    for (std::size_t i = 0; i < n; ++i)
      // size! (n - size - 1)! / n!
      if ((set >> i & 1) == 0)
        values[i] += std::beta(static_cast<double>(size) + 1., static_cast<double>(n - size)) *
                     (worths[set | std::size_t{1} << i] - worths[set]);
  }
  return values;
}

Attribution attribute_gap(const Experiment& fitted_on, const Experiment& records,
                          const HypothesisFit& fit) {
  Attribution out;
  ErrorOfChanges errors(fitted_on, records, fit);
  const std::size_t n = errors.changes().size();
  out.error = score_held_out(fitted_on, records, fit, {.n_resamples = 0}).overall;
  const ErrorScore& score = out.error;
  const BlockPowers before = errors.with(std::vector<bool>(n, false));
  const double whole = before.sum(),
               noise = whole * std::min(1., std::pow(score.noise_floor / score.nrmse_before, 2)),
               reducible = whole - noise;
  if (!(reducible > 0.)) return out;
  out.reducible = std::pow(score.nrmse_before, 2) - std::pow(score.noise_floor, 2);
  const double left = errors.with(std::vector<bool>(n, true)).sum();
  out.unexplained = std::max(
      0., (std::pow(score.nrmse_after, 2) - std::pow(score.irreducible_floor, 2)) / out.reducible);
  const std::vector<std::size_t> players = players_of(errors, reducible);
  const std::vector<double> shares =
      shares_in(errors, players, Weights::Ones(before.size()), reducible);
  for (std::size_t p = 0; p < players.size(); ++p) {
    const Effect& effect = *errors.changes()[players[p]];
    const std::vector<bool> alone = but_one(n, players[p], false),
                            but = but_one(n, players[p], true);
    const bool nuisance = !fit.hypothesis.contains(effect.id);
    out.changes.push_back({.id = effect.id,
                           .calibration = effect.calibration,
                           .moved = !nuisance || has_moved(fit, effect),
                           .alone = (whole - errors.with(alone).sum()) / reducible,
                           .share = shares[p],
                           .missed = (errors.with(but).sum() - left) / reducible,
                           .parameters = parameter_estimates(fit, effect.id)});
  }
  set_intervals(errors, players, before.size(), noise / static_cast<double>(before.size()), out);
  std::ranges::stable_sort(out.changes, std::ranges::greater(), &AttributedChange::share);
  return out;
}

std::vector<std::string> named_calibrations(const Attribution& attribution, const double accuracy) {
  std::vector<std::string> out;
  if (attribution.reducible < power_without_cause(accuracy)) return out;
  for (const AttributedChange& change : attribution.changes)
    if (const double closes = std::max(change.share, change.missed);
        change.moved && closes >= least_share &&
        closes * attribution.reducible >= accuracy * accuracy &&
        std::ranges::count(nuisance_ids(), change.id) > 0)
      out.push_back(change.id);
  std::ranges::sort(out);
  return out;
}

}  // namespace vibrissa::diagnosis
