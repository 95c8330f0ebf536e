#include "apps/jobs/model_advice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "separation/identification/identify.h"
#include "separation/model/simulation.h"
#include "signals/base/error.h"
#include "signals/base/significant_digits.h"

namespace vibrissa::apps {
namespace {

namespace channel = signals::channel;
using signals::rounded;

double rms(std::span<const double> x) {
  double sum = 0.;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

}  // namespace

std::optional<ModelAdvice> model_advice(const signals::Record& record) {
  constexpr std::size_t most_samples = 30000, fewest_samples = 1200;
  if (!record.has(channel::base_acceleration) || record.n_samples() < fewest_samples)
    return std::nullopt;
  const signals::Record part = record.slice(0, std::min(record.n_samples(), most_samples));
  try {
    const auto found = separation::identify_record(part);
    const auto [fit, held_out] = separation::hold_out_part(part);
    const auto moment = held_out.channel(channel::base_moment);
    std::vector<double> left =
        separation::simulate_like(found.scored, held_out.channel(channel::base_acceleration),
                                  moment, part.sampling_rate_hz(), found.hold);
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = moment[i] - left[i];
    return ModelAdvice{.delay_s = found.found_delay_s,
                       .first = fit.n_samples(),
                       .end = part.n_samples(),
                       .moment_rms_n_m = rms(moment),
                       .left_rms_n_m = rms(left)};
  } catch (const signals::UserError&) {
    return std::nullopt;
  }
}

signals::Record without_lead(const signals::Record& record, const ModelAdvice& advice) {
  if (!advice.delay_s || advice.delay_s->value >= 0.) return record;
  const auto lead =
      static_cast<std::size_t>(std::ceil(-advice.delay_s->value * record.sampling_rate_hz()));
  const auto late = record.channel(channel::base_acceleration);
  if (lead >= late.size()) return record;
  std::vector<double> aligned(late.begin() + static_cast<std::ptrdiff_t>(lead), late.end());
  aligned.resize(late.size(), late.back());
  signals::Record result = record;
  result.set_channel(channel::base_acceleration, std::move(aligned));
  return result;
}

std::string advice_words(const ModelAdvice& advice,
                         const std::vector<views::SeparatedSignal>& signals,
                         double sampling_rate_hz) {
  std::string words;
  if (advice.delay_s) {
    const double ms = 1e3 * advice.delay_s->value;
    words =
        std::string("the moment ") + (ms < 0. ? "leads" : "lags behind") +
        " the base acceleration by " + rounded(std::abs(ms), 3) + " ms (" +
        rounded(std::abs(ms) * 1e-3 * sampling_rate_hz, 3) + " samples)" +
        (ms < 0. ? ": two clocks; the acceleration was moved by it for the adaptive filters" : "");
  }
  const views::SeparatedSignal* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const views::SeparatedSignal& signal : signals) {
    if (signal.name == "nothing removed") continue;
    const double left =
        rms(std::span(signal.wind_moment_n_m).subspan(advice.first, advice.end - advice.first));
    if (left < least) {
      least = left;
      best = &signal;
    }
  }
  // With wind, what is left is the wind, and its size tells nothing about a method.
  constexpr double calm_share = 0.5, clearly = 0.8;
  const bool calm = advice.left_rms_n_m < calm_share * advice.moment_rms_n_m;
  if (!best || !calm || !(advice.left_rms_n_m < clearly * least)) return words;
  return words + (words.empty() ? "" : "; ") + "without wind from " +
         rounded(static_cast<double>(advice.first) / sampling_rate_hz, 4) + " to " +
         rounded(static_cast<double>(advice.end) / sampling_rate_hz, 4) + " s, " + best->name +
         " leaves " + rounded(100. * least / advice.moment_rms_n_m, 3) +
         " % of the moment; a model of the earlier part ('vibrissa identify', then --model) "
         "leaves " +
         rounded(100. * advice.left_rms_n_m / advice.moment_rms_n_m, 3) + " %";
}

}  // namespace vibrissa::apps
