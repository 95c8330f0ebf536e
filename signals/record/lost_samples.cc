#include "signals/record/lost_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <utility>

namespace vibrissa::signals {
namespace {

// Gains of the tracker of phase and period: it follows drift over some tens of samples.
constexpr double phase_gain = 0.08, period_gain = 0.002;
constexpr double cost_of_a_loss = 6.;  // -log of the prior probability, 1 in 400
constexpr double highest_cost = 20.;   // of one stamp, so that a late one is no loss
constexpr std::size_t n_paths = 6;
// So close to its prediction no stamp speaks for a loss; after so many of them in a row all paths
// have one phase, and the best one stays the best.
constexpr double plain_periods = 0.4;
constexpr std::size_t n_settled = 64;

struct Path {
  double cost = 0.;
  double phase_s = 0., period_s = 0.;  // time of the next sample, if none is lost, minus samples
  double n_lost = 0.;
};

struct Decision {
  std::uint32_t lost = 0;
  std::uint8_t parent = 0;
};

Path extended(const Path& path, const JitteringStamps& stamps, const std::size_t i,
              const double n_new) {
  const double steps = stamps.steps(i) + n_new;
  const double predicted = path.phase_s + steps * path.period_s;
  const double innovation = stamps.times_s[i] - predicted;
  const double clipped = std::clamp(innovation, -0.5 * stamps.period_s, 0.5 * stamps.period_s);
  Path next = path;
  next.cost += std::min(highest_cost, 0.5 * std::pow(innovation / stamps.jitter_s, 2));
  if (n_new > 0.) next.cost += cost_of_a_loss;
  next.n_lost += n_new;
  next.phase_s = predicted + phase_gain * clipped;
  next.period_s += period_gain * clipped / std::max(1., steps);
  return next;
}

// No loss, and the losses that explain the stamp best.
std::vector<double> possible_losses(const Path& path, const JitteringStamps& stamps,
                                    const std::size_t i) {
  const double steps = stamps.steps(i);
  const double quantum = static_cast<double>(stamps.quantum);
  const double late = (stamps.times_s[i] - path.phase_s - steps * path.period_s) / path.period_s;
  const double nearest = std::round(late / quantum) * quantum;
  std::vector<double> losses{0.};
  for (const double n : {nearest - quantum, nearest, nearest + quantum})
    if (n >= quantum && n < 4e9) losses.push_back(n);
  if (losses.size() == 1 && late > -2.) losses.push_back(quantum);
  return losses;
}

struct Candidate {
  Path path;
  Decision decision;
};

/// The decisions of all paths at all stamps since there was one path. A record has millions, so
/// each takes two bytes; the few long losses stand beside them.
class Decisions {
 public:
  bool empty() const { return all_.empty(); }

  void add(const std::vector<Candidate>& chosen) {
    auto& stamp = all_.emplace_back();
    for (std::size_t p = 0; p < chosen.size(); ++p) {
      const Decision& decision = chosen[p].decision;
      stamp[p] = {.lost = static_cast<std::uint16_t>(std::min(decision.lost, is_long) & is_long),
                  .parent = static_cast<std::uint16_t>(decision.parent & 7)};
      if (decision.lost >= is_long) long_losses_[{all_.size(), p}] = decision.lost;
    }
  }

  /// Appends the losses that led to the best path, the last stamp before `end`, and forgets all.
  void trace_back(std::size_t end, std::vector<Loss>& losses) {
    const auto n_before = static_cast<std::ptrdiff_t>(losses.size());
    for (std::size_t path = 0; !all_.empty(); all_.pop_back()) {
      const Short& found = all_.back()[path];
      --end;
      if (found.lost == is_long)
        losses.push_back({end, long_losses_.at({all_.size(), path})});
      else if (found.lost > 0)
        losses.push_back({end, found.lost});
      path = found.parent;
    }
    std::reverse(losses.begin() + n_before, losses.end());
    long_losses_.clear();
  }

 private:
  static constexpr std::uint32_t is_long = (1 << 13) - 1;
  struct Short {
    std::uint16_t lost : 13, parent : 3;
  };
  std::deque<std::array<Short, n_paths>> all_;
  std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> long_losses_;  // stamp, path
};

// Of the paths with the same number of losses the best one; of these the best few.
void keep_best(std::vector<Candidate>& candidates) {
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.path.cost < b.path.cost; });
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates) {
    if (kept.size() == n_paths) break;
    if (std::none_of(kept.begin(), kept.end(), [&](const Candidate& other) {
          return other.path.n_lost == candidate.path.n_lost;
        }))
      kept.push_back(candidate);
  }
  candidates = std::move(kept);
}

bool is_plain(const Path& path, const JitteringStamps& stamps, const std::size_t i) {
  const double steps = stamps.steps(i);
  const double innovation = stamps.times_s[i] - path.phase_s - steps * path.period_s;
  return std::abs(innovation) < plain_periods * stamps.period_s;
}

}  // namespace

std::vector<Loss> find_losses(const JitteringStamps& stamps) {
  const std::size_t n = stamps.times_s.size();
  std::vector<Path> paths{{0., stamps.times_s[0], stamps.period_s, 0.}};
  Decisions decisions;
  std::vector<Candidate> candidates;
  std::vector<Loss> losses;
  std::size_t n_plain = 0;
  for (std::size_t i = 1; i < n; ++i) {
    n_plain = is_plain(paths.front(), stamps, i) ? n_plain + 1 : 0;
    if (n_plain >= n_settled && !decisions.empty()) {
      decisions.trace_back(i, losses);
      paths.resize(1);
    }
    if (n_plain > 0 && decisions.empty()) {
      paths.front() = extended(paths.front(), stamps, i, 0.);
      continue;
    }
    candidates.clear();
    for (std::size_t p = 0; p < paths.size(); ++p)
      for (const double n_new : possible_losses(paths[p], stamps, i))
        candidates.push_back({extended(paths[p], stamps, i, n_new),
                              {static_cast<std::uint32_t>(n_new), static_cast<std::uint8_t>(p)}});
    keep_best(candidates);
    decisions.add(candidates);
    paths.clear();
    for (const Candidate& candidate : candidates) paths.push_back(candidate.path);
  }
  decisions.trace_back(n, losses);
  return losses;
}

}  // namespace vibrissa::signals
