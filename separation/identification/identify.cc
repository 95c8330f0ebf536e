#include "separation/identification/identify.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "separation/identification/identify_frequency.h"
#include "separation/identification/order_selection.h"
#include "separation/identification/output_error.h"
#include "separation/identification/srivc.h"
#include "separation/metrics/metrics.h"
#include "signals/base/error.h"
#include "signals/base/is_constant.h"
#include "signals/base/number_text.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

namespace {

const std::array<std::pair<IdentifyMethod, std::string>, 3> method_names = {
    {{IdentifyMethod::output_error, "output-error"},
     {IdentifyMethod::srivc, "srivc"},
     {IdentifyMethod::frequency, "frequency"}}};

using signals::Record;
using signals::UserError;
namespace channel = signals::channel;

void check_channel(const Record& record, const std::string& name, const std::string& which) {
  const auto x = record.channel(name);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i]))
      throw UserError("identification: " + name + " of the " + which + " is not finite at sample " +
                      std::to_string(i) + " (" + signals::to_text(record.time_s(i)) + " s)");
  if (signals::is_constant(x))
    throw UserError("identification: " + name + " of the " + which +
                    " is constant, so no model can be identified from it");
}

void check_record(const Record& record, double sampling_rate_hz, const std::string& which) {
  check_channel(record, channel::base_acceleration, which);
  check_channel(record, channel::base_moment, which);
  if (record.sampling_rate_hz() != sampling_rate_hz)
    throw UserError("identification: the " + which + " has a sampling rate of " +
                    signals::to_text(record.sampling_rate_hz()) +
                    " Hz, but the first fit record has " + signals::to_text(sampling_rate_hz) +
                    " Hz; resample one of them");
}

void check_all(std::span<const Record> fit_records, const Record& held_out,
               const IdentifyOptions& options) {
  if (fit_records.empty()) throw UserError("identification: no fit record is given");
  const double rate = fit_records[0].sampling_rate_hz();
  for (std::size_t i = 0; i < fit_records.size(); ++i)
    check_record(fit_records[i], rate, "fit record " + std::to_string(i + 1));
  check_record(held_out, rate, "held-out record");
  const std::size_t order = options.order.value_or(options.max_order);
  if (order == 0 || order % 2 != 0)
    throw UserError("identification: order = " + std::to_string(order) +
                    " must be an even number of poles, at least 2 (two for each mode)");
}

std::size_t total_samples(std::span<const Record> records) {
  std::size_t n = 0;
  for (const Record& record : records) n += record.n_samples();
  return n;
}

Eigen::Index n_unknowns(std::size_t order, std::size_t n_records, const IdentifyOptions& options) {
  const std::size_t nuisance =
      (options.nuisance.initial_state ? order : 0) + options.nuisance.offset;
  return n_parameters(order / 2, options.direct_term) +
         static_cast<Eigen::Index>(n_records * nuisance);
}

// Highest order for which the records have at least four samples an unknown.
std::size_t affordable_order(std::span<const Record> records, const IdentifyOptions& options) {
  const std::size_t wanted = options.order.value_or(options.max_order);
  const auto n = static_cast<Eigen::Index>(total_samples(records));
  std::size_t order = wanted;
  while (order >= 2 && 4 * n_unknowns(order, records.size(), options) > n) order -= 2;
  if (order == 0 || (options.order && order < wanted))
    throw UserError(
        "identification: " + std::to_string(n) +
        " samples of the fit records are too few for a model of order " +
        std::to_string(options.order.value_or(2)) + " (at least " +
        std::to_string(4 * n_unknowns(options.order.value_or(2), records.size(), options)) +
        " are needed)");
  return order;
}

signals::FrequencyResponse measured_response(std::span<const Record> records,
                                             std::size_t period_samples) {
  const Record& longest = *std::ranges::max_element(records, {}, &Record::n_samples);
  const auto input = longest.channel(channel::base_acceleration);
  const auto output = longest.channel(channel::base_moment);
  if (period_samples > 0)
    return signals::periodic_response(input, output, longest.sampling_rate_hz(), period_samples);
  constexpr std::size_t shortest_segment = 32, longest_segment = 2048;
  const std::size_t segment =
      std::clamp(std::bit_floor(longest.n_samples() / 4), shortest_segment, longest_segment);
  return signals::welch_response(input, output, longest.sampling_rate_hz(),
                                 {.segment_samples = segment});
}

std::vector<Segment> segments_of(std::span<const Record> records) {
  std::vector<Segment> segments;
  for (const Record& record : records)
    segments.push_back({.base_acceleration = record.channel(channel::base_acceleration),
                        .base_moment = record.channel(channel::base_moment)});
  return segments;
}

