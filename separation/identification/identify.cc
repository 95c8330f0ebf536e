#include "separation/identification/identify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "separation/identification/channel_delay.h"
#include "separation/identification/identify_frequency.h"
#include "separation/identification/order_selection.h"
#include "separation/identification/output_error.h"
#include "separation/identification/piece_scatter.h"
#include "separation/identification/srivc.h"
#include "separation/identification/structure_choice.h"
#include "separation/metrics/metrics.h"
#include "separation/metrics/residual_tests.h"
#include "separation/numerics/significance.h"
#include "separation/segments/hit_blocks.h"
#include "signals/base/error.h"
#include "signals/base/is_constant.h"
#include "signals/base/number_text.h"
#include "signals/record/unusable_channel.h"

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
  if (const auto unusable = signals::unusable_channel(record, name))
    throw UserError("identification: " + name + " of the " + which + " " + unusable->reason +
                    (unusable->is_constant ? ", so no model can be identified from it" : ""));
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
  if (std::ranges::all_of(fit_records, [&](const Record& record) {
        return record.n_samples() < options.period_samples;
      }))
    throw UserError("identification: the fit records contain no whole period of " +
                    std::to_string(options.period_samples) + " samples");
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

/// A model of the selected order with all allowed unknowns.
struct Selected {
  FittedBvrm fit;
  Hold hold = Hold::first_order;
  std::string words;
};

class Identifier {
 public:
  Identifier(std::span<const Record> records, const IdentifyOptions& options)
      : records_(records),
        options_(options),
        rate_(records[0].sampling_rate_hz()),
        n_samples_(static_cast<double>(total_samples(records))),
        segments_(segments_of(records)) {}

  Selected select() const {
    const auto too_short = [](const Segment& s) {
      return s.base_moment.size() < fewest_samples_for_order;
    };
    const std::size_t highest = affordable_order(records_, options_);
    if (options_.order || highest == 2 || std::ranges::any_of(segments_, too_short))
      return by_criterion(highest);
    return by_held_out_parts(highest);
  }

  /// What the records determine of a model of this order.
  ModelStructure structure_of(const Selected& selected) const {
    const OutputErrorOptions allowed = fit_options(selected.hold);
    if (!selected.fit.covariance.allFinite()) return {selected.hold, allowed.direct_term, true};
    static const std::vector<Hold> all{Hold::first_order, Hold::zero_order, Hold::band_limited};
    return choose_structure(selected.fit, segments_, rate_,
                            options_.hold ? std::vector<Hold>{*options_.hold} : all, allowed);
  }

  /// The model of these unknowns by the method of the options.
  ScatteredFit fit(const Bvrm& start, const ModelStructure& structure) const {
    OutputErrorOptions output_error = fit_options(structure.hold);
    if (options_.method == IdentifyMethod::output_error) {
      output_error.direct_term = structure.direct_term;
      output_error.viscous_term = structure.viscous_term;
      return widen_by_scatter(refine_output_error(start, segments_, rate_, output_error), segments_,
                              rate_, output_error);
    }
    return widen_by_scatter(by_other_method(start, structure.hold), segments_, rate_, output_error);
  }

 private:
  /// The holds that differ while all unknowns are free.
  std::vector<Hold> holds() const {
    if (options_.hold) return {*options_.hold};
    if (options_.direct_term) return {Hold::first_order, Hold::band_limited};
    return {Hold::first_order, Hold::zero_order, Hold::band_limited};
  }

  Selected by_held_out_parts(std::size_t highest) const {
    OrderOptions choice{.max_order = highest,
                        .delay_s = options_.delay_s,
                        .fit = fit_options(holds().front()),
                        .holds = holds(),
                        .period_samples = options_.period_samples};
    // The end of a ring-down tells nothing of modes that have decayed.
    constexpr std::size_t fruitless_after_hit = 5;
    if (!hits_of(segments_[0].base_acceleration).empty())
      choice.fruitless_orders = fruitless_after_hit;
    const OrderSelection selection = select_order(segments_, rate_, choice);
    const std::size_t asked = options_.order_rule == OrderRule::cross_validation
                                  ? selection.by_cross_validation
                                  : selection.by_information;
    Selected selected = first_converged(selection, asked);
    const std::size_t order = selected.fit.model.order();
    if (asked != order)
      selected.words += "; the fit of order " + std::to_string(asked) +
                        " to the whole record did not converge, so order " + std::to_string(order) +
                        " is returned";
    else if (order == options_.max_order)
      selected.words +=
          "; this is the highest order that was tried, so more modes may be there: "
          "allow more (--max-order)";
    else if (order == highest)
      selected.words += "; this is the highest order that the samples of the record allow";
    return selected;
  }

