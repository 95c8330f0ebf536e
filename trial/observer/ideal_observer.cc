#include "trial/observer/ideal_observer.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "trial/classes/circumstances.h"
#include "trial/generator/detection_limit.h"
#include "trial/generator/gap_share.h"
#include "trial/observer/box_integral.h"

namespace vibrissa::trial {
namespace {

/// Probabilities and sets, the most probable first.
using Posterior = IdealObserver::Posterior;

constexpr double widest_step = 2., held = 0.95;

/// Position of a size on a ladder, and the signature there.
struct LadderOnBench {
  const EffectLadder* ladder;
  std::vector<Eigen::VectorXd> signatures;
  double power() const { return ladder->unknown->random ? 2. : 1.; }

  Eigen::VectorXd at(const double size) const {
    const std::vector<double>& sizes = ladder->sizes;
    if (sizes.size() == 1) return signatures.front();
    const auto above = std::upper_bound(sizes.begin() + 1, sizes.end() - 1, size);
    const auto i = static_cast<std::size_t>(above - sizes.begin()) - 1;
    const double t = std::log(size / sizes[i]) / std::log(sizes[i + 1] / sizes[i]);
    return (1. - t) * std::pow(size / sizes[i], power()) * signatures[i] +
           t * std::pow(size / sizes[i + 1], power()) * signatures[i + 1];
  }
  /// Root of the moment's power at a size; 0 where the effect changes variances alone.
  double amplitude(const double size) const {
    if (ladder->unknown->random) return 0.;
    const std::vector<double>& sizes = ladder->sizes;
    const auto above = std::lower_bound(sizes.begin(), sizes.end() - 1, size);
    return std::sqrt(
               power_of(ladder->changes[static_cast<std::size_t>(above - sizes.begin())].moment)) *
           size / *above;
  }
  /// Detection limit; nothing when the largest size stays below it. Below the ladder a signature is
  /// extrapolated by a power law.
  std::optional<double> limit(const ObservedBench& bench) const {
    if (signatures.back().squaredNorm() < half_power_at_one_percent) return std::nullopt;
    double low = 1e-3 * ladder->sizes.front(), high = ladder->sizes.back();
    while (high > low * (1. + 1e-4)) {
      const double middle = std::sqrt(low * high);
      (at(middle).squaredNorm() < half_power_at_one_percent ? low : high) = middle;
    }
    World plain;
    plain.acceleration_noise = bench.acceleration_noise;
    const auto& hidden = ladder->unknown->hidden_below;
    return hidden ? std::max(high, hidden(plain)) : high;
  }
};

LadderOnBench on_bench(const EffectLadder& ladder, const std::vector<double>& noise,
                       const WidenedNoise& widened) {
  LadderOnBench out{.ladder = &ladder, .signatures = {}};
  for (const LineChange& change : ladder.changes)
    out.signatures.emplace_back(widened.whitened(signature_of(change, noise)));
  return out;
}

std::size_t number_of(const Unknown& unknown) {
  return static_cast<std::size_t>(&unknown - named_unknowns().data());
}

/// Logarithm of a sum of exponentials, added term by term.
class LogSum {
 public:
  void add(const double x) {
    if (x <= largest_) {
      if (x > largest_ - 40.) sum_ += std::exp(x - largest_);
    } else {
      sum_ = 1. + sum_ * std::exp(largest_ - x);
      largest_ = x;
    }
  }
  double value() const { return largest_ + std::log(sum_); }

 private:
  double largest_ = -std::numeric_limits<double>::infinity(), sum_ = 0.;
};

/// Posterior of all sets of up to three effects.
class Sets {
 public:
  Sets(std::size_t n, const std::array<double, 4>& log_asked)
      : n_(n + 1), log_asked_(log_asked), sums_(n_ * n_ * n_) {}
  /// evidence: returns the log evidence, or an upper bound when that is below the given threshold.
  template <std::size_t n, class Evidence>
  void add(std::array<std::size_t, n> unknowns, double log_prior, const Evidence& evidence) {
    if (!std::isfinite(log_asked_[n])) return;
    std::sort(unknowns.begin(), unknowns.end());
    std::size_t place = 0;
    for (const std::size_t unknown : unknowns) place = place * n_ + unknown + 1;
    const double prior = log_asked_[n] + log_prior;
    const double x = prior + evidence(largest_ - negligible - prior);
    largest_ = std::max(largest_, x);
    sums_[place].add(x);
  }
  Posterior posterior() const;