double information_criterion(const FittedBvrm& fit, double n_samples, double n_unknowns,
                             double mean_square_moment) {
  // Errors below the rounding level count as equal.
  const double mean_square = std::max(fit.residual_variance * (n_samples - n_unknowns) / n_samples,
                                      1e-24 * mean_square_moment);
  return n_samples * std::log(mean_square) + n_unknowns * std::log(n_samples);
}

struct Trial {
  FittedBvrm fit;
  IdentificationTrial summary;
};

class Identifier {
 public:
  Identifier(std::span<const Record> records, const IdentifyOptions& options)
      : records_(records),
        options_(options),
        rate_(records[0].sampling_rate_hz()),
        n_samples_(static_cast<double>(total_samples(records))),
        order_(affordable_order(records, options)),
        response_(measured_response(records, options.period_samples)),
        segments_(segments_of(records)) {
    for (const Segment& segment : segments_)
      for (const double m : segment.base_moment) mean_square_moment_ += m * m / n_samples_;
  }

  std::vector<Trial> run() const {
    std::vector<Trial> trials;
    const std::vector<Hold> holds = options_.hold
                                        ? std::vector<Hold>{*options_.hold}
                                        : std::vector<Hold>{Hold::first_order, Hold::band_limited};
    for (const Hold hold : holds) try_hold(hold, trials);
    if (trials.empty())
      throw UserError("identification: the frequency response of " +
                      std::to_string(response_.frequency_hz.size()) +
                      " excited lines does not determine a model of order " +
                      std::to_string(options_.order.value_or(2)) +
                      "; excite more lines or lower the order");
    return trials;
  }

  /// Nothing when the order was given, or the records are too short to hold a part out.
  std::optional<OrderSelection> select(Hold hold, std::size_t max_order) const {
    constexpr std::size_t fewest_samples = 400;
    const auto too_short = [](const Segment& s) { return s.base_moment.size() < fewest_samples; };
    if (options_.order || max_order == 2 || std::ranges::any_of(segments_, too_short)) return {};
    return select_order(segments_, rate_,
                        {.max_order = max_order,
                         .delay_s = options_.delay_s,
                         .fit = fit_options(hold),
                         .period_samples = options_.period_samples});
  }

  double duration_s() const { return n_samples_ / rate_; }

  /// The same order and hold by another method.
  FittedBvrm refit(IdentifyMethod method, std::size_t order, Hold hold) const {
    if (method == IdentifyMethod::srivc) {
      SrivcOptions srivc;
      srivc.hold = hold;
      srivc.direct_term = options_.direct_term;
      srivc.nuisance = options_.nuisance;
      return refine_srivc(frequency_fit(order, hold).model, segments_, rate_, srivc);
    }
    return frequency_fit(order, hold);
  }

 private:
  void try_hold(Hold hold, std::vector<Trial>& trials) const {
    for (FittedBvrm& fit :
         fit_orders(response_, segments_, rate_, order_, options_.delay_s, fit_options(hold)))
      if (!options_.order || fit.model.order() == *options_.order)
        trials.push_back(summarise(std::move(fit), hold));
  }

  FittedBvrm frequency_fit(std::size_t order, Hold hold) const {
    FrequencyFitOptions frequency;
    frequency.order = order;
    frequency.direct_term = options_.direct_term;
    frequency.delay_s = options_.delay_s;
    frequency.sampling = Sampling{rate_, hold};
    return identify_frequency(response_, frequency);
  }

  OutputErrorOptions fit_options(Hold hold) const {
    return {.hold = hold, .direct_term = options_.direct_term, .nuisance = options_.nuisance};
  }

  Trial summarise(FittedBvrm fit, Hold hold) const {
    const std::size_t order = fit.model.order();
    const auto unknowns = static_cast<double>(n_unknowns(order, records_.size(), options_));
    IdentificationTrial summary{.order = order,
                                .hold = hold,
                                .residual_rms_n_m = std::sqrt(fit.residual_variance),
                                .information_criterion = information_criterion(
                                    fit, n_samples_, unknowns, mean_square_moment_),
                                .end = fit.end};
    return {std::move(fit), summary};
  }

  std::span<const Record> records_;
  const IdentifyOptions& options_;
  double rate_, n_samples_;
  std::size_t order_;
  signals::FrequencyResponse response_;
  std::vector<Segment> segments_;
  double mean_square_moment_ = 0.;
};

// The records do not determine a mode that hardly decays within them: it is near a line of the
// input and fits that line through the accelerometer noise. In a separator that starts at rest it
// would oscillate without end.
std::optional<double> lasting_mode_hz(const Bvrm& model, double duration_s) {
  const auto lasting = std::ranges::find_if(
      model.modes, [&](const ModalTerm& mode) { return 0.5 * mode.a1 * duration_s < 1.; });
  if (lasting == model.modes.end()) return std::nullopt;
  return lasting->frequency_hz();
}