  bool has_lasting_mode(const FittedBvrm& fit) const {
    return !are_hits(segments_) && !lasting_modes_hz(fit.model, n_samples_ / rate_).empty();
  }

  /// The model of the order asked for, fitted to the whole records; when that does not converge or
  /// decay, of the lower order with the smallest criterion, then of a higher one; of the order
  /// asked for when none does.
  Selected first_converged(const OrderSelection& selection, std::size_t asked) const {
    std::vector<const OrderTrial*> trials;
    for (const OrderTrial& trial : selection.trials) trials.push_back(&trial);
    std::ranges::sort(trials, {}, [&](const OrderTrial* trial) {
      const int rank = trial->order == asked ? 0 : trial->order < asked ? 1 : 2;
      return std::pair(rank, trial->information_criterion);
    });
    std::optional<FittedBvrm> first;
    for (const OrderTrial* trial : trials) {
      FittedBvrm fit =
          refine_output_error(trial->fit.model, segments_, rate_, fit_options(selection.hold));
      const bool decays = !has_lasting_mode(fit);
      if (fit.end == FitEnd::converged && decays)
        return {std::move(fit), selection.hold, selection.words};
      if (!first) first = std::move(fit);
    }
    return {std::move(*first), selection.hold, selection.words};
  }

  /// The lowest criterion among the converged fits with decaying modes; among all fits when there
  /// is none.
  Selected by_criterion(std::size_t highest) const {
    const signals::FrequencyResponse response =
        response_of(segments_, rate_, options_.period_samples);
    double mean_square_moment = 0.;
    for (const Segment& segment : segments_)
      for (const double m : segment.base_moment) mean_square_moment += m * m / n_samples_;
    std::optional<Selected> best;
    std::pair<bool, double> least;
    for (const Hold hold : holds())
      for (FittedBvrm& fit :
           fit_orders(response, segments_, rate_, highest, options_.delay_s, fit_options(hold))) {
        const std::size_t order = fit.model.order();
        if (options_.order && order != *options_.order) continue;
        const auto unknowns = static_cast<double>(n_unknowns(order, records_.size(), options_));
        const std::pair rank(fit.end != FitEnd::converged || has_lasting_mode(fit),
                             information_criterion(fit, n_samples_, unknowns, mean_square_moment));
        if (best && !(rank < least)) continue;
        least = rank;
        best = Selected{.fit = std::move(fit), .hold = hold, .words = {}};
      }
    if (!best)
      throw UserError("identification: the frequency response of " +
                      std::to_string(response.frequency_hz.size()) +
                      " excited lines does not determine a model of order " +
                      std::to_string(options_.order.value_or(2)) +
                      "; excite more lines or lower the order");
    return std::move(*best);
  }

  FittedBvrm by_other_method(const Bvrm& start, Hold hold) const {
    FrequencyFitOptions frequency;
    frequency.order = start.order();
    frequency.direct_term = options_.direct_term;
    frequency.delay_s = options_.delay_s;
    frequency.sampling = Sampling{rate_, hold};
    const FittedBvrm in_frequency =
        identify_frequency(response_of(segments_, rate_, options_.period_samples), frequency);
    if (options_.method == IdentifyMethod::frequency) return in_frequency;
    SrivcOptions srivc;
    srivc.hold = hold;
    srivc.direct_term = options_.direct_term;
    srivc.nuisance = options_.nuisance;
    return refine_srivc(in_frequency.model, segments_, rate_, srivc);
  }

  OutputErrorOptions fit_options(Hold hold) const {
    return {.hold = hold, .direct_term = options_.direct_term, .nuisance = options_.nuisance};
  }

  std::span<const Record> records_;
  const IdentifyOptions& options_;
  double rate_, n_samples_;
  std::vector<Segment> segments_;
};

void take(ScatteredFit scattered, Identification& result) {
  result.fit = std::move(scattered.fit);
  result.scatter_words = std::move(scattered.words);
}

std::vector<double> free_simulation(const Bvrm& model, const Record& record, Hold hold,
                                    const Nuisance& nuisance) {
  return simulate_like(model, record.channel(channel::base_acceleration),
                       record.channel(channel::base_moment), record.sampling_rate_hz(), hold,
                       nuisance);
}

