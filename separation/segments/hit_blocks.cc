#include "separation/segments/hit_blocks.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "signals/base/median.h"

namespace vibrissa::separation {

namespace {

constexpr std::size_t shortest_record = 64;

std::vector<double> about_median(std::span<const double> x) {
  std::vector<double> centred(x.begin(), x.end());
  const double middle = signals::median(centred);
  for (double& value : centred) value -= middle;
  return centred;
}

bool is_short_pulses(const std::vector<double>& x) {
  constexpr double most_power = 0.99, few_samples = 0.05;
  std::vector<double> power;
  double total = 0.;
  for (const double value : x) {
    power.push_back(value * value);
    total += power.back();
  }
  const auto n_few = static_cast<std::ptrdiff_t>(few_samples * static_cast<double>(x.size()));
  std::ranges::nth_element(power, power.begin() + n_few, std::greater<>());
  double largest = 0.;
  for (std::ptrdiff_t i = 0; i < n_few; ++i) largest += power[static_cast<std::size_t>(i)];
  return total > 0. && largest >= most_power * total;
}

// A tenth of the largest sample is a hundredth of its power.
constexpr double of_a_pulse = 0.1;

double largest(const std::vector<double>& x) {
  double most = 0.;
  for (const double value : x) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace

std::vector<std::size_t> hits_of(std::span<const double> input) {
  if (input.size() < shortest_record) return {};
  const std::vector<double> x = about_median(input);
  if (!is_short_pulses(x)) return {};
  const double limit = of_a_pulse * largest(x);
  const std::size_t apart = x.size() / 50;
  std::vector<std::size_t> hits;
  std::size_t last = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::abs(x[i]) < limit) continue;
    if (hits.empty() || i - last > apart) hits.push_back(i);
    last = i;
  }
  return hits;
}

std::vector<Block> hit_blocks(std::span<const double> input) {
  const std::vector<std::size_t> hits = hits_of(input);
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::size_t before = i == 0 ? hits[0] : std::min(hits[0], (hits[i] - hits[i - 1]) / 2);
    blocks.push_back({i == 0 ? 0 : hits[i] - before, input.size()});
    if (i > 0) blocks[i - 1].end = blocks[i].first;
  }
  return blocks;
}

std::vector<double> pulses_of(std::span<const double> input) {
  std::vector<double> x = about_median(input);
  const std::vector<std::size_t> hits = hits_of(input);
  const double limit = of_a_pulse * largest(x);
  const std::size_t apart = x.size() / 50;
  std::vector<bool> kept(x.size(), false);
  for (const std::size_t hit : hits) {
    std::size_t last = hit;
    for (std::size_t i = hit; i < x.size() && i - last <= apart; ++i)
      if (std::abs(x[i]) >= limit) last = i;
    // The rise and the fall of a pulse are about as long as the pulse.
    const std::size_t margin = 2 * (last - hit + 2);
    for (std::size_t i = hit - std::min(hit, margin); i < std::min(x.size(), last + margin + 1);
         ++i)
      kept[i] = true;
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!kept[i]) x[i] = 0.;
  return x;
}

}  // namespace vibrissa::separation