// The lowest criterion among the converged fits with decaying modes; among all fits when there is
// none.
const Trial& choose(const std::vector<Trial>& trials, double duration_s) {
  const auto rank = [&](const Trial& trial) {
    return std::pair(trial.fit.end != FitEnd::converged ||
                         lasting_mode_hz(trial.fit.model, duration_s).has_value(),
                     trial.summary.information_criterion);
  };
  return *std::ranges::min_element(trials, {}, rank);
}

/// The highest order under this hold up to which every model decays, and why the next does not.
struct DecayingOrders {
  std::size_t highest = 2;
  std::string words;
};

DecayingOrders decaying_orders(const std::vector<Trial>& trials, Hold hold, double duration_s) {
  DecayingOrders orders;
  for (const Trial& trial : trials) {
    if (trial.summary.hold != hold) continue;
    if (const auto mode_hz = lasting_mode_hz(trial.fit.model, duration_s)) {
      orders.words = "; order " + std::to_string(trial.summary.order) +
                     " was not considered, because its mode at " +
                     signals::to_text(std::round(10. * *mode_hz) / 10.) +
                     " Hz does not decay within the record";
      break;
    }
    orders.highest = trial.summary.order;
  }
  return orders;
}

// The one with the hold of the first choice and this order; the first choice when there is none.
const Trial& of_order(const std::vector<Trial>& trials, const Trial& first, std::size_t order) {
  const auto found = std::ranges::find_if(trials, [&](const Trial& trial) {
    return trial.summary.hold == first.summary.hold && trial.summary.order == order &&
           trial.fit.end == FitEnd::converged;
  });
  return found == trials.end() ? first : *found;
}

std::vector<double> free_simulation(const Bvrm& model, const Record& record, Hold hold,
                                    const Nuisance& nuisance) {
  return simulate_like(model, record.channel(channel::base_acceleration),
                       record.channel(channel::base_moment), record.sampling_rate_hz(), hold,
                       nuisance);
}

}  // namespace

std::string to_string(IdentifyMethod method) {
  for (const auto& [value, name] : method_names)
    if (value == method) return name;
  return {};
}

IdentifyMethod parse_identify_method(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [value, text] : method_names) {
    if (text == name) return value;
    known.push_back(text);
  }
  throw UserError(signals::unknown_name("identification method", name, known));
}

SplitRecord hold_out_last_third(const Record& record, std::size_t multiple) {
  const std::size_t n_fit = 2 * record.n_samples() / 3 / multiple * multiple;
  return {.fit = record.slice(0, n_fit),
          .held_out = record.slice(n_fit, record.n_samples() - n_fit)};
}

Identification identify_bvrm(std::span<const Record> fit_records, const Record& held_out,
                             const IdentifyOptions& options) {
  check_all(fit_records, held_out, options);
  const Identifier identifier(fit_records, options);
  const std::vector<Trial> trials = identifier.run();
  const double duration_s = identifier.duration_s();
  const Trial& first = choose(trials, duration_s);
  const DecayingOrders decaying = decaying_orders(trials, first.summary.hold, duration_s);
  const std::optional<OrderSelection> selection =
      identifier.select(first.summary.hold, decaying.highest);
  const bool held_out_rules = options.order_rule == OrderRule::cross_validation;
  const Trial& best = !selection ? first
                                 : of_order(trials, first,
                                            held_out_rules ? selection->by_cross_validation
                                                           : selection->by_information);
  Identification result;
  if (selection) {
    result.order_words = selection->words + decaying.words;
    const std::size_t asked =
        held_out_rules ? selection->by_cross_validation : selection->by_information;
    if (asked != best.summary.order) {
      result.order_words += "; the fit of order " + std::to_string(asked) +
                            " to the whole record did not converge, so order " +
                            std::to_string(best.summary.order) + " is returned";
    }
  }
  result.fit = options.method == IdentifyMethod::output_error
                   ? best.fit
                   : identifier.refit(options.method, best.summary.order, best.summary.hold);
  result.hold = best.summary.hold;
  result.order = best.summary.order;
  for (const Trial& trial : trials) result.trials.push_back(trial.summary);
  const auto held_out_moment = held_out.channel(channel::base_moment);
  const auto simulated = free_simulation(result.fit.model, held_out, result.hold, options.nuisance);
  result.held_out_fit_percent = fit_percent(held_out_moment, simulated);
  result.held_out_vaf_percent = vaf_percent(held_out_moment, simulated);
  const Record& shown = fit_records[0];
  result.fit_record_fit_percent =
      fit_percent(shown.channel(channel::base_moment),
                  free_simulation(result.fit.model, shown, result.hold, options.nuisance));
  return result;
}

Identification identify_bvrm(const Record& fit_record, const Record& held_out,
                             const IdentifyOptions& options) {
  return identify_bvrm(std::span(&fit_record, 1), held_out, options);
}

}  // namespace vibrissa::separation