 private:
  static constexpr double negligible = 30.;
  std::size_t n_;
  std::array<double, 4> log_asked_;
  double largest_ = -std::numeric_limits<double>::infinity();
  std::vector<LogSum> sums_;
};

Posterior Sets::posterior() const {
  LogSum all;
  for (const LogSum& sum : sums_)
    if (std::isfinite(sum.value())) all.add(sum.value());
  Posterior out;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    if (!std::isfinite(sums_[i].value())) continue;
    std::vector<std::size_t> unknowns;
    for (std::size_t rest = i; rest > 0; rest /= n_)
      unknowns.insert(unknowns.begin(), rest % n_ - 1);
    out.emplace_back(std::exp(sums_[i].value() - all.value()), std::move(unknowns));
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  return out;
}

}  // namespace

IdealObserver::IdealObserver(const std::vector<EffectLadder>& ladders,
                             const std::vector<double>& noise, const ObservedBench& bench,
                             const std::vector<LineChange>& unknown,
                             std::vector<std::size_t> block_ends)
    : bench_(bench), block_ends_(std::move(block_ends)) {
  if (block_ends_.empty()) block_ends_ = {noise.size()};
  // Detection limits are those of the usual session alone.
  std::vector<double> of_usual = noise;
  std::fill(of_usual.begin() + static_cast<std::ptrdiff_t>(block_ends_.front()), of_usual.end(),
            std::numeric_limits<double>::infinity());
  const WidenedNoise widened(unknown, of_usual);
  for (const EffectLadder& ladder : ladders) add_ladder(ladder, noise, of_usual, widened);
  assert(!signatures_.empty() && "no ladder reaches its detection limit");
  spread_priors();
  for (const LineChange& change : unknown) signatures_.push_back(signature_of(change, noise));
  const auto n = static_cast<Eigen::Index>(signatures_.size());
  const auto n_lines = static_cast<Eigen::Index>(noise.size());
  Eigen::MatrixXd all(signatures_.front().size(), n);
  for (Eigen::Index i = 0; i < n; ++i) all.col(i) = signatures_[static_cast<std::size_t>(i)];
  Eigen::Index begin = 0;
  for (const std::size_t block_end : block_ends_) {
    const auto end = static_cast<Eigen::Index>(block_end);
    Eigen::MatrixXd& inner = inner_.emplace_back(Eigen::MatrixXd::Zero(n, n));
    for (const Eigen::Index part : {Eigen::Index{0}, n_lines, 2 * n_lines}) {
      const auto lines = all.middleRows(part + begin, end - begin);
      inner.noalias() += lines.transpose() * lines;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(inner);
    noise_root_.push_back(parts.eigenvectors() *
                          parts.eigenvalues().cwiseMax(0.).cwiseSqrt().asDiagonal());
    views_.push_back(view_of(begin == 0 ? inner : Eigen::MatrixXd(inner_.front() + inner)));
    begin = end;
  }
}

void IdealObserver::add_ladder(const EffectLadder& ladder, const std::vector<double>& noise,
                               const std::vector<double>& noise_of_usual,
                               const WidenedNoise& widened) {
  if (!bench_.asks_calibrations && is_a_calibration(ladder.unknown->id)) return;
  const std::optional<double> limit = on_bench(ladder, noise_of_usual, widened).limit(bench_);
  if (!limit) return;
  const Unknown& unknown = *ladder.unknown;
  const double largest = std::min(largest_in_limits, unknown.largest / *limit);
  if (!unknown.fixed_size && largest <= 1.01 * smallest_in_limits) return;
  const LadderOnBench here = on_bench(ladder, noise, {});
  const double range = std::log(largest / smallest_in_limits);
  const auto n =
      static_cast<std::size_t>(unknown.fixed_size ? 1. : std::ceil(range / std::log(widest_step)));
  const std::size_t first = signatures_.size();
  std::vector<double> in_limits;
  for (std::size_t i = 0; i <= n; ++i) {
    const double along = static_cast<double>(i) / static_cast<double>(n);
    in_limits.push_back(unknown.fixed_size ? 1. : smallest_in_limits * std::exp(range * along));
    const double size = unknown.fixed_size ? unknown.largest : in_limits[i] * *limit;
    signatures_.push_back(here.at(size));
    amplitudes_.push_back(here.amplitude(size));
  }
  const bool either = unknown.either_sign && !unknown.random;
  for (const double sign : either ? std::vector{1., -1.} : std::vector{1.}) {
    paths_.push_back({number_of(unknown), steps_.size(), n});
    for (std::size_t i = 0; i < n; ++i)
      steps_.push_back({.unknown = number_of(unknown),
                        .first = first + i,
                        .second = first + i + 1,
                        .sign = sign,
                        .low = in_limits[i],
                        .high = in_limits[i + 1]});
  }
}

void IdealObserver::spread_priors() {
  std::set<std::size_t> there;
  for (const Path& path : paths_) there.insert(path.unknown);
  there_.assign(there.begin(), there.end());
  for (const Path& path : paths_) {
    const auto n_paths = std::count_if(paths_.begin(), paths_.end(), [&](const Path& other) {
      return other.unknown == path.unknown;
    });
    for (std::size_t i = 0; i < path.n_steps; ++i)
      steps_[path.first_step + i].log_prior =
          -std::log(static_cast<double>(n_paths) * static_cast<double>(path.n_steps));
  }
}

IdealObserver::View IdealObserver::view_of(const Eigen::MatrixXd& all) const {
  const auto n = static_cast<Eigen::Index>(steps_.size());
  const auto n_known = static_cast<Eigen::Index>(amplitudes_.size());
  const Eigen::Index n_unknown = all.rows() - n_known;
  const Eigen::MatrixXd wider =
      Eigen::MatrixXd::Identity(n_unknown, n_unknown) + all.bottomRightCorner(n_unknown, n_unknown);
  Eigen::MatrixXd correction(n_known, n_unknown);
  if (n_unknown > 0)
    correction = wider.llt().solve(all.bottomLeftCorner(n_unknown, n_known)).transpose();
  const Eigen::MatrixXd inner =
      all.topLeftCorner(n_known, n_known) - correction * all.bottomLeftCorner(n_unknown, n_known);
  Eigen::MatrixXd start = Eigen::MatrixXd::Zero(n_known, n), edge = start;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Step& step = steps_[static_cast<std::size_t>(i)];
    start(static_cast<Eigen::Index>(step.first), i) = step.sign;
    edge(static_cast<Eigen::Index>(step.second), i) += step.sign;
    edge(static_cast<Eigen::Index>(step.first), i) -= step.sign;
  }
  const Eigen::MatrixXd from_start = inner * start, from_edge = inner * edge;
  return {.starts = start.transpose() * from_start,
          .starts_edges = start.transpose() * from_edge,
          .edges = edge.transpose() * from_edge,
          .correction = correction};
}

ObservedSensor IdealObserver::draw(const std::size_t n_effects, std::mt19937_64& random) const {
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  std::vector<std::size_t> unknowns = there_;
  std::shuffle(unknowns.begin(), unknowns.end(), random);
  unknowns.resize(n_effects);
  std::sort(unknowns.begin(), unknowns.end());
  ObservedSensor out{.unknowns = unknowns};
  Eigen::VectorXd share = Eigen::VectorXd::Zero(inner_.front().rows());
  std::vector<double> powers;
  for (const std::size_t unknown : unknowns) {
    std::vector<Path> paths;
    std::copy_if(paths_.begin(), paths_.end(), std::back_inserter(paths),
                 [&](const Path& path) { return path.unknown == unknown; });
    const Path& path = paths[random() % paths.size()];
    const Step& step = steps_[path.first_step + random() % path.n_steps];
    const double t = uniform(random);
    share[static_cast<Eigen::Index>(step.first)] += step.sign * (1. - t);
    share[static_cast<Eigen::Index>(step.second)] += step.sign * t;
    out.in_limits.push_back(step.low + t * (step.high - step.low));
    powers.push_back(
        std::pow((1. - t) * amplitudes_[step.first] + t * amplitudes_[step.second], 2));
  }
  const double gap = std::accumulate(powers.begin(), powers.end(), bench_.calibration_power);
  for (const double power : powers)
    if (power > 0.) out.least_gap_share = std::min(out.least_gap_share, power / gap);
  for (Eigen::Index i = static_cast<Eigen::Index>(amplitudes_.size()); i < share.size(); ++i)
    share[i] = normal(random);
  for (std::size_t b = 0; b < inner_.size(); ++b) {
    const Eigen::VectorXd noise =
        Eigen::VectorXd::NullaryExpr(share.size(), [&] { return normal(random); });
    out.seen.push_back(inner_[b] * share + noise_root_[b] * noise);
  }
  return out;
}

/// Log likelihood ratio to "none": inner product of record and signature minus half of the
/// signature's square.
template <std::size_t n>
BoxNormal<n> IdealObserver::likelihood(const std::array<std::size_t, n>& steps,
                                       const Seen& seen) const {
  const auto at = [&](std::size_t i) { return static_cast<Eigen::Index>(steps[i]); };
  BoxNormal<n> out;
  for (std::size_t i = 0; i < n; ++i) {
    out.value += seen.start[at(i)];
    out.slope[i] = seen.edge[at(i)];
    for (std::size_t k = 0; k < n; ++k) {
      out.value -= 0.5 * seen.view.starts(at(i), at(k));
      out.slope[i] -= seen.view.starts_edges(at(k), at(i));
      out.curvature[i][k] = seen.view.edges(at(i), at(k));
    }
  }
  return out;
}

Posterior IdealObserver::posterior_of(const Seen& seen) const {
  // All sets with the same number of effects have the same prior probability.
  const double m = static_cast<double>(there_.size());
  const auto& asked = bench_.asked;
  Sets sets(named_unknowns().size(),
            {std::log(asked[0]), std::log(asked[1] / m), std::log(asked[2] / (m * (m - 1.) / 2.)),
             std::log(asked[3] / (m * (m - 1.) * (m - 2.) / 6.))});
  const auto look_at = [&]<std::size_t n>(const std::array<std::size_t, n>& steps) {
    std::array<std::size_t, n> unknowns{};
    double prior = 0.;
    for (std::size_t i = 0; i < n; ++i) {
      unknowns[i] = steps_[steps[i]].unknown;
      prior += steps_[steps[i]].log_prior;
    }
    sets.add(unknowns, prior,
             [&](double worth_it) { return log_box_integral(likelihood(steps, seen), worth_it); });
  };
  const auto differ = [&](std::size_t i, std::size_t k) {
    return steps_[i].unknown != steps_[k].unknown;
  };
  look_at(std::array<std::size_t, 0>{});
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    look_at(std::array{i});
    for (std::size_t j = i + 1; j < steps_.size(); ++j) {
      if (!differ(i, j)) continue;
      look_at(std::array{i, j});
      for (std::size_t k = j + 1; k < steps_.size(); ++k)
        if (differ(i, k) && differ(j, k)) look_at(std::array{i, j, k});
    }
  }
  return sets.posterior();
}