std::vector<double> held_out_errors(const Bvrm& model, const Record& held_out, Hold hold,
                                    const Nuisance& nuisance) {
  const auto simulated = free_simulation(model, held_out, hold, nuisance);
  const auto moment = held_out.channel(channel::base_moment);
  std::vector<double> errors(moment.begin(), moment.end());
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] -= simulated[i];
  return errors;
}

/// Whether the model is contradicted by what the held-out record left unexplained.
bool is_doubtful(const Identification& found, const Record& held_out, const Nuisance& nuisance) {
  if (found.fit.end != FitEnd::converged) return true;
  const auto errors = held_out_errors(found.scored, held_out, found.hold, nuisance);
  ResidualTestOptions lags;
  lags.max_lag = std::min(lags.max_lag, errors.size() / samples_per_lag);
  return lags.max_lag > 0 && !signals::is_constant(errors) &&
         !test_residual(errors, held_out.channel(channel::base_acceleration), lags)
              .independence.passed();
}

/// Each hit for itself; the whole record when its input is no hit.
std::vector<Record> blocks_of(const Record& record) {
  std::vector<Record> records;
  for (const Block& block : hit_blocks(record.channel(channel::base_acceleration)))
    records.push_back(record.slice(block.first, block.end - block.first));
  if (records.empty()) records.push_back(record);
  return records;
}

struct DelayedResult {
  Identification result;
  IdentifyOptions options;
};

/// The identification with a delay between the channels, when the held-out record gains by it.
std::optional<DelayedResult> with_delay(std::span<const Record> fit, const Record& held_out,
                                        const Identification& without,
                                        const IdentifyOptions& options) {
  const std::vector<Segment> segments = segments_of(fit);
  const std::optional<Estimate> delay =
      options.delay_s == 0.
          ? estimate_delay(segments, held_out.sampling_rate_hz(),
                           {.direct_term = options.direct_term, .nuisance = options.nuisance})
          : std::nullopt;
  if (!delay) return std::nullopt;
  DelayedResult delayed{.result = {}, .options = options};
  delayed.options.delay_s = delay->value;
  delayed.result = identify_bvrm(fit, held_out, delayed.options);
  delayed.result.found_delay_s = delay;
  const auto squared = [&](const Identification& found) {
    auto errors = held_out_errors(found.scored, held_out, found.hold, options.nuisance);
    for (double& e : errors) e *= e;
    return errors;
  };
  constexpr double significant = 4.;  // standard deviations
  if (!(mean_difference_significance(squared(without), squared(delayed.result)) > significant))
    return std::nullopt;
  return delayed;
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
  Selected selected = identifier.select();
  const ModelStructure structure = identifier.structure_of(selected);
  Identification result;
  take(identifier.fit(selected.fit.model, structure), result);
  for (const Record& record : fit_records)
    result.duration_s = std::max(result.duration_s, record.duration_s());
  result.scored = result.fit.model;
  result.order_words = std::move(selected.words);
  result.hold = structure.hold;
  result.order = result.fit.model.order();
  result.direct_term = structure.direct_term;
  result.viscous_term = structure.viscous_term;
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

SplitRecord hold_out_part(const Record& record) {
  const std::vector<Block> blocks = hit_blocks(record.channel(channel::base_acceleration));
  if (blocks.size() < 2) return hold_out_last_third(record);
  const std::size_t n_fit = blocks.back().first;
  return {.fit = record.slice(0, n_fit),
          .held_out = record.slice(n_fit, record.n_samples() - n_fit)};
}

Identification identify_record(const Record& record, const IdentifyOptions& options) {
  check_record(record, record.sampling_rate_hz(), "record");
  const auto [fit, held_out] = hold_out_part(record);
  const std::vector<Record> fit_records = blocks_of(fit), all = blocks_of(record);
  IdentifyOptions used = options;
  Identification result = identify_bvrm(fit_records, held_out, used);
  if (is_doubtful(result, held_out, options.nuisance))
    if (std::optional<DelayedResult> delayed = with_delay(fit_records, held_out, result, options)) {
      used.delay_s = delayed->options.delay_s;
      result = std::move(delayed->result);
    }
  result.n_hits = hits_of(record.channel(channel::base_acceleration)).size();
  result.duration_s = record.duration_s();
  const Identifier identifier(all, used);
  take(identifier.fit(result.fit.model, {result.hold, result.direct_term, result.viscous_term}),
       result);
  return result;
}

}  // namespace vibrissa::separation
