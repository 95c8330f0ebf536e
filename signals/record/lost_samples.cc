#include "signals/record/lost_samples.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vibrissa::signals {
namespace {

// Gains of the tracker of phase and period: it follows drift over some tens of samples.
constexpr double phase_gain = 0.08, period_gain = 0.002;
constexpr double cost_of_a_loss = 6.;  // -log of the prior probability, 1 in 400
constexpr double highest_cost = 20.;   // of one stamp, so that a late one is no loss
constexpr std::size_t n_paths = 6;

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
  const double steps = stamps.samples[i] - stamps.samples[i - 1] + n_new;
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
  const double steps = stamps.samples[i] - stamps.samples[i - 1];
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

/// The decisions of all paths at all stamps. A record has millions, so each takes two bytes; the
/// few long losses stand beside them.
class Decisions {
 public:
  explicit Decisions(const std::size_t n_stamps) : all_(n_stamps * n_paths) {}

  void set(const std::size_t stamp, const std::size_t path, const Decision& decision) {
    const std::size_t i = stamp * n_paths + path;
    all_[i] = {.lost = static_cast<std::uint16_t>(std::min(decision.lost, is_long) & is_long),
               .parent = static_cast<std::uint16_t>(decision.parent & 7)};
    if (decision.lost >= is_long) long_losses_[i] = decision.lost;
  }
  Decision at(const std::size_t stamp, const std::size_t path) const {
    const std::size_t i = stamp * n_paths + path;
    const Short& found = all_[i];
    return {found.lost == is_long ? long_losses_.at(i) : found.lost,
            static_cast<std::uint8_t>(found.parent)};
  }

 private:
  static constexpr std::uint32_t is_long = (1 << 13) - 1;
  struct Short {
    std::uint16_t lost : 13, parent : 3;
  };
  std::vector<Short> all_;
  std::map<std::size_t, std::uint32_t> long_losses_;
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

}  // namespace

std::vector<std::uint32_t> lost_before_each(const JitteringStamps& stamps) {
  const std::size_t n = stamps.times_s.size();
  std::vector<Path> paths{{0., stamps.times_s[0], stamps.period_s, 0.}};
  Decisions decisions(n);
  std::vector<Candidate> candidates;
  for (std::size_t i = 1; i < n; ++i) {
    candidates.clear();
    for (std::size_t p = 0; p < paths.size(); ++p)
      for (const double lost : possible_losses(paths[p], stamps, i))
        candidates.push_back({extended(paths[p], stamps, i, lost),
                              {static_cast<std::uint32_t>(lost), static_cast<std::uint8_t>(p)}});
    keep_best(candidates);
    paths.clear();
    for (std::size_t p = 0; p < candidates.size(); ++p) {
      paths.push_back(candidates[p].path);
      decisions.set(i, p, candidates[p].decision);
    }
  }
  std::vector<std::uint32_t> lost(n);
  std::size_t path = 0;
  for (std::size_t i = n; i-- > 1;) {
    const Decision decision = decisions.at(i, path);
    lost[i] = decision.lost;
    path = decision.parent;
  }
  return lost;
}

}  // namespace vibrissa::signals