ObserverAnswer IdealObserver::answer(const ObservedSensor& sensor,
                                     const std::size_t further) const {
  Eigen::VectorXd along = sensor.seen.front();
  if (further > 0) along += sensor.seen.at(further);
  const Eigen::MatrixXd& correction = views_.at(further).correction;
  along.head(correction.rows()) -= correction * along.tail(correction.cols());
  const auto n = static_cast<Eigen::Index>(steps_.size());
  Seen seen{.view = views_.at(further), .start = Eigen::VectorXd(n), .edge = Eigen::VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const Step& step = steps_[static_cast<std::size_t>(i)];
    const double first = along[static_cast<Eigen::Index>(step.first)];
    seen.start[i] = step.sign * first;
    seen.edge[i] = step.sign * (along[static_cast<Eigen::Index>(step.second)] - first);
  }
  const Posterior posterior = posterior_of(seen);
  ObserverAnswer out{.unknowns = posterior.front().second, .probability = posterior.front().first};
  double sum = 0.;
  for (std::size_t i = 0; i < posterior.size(); ++i) {
    const bool is_truth = posterior[i].second == sensor.unknowns;
    if (is_truth && i == 0) out.right = true;
    if (is_truth && i < 3) out.among_three = true;
    if (sum < held) {
      ++out.set_size;
      out.set_holds = out.set_holds || is_truth;
    }
    sum += posterior[i].first;
  }
  return out;
}

}  // namespace vibrissa::trial
