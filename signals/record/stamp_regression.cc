#include "signals/record/stamp_regression.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "signals/base/median.h"
#include "signals/record/lost_samples.h"

namespace vibrissa::signals {
namespace {

constexpr std::size_t least_events = 16;
constexpr double most_lost = 0.05;

// Samples with one stamp are one event, at the mean of their numbers. Where no stamp is shared,
// which is usual, nothing is stored.
struct Events {
  std::span<const double> times_s;
  std::vector<double> distinct_s, samples;
  std::vector<std::uint32_t> first;  // first row of each event
  std::size_t packet = 1;            // number of samples of most events

  double sample(const std::size_t i) const { return samples.empty() ? double(i) : samples[i]; }
  std::size_t row(const std::size_t i) const { return first.empty() ? i : first[i]; }
};

Events events_of(const std::span<const double> times_s) {
  Events events;
  events.times_s = times_s;
  if (std::ranges::adjacent_find(times_s) == times_s.end()) return events;
  for (std::size_t i = 0, next; i < times_s.size(); i = next) {
    for (next = i + 1; next < times_s.size() && times_s[next] == times_s[i];) ++next;
    events.distinct_s.push_back(times_s[i]);
    events.samples.push_back(0.5 * static_cast<double>(i + next - 1));
    events.first.push_back(static_cast<std::uint32_t>(i));
  }
  events.times_s = events.distinct_s;
  std::vector<std::uint32_t> sizes;
  for (std::size_t e = 1; e < events.first.size(); ++e)
    sizes.push_back(events.first[e] - events.first[e - 1]);
  sizes.push_back(static_cast<std::uint32_t>(times_s.size()) - events.first.back());
  const auto middle = sizes.begin() + std::ptrdiff_t(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const std::size_t usual = *middle;
  const auto n_usual = std::count(sizes.begin(), sizes.end(), usual);
  constexpr double nearly_all = 0.9;
  if (double(n_usual) > nearly_all * double(sizes.size())) events.packet = usual;
  return events;
}

// Calls visit(i) for the events before `end`; of a long record for short stretches of them, which
// tell a median as well.
template <typename Visit>
void visit_spread(const std::size_t end, const Visit& visit) {
  constexpr std::size_t enough = 1 << 16, stretch = 64;
  const std::size_t skipped = end / enough * stretch;
  for (std::size_t i = 0; i < end; ++i) {
    if (i > 0 && i % stretch == 0) i += skipped;
    if (i < end) visit(i);
  }
}

// Median slope over a lag that is long beside a packet and short beside the usual way between
// losses.
double first_period(const Events& events) {
  const std::size_t n = events.times_s.size();
  const std::size_t lag = std::clamp<std::size_t>(n / 8, 2, 24);
  std::vector<double> slopes;
  visit_spread(n - lag, [&](const std::size_t i) {
    slopes.push_back((events.times_s[i + lag] - events.times_s[i]) /
                     (events.sample(i + lag) - events.sample(i)));
  });
  return median(std::move(slopes));
}

double local_jitter(const Events& events, const double period_s) {
  std::vector<double> changes;
  visit_spread(events.times_s.size() - 1, [&](const std::size_t i) {
    changes.push_back(std::abs(events.times_s[i + 1] - events.times_s[i] -
                               period_s * (events.sample(i + 1) - events.sample(i))));
  });
  return robust_deviation(std::move(changes)) / std::numbers::sqrt2;  // of a difference
}

// Whether a step backward is longer than jitter explains.
bool runs_backward(const std::span<const double> times_s, const double jitter_s,
                   const double rounding_s) {
  constexpr double most_deviations = 7.;
  const double allowed = most_deviations * std::max(jitter_s, rounding_s);
  for (std::size_t i = 1; i < times_s.size(); ++i)
    if (times_s[i] < times_s[i - 1] - allowed) return true;
  return false;
}

// One line for each run of events between which the number of lost samples is certain; the lines
// have one slope.
struct Lines {
  std::vector<std::uint32_t> run;  // of each event; empty: nothing is lost
  std::vector<double> samples;     // of each event, with those that are lost; empty likewise
  std::vector<double> start_s;     // of each run: time of its sample 0
  double period_s = 0., period_error_s = 0., deviation_s = 0.;

  std::size_t run_of(const std::size_t i) const { return run.empty() ? 0 : run[i]; }
  double sample(const Events& events, const std::size_t i) const {
    return samples.empty() ? events.sample(i) : samples[i];
  }
  double residual_s(const Events& events, const std::size_t i) const {
    return events.times_s[i] - start_s[run_of(i)] - period_s * sample(events, i);
  }
};

constexpr std::size_t most_certain = 20;  // a longer loss is not counted exactly

constexpr std::size_t n_blocks = 30;  // in which correlation is looked for

// Standard deviation of the sum of correlated residuals over that of independent ones, squared.
double correlation_factor(const Events& events, const Lines& lines) {
  const std::size_t length = events.times_s.size() / n_blocks;
  if (length < 2) return 1.;
  double power = 0., of_means = 0.;
  for (std::size_t b = 0; b < n_blocks; ++b) {
    double sum = 0.;
    for (std::size_t i = b * length; i < (b + 1) * length; ++i) {
      const double residual = lines.residual_s(events, i);
      sum += residual;
      power += residual * residual;
    }
    of_means += sum * sum / double(length);
  }
  return power > 0. ? std::max(1., of_means / power * double(length)) : 1.;
}

// Whether the residuals keep their value over a large part of a block, as a sum of independent
// steps does; those of a buffer that is read when it is full do not.
bool is_random_walk(const Events& events, const Lines& lines) {
  constexpr double large_part = 0.1;
  return correlation_factor(events, lines) > large_part * double(events.times_s.size() / n_blocks);
}

Lines fitted_lines(const Events& events, const std::vector<Loss>& losses, const double rounding_s) {
  const std::size_t n = events.times_s.size();
  Lines lines;
  double n_lost = 0.;
  std::uint32_t run = 0;
  auto loss = losses.begin();
  for (std::size_t i = 0; i < n && !losses.empty(); ++i) {
    if (loss != losses.end() && loss->stamp == i) {
      n_lost += double(loss->count);
      if (loss->count > most_certain) ++run;
      ++loss;
    }
    lines.run.push_back(run);
    lines.samples.push_back(events.sample(i) + n_lost);
  }
  std::vector<double> count(run + 1), mean_x(run + 1), mean_t(run + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t r = lines.run_of(i);
    count[r] += 1.;
    mean_x[r] += lines.sample(events, i);
    mean_t[r] += events.times_s[i] - events.times_s[0];
  }
  for (std::size_t r = 0; r <= run; ++r) mean_x[r] /= count[r], mean_t[r] /= count[r];
  double xx = 0., xt = 0.;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = lines.sample(events, i) - mean_x[lines.run_of(i)];
    xx += x * x;
    xt += x * (events.times_s[i] - events.times_s[0] - mean_t[lines.run_of(i)]);
  }
  lines.period_s = xt / xx;
  for (std::size_t r = 0; r <= run; ++r)
    lines.start_s.push_back(events.times_s[0] + mean_t[r] - lines.period_s * mean_x[r]);
  double power = 0.;
  for (std::size_t i = 0; i < n; ++i) power += std::pow(lines.residual_s(events, i), 2);
  lines.deviation_s = std::sqrt(power / double(n));
  const double spread = std::max(lines.deviation_s, rounding_s / std::sqrt(3.));
  lines.period_error_s = spread * std::sqrt(correlation_factor(events, lines) / xx);
  return lines;
}

// Where the steps of bursts add up as a random walk, only their sum tells the period: the line from
// the first to the last event.
Lines mean_line(const Events& events, Lines lines) {
  const double span_s = events.times_s.back() - events.times_s.front();
  const double n = events.sample(events.times_s.size() - 1) - events.sample(0);
  lines.period_s = span_s / n;
  lines.period_error_s = std::sqrt(2.) * lines.deviation_s / n;
  lines.start_s.front() = events.times_s.front() - lines.period_s * events.sample(0);
  return lines;
}

// Whether the stamps leave every grid: their difference to it grows with the lag, as the sum of
// uneven steps does. Slow drift of a clock does not count.
bool wander(const Events& events, const Lines& lines) {
  const std::size_t n = events.times_s.size();
  const auto r = [&](const std::size_t i) { return lines.residual_s(events, i); };
  constexpr std::size_t long_lag = 32;
  if (n < 4 * long_lag) return lines.deviation_s > lines.period_s;
  const auto power_at = [&](const std::size_t lag) {
    // Second differences remove drift of the period.
    double sum = 0.;
    for (std::size_t i = 0; i + 2 * lag < n; ++i)
      sum += std::pow(r(i) - 2. * r(i + lag) + r(i + 2 * lag), 2);
    return sum / double(n - 2 * lag);
  };
  constexpr double grows = 4., matters_periods = 0.5;
  const double at_long = power_at(long_lag);
  return at_long > grows * power_at(1) && at_long > std::pow(matters_periods * lines.period_s, 2);
}

// The shortest step [s], where nearly all steps have one of three lengths, most of them this one.
std::optional<double> step_of_bursts(const std::span<const double> times_s,
                                     const double rounding_s) {
  std::vector<double> steps;
  steps.reserve(times_s.size());
  for (std::size_t i = 1; i < times_s.size(); ++i) steps.push_back(times_s[i] - times_s[i - 1]);
  std::sort(steps.begin(), steps.end());
  constexpr std::size_t most_lengths = 3;
  constexpr double nearly_all = 0.98;
  std::size_t n_lengths = 0, n_short = 0;
  const auto n_counted = std::size_t(nearly_all * double(steps.size()));
  for (std::size_t i = 0, next; i < n_counted; i = next) {
    for (next = i + 1; next < steps.size() && steps[next] - steps[i] <= 4. * rounding_s;) ++next;
    if (n_lengths++ == 0) n_short = next;
  }
  if (n_lengths < 2 || n_lengths > most_lengths || 2 * n_short <= steps.size()) return {};
  return steps[n_short / 2];
}

void set_pieces(const Events& events, const std::vector<Loss>& losses, const Lines& lines,
                const std::size_t n_rows, Clock& clock) {
  std::vector<std::size_t> firsts;
  const auto begin_at = [&](const std::size_t i) {
    firsts.push_back(events.row(i));
    const double ahead = events.sample(i) - double(events.row(i));
    clock.pieces.push_back(
        {events.row(i), 0,
         lines.start_s[lines.run_of(i)] + lines.period_s * (lines.sample(events, i) - ahead)});
  };
  begin_at(0);
  for (const Loss& loss : losses) {
    begin_at(loss.stamp);
    clock.n_lost += loss.count;
  }
  firsts.push_back(n_rows);
  for (std::size_t p = 0; p < clock.pieces.size(); ++p)
    clock.pieces[p].count = firsts[p + 1] - firsts[p];
}

}  // namespace

std::optional<Clock> regress_stamps(const std::span<const double> times_s,
                                    const double rounding_s) {
  const Events events = events_of(times_s);
  if (events.times_s.size() < least_events) return {};
  double period_s = first_period(events);
  if (!(period_s > 0.)) return {};
  double deviation_s = local_jitter(events, period_s);
  if (runs_backward(times_s, deviation_s, rounding_s)) return {};
  std::vector<Loss> losses;
  Lines lines;
  constexpr int n_rounds = 3;
  for (int round = 0; round < n_rounds; ++round) {
    const std::vector<Loss> before = std::move(losses);
    constexpr double least_jitter_periods = 0.03;
    const double jitter_s = std::max({deviation_s, rounding_s, least_jitter_periods * period_s});
    losses = find_losses({events.times_s, events.samples, period_s, jitter_s, events.packet});
    if (round > 0 && losses == before) break;
    lines = {};  // Of a long record these are large.
    lines = fitted_lines(events, losses, rounding_s);
    if (!(lines.period_s > 0.)) return {};
    period_s = lines.period_s;
    deviation_s = local_jitter(events, period_s);
  }
  const bool is_often_lost = double(losses.size()) > most_lost * double(events.times_s.size());
  // A device that only loses samples has its period as its shortest step.
  const std::optional<double> step_s = step_of_bursts(events.times_s, rounding_s);
  constexpr double hidden = 0.5;
  const bool is_burst =
      step_s && (is_often_lost || (!losses.empty() && *step_s < hidden * lines.period_s));
  if (is_burst) {
    losses.clear();
    lines = fitted_lines(events, losses, rounding_s);
    if (is_random_walk(events, lines)) lines = mean_line(events, lines);
  } else if (is_often_lost || wander(events, lines)) {
    return {};
  }
  Clock clock{.sampling_rate_hz = 1. / lines.period_s,
              .rate_error_hz = lines.period_error_s / (lines.period_s * lines.period_s),
              .jitter_s = lines.deviation_s,
              .is_from_bursts = is_burst,
              .packet = events.packet};
  set_pieces(events, losses, lines, times_s.size(), clock);
  // A stamp that stands twice is a sample without a step of time, and what follows seems lost.
  const double room = std::ceil((times_s.back() - times_s.front()) / lines.period_s) + 1. -
                      static_cast<double>(times_s.size());
  clock.n_lost = std::min(clock.n_lost, static_cast<std::size_t>(std::max(0., room)));
  return clock;
}

}  // namespace vibrissa::signals
