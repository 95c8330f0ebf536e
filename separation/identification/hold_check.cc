#include "separation/identification/hold_check.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "separation/model/simulation.h"
#include "separation/numerics/significance.h"
#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

constexpr double significant = 4.;  // standard deviations

struct Candidate {
  HoldTrial trial;
  std::vector<double> squared_residual;  // of all segments, one after the other
};

Candidate try_hold(const Bvrm& model, std::span<const Segment> segments, double rate_hz,
                   SrivcOptions options, Hold hold) {
  options.hold = hold;
  Candidate result;
  result.trial.hold = hold;
  result.trial.fit = refine_srivc(model, segments, rate_hz, options);
  double sum = 0.;
  for (const Segment& segment : segments) {
    const auto simulated = simulate_like(result.trial.fit.model, segment.base_acceleration,
                                         segment.base_moment, rate_hz, hold, options.nuisance);
    for (std::size_t i = 0; i < simulated.size(); ++i) {
      result.squared_residual.push_back(std::pow(segment.base_moment[i] - simulated[i], 2));
      sum += result.squared_residual.back();
    }
  }
  result.trial.residual_rms_n_m =
      std::sqrt(sum / static_cast<double>(result.squared_residual.size()));
  result.trial.unphysical_lead_s = unphysical_lead(result.trial.fit);
  return result;
}

bool is_told_from_aliases(const Bvrm& model, const Hold hold, const double rate_hz) {
  return std::ranges::all_of(model.modes, [&](const ModalTerm& mode) {
    return is_stable_below(mode, highest_rad_s(hold, rate_hz));
  });
}

// Differences below this share of the squared moment are rounding.
bool smaller_residual(const Candidate& told, const Candidate& other, double mean_square_moment) {
  const double gain =
      std::pow(told.trial.residual_rms_n_m, 2) - std::pow(other.trial.residual_rms_n_m, 2);
  return gain > 1e-12 * mean_square_moment &&
         mean_difference_significance(told.squared_residual, other.squared_residual) > significant;
}

bool delayed(const HoldTrial& told, const HoldTrial& other, double rate_hz) {
  constexpr double share_of_sample = 0.2;
  const Estimate &lead = told.unphysical_lead_s, &other_lead = other.unphysical_lead_s;
  return std::abs(lead.value) * rate_hz > share_of_sample &&
         std::abs(lead.value) > significant * lead.standard_deviation &&
         std::abs(other_lead.value) < std::abs(lead.value) / 3.;
}

std::string residual_words(const HoldTrial& told, const HoldTrial& other) {
  std::ostringstream text;
  text.precision(3);
  text << to_string(other.hold) << " is the likely hold of the acceleration: the residual is "
       << other.residual_rms_n_m << " N m with it, but " << told.residual_rms_n_m
       << " N m with the given hold " << to_string(told.hold);
  return text.str();
}

std::string delay_words(const HoldTrial& told, const HoldTrial& other, double rate_hz) {
  std::ostringstream text;
  text.precision(3);
  const double lead = told.unphysical_lead_s.value;
  text << "either " << to_string(other.hold)
       << " is the hold of the acceleration, or the two channels are shifted by "
       << std::abs(lead) * 1e3 << " ms (" << std::abs(lead) * rate_hz
       << " samples): with the given hold " << to_string(told.hold) << " the moment "
       << (lead > 0. ? "leads" : "lags behind")
       << " the response of a vibrating mode by this time; with " << to_string(other.hold)
       << " it does not";
  return text.str();
}

double mean_square(std::span<const Segment> segments) {
  double sum = 0., n = 0.;
  for (const Segment& segment : segments)
    for (const double m : segment.base_moment) sum += m * m, n += 1.;
  return sum / n;
}

}  // namespace

Estimate unphysical_lead(const FittedBvrm& fit) {
  const auto& modes = fit.model.modes;
  const auto peak = [](const ModalTerm& m) { return std::abs(m.b0) / (m.a1 * std::sqrt(m.a0)); };
  const auto strongest = std::ranges::max_element(modes, {}, peak);
  const auto first = parameters_per_mode * (strongest - modes.begin());
  const double lead = strongest->b1 / strongest->b0;
  const Eigen::Vector2d by_gains(1. / strongest->b0, -lead / strongest->b0);
  const double variance = by_gains.dot(fit.covariance.block<2, 2>(first, first) * by_gains);
  const double most = 2. * strongest->damping_ratio() / std::sqrt(strongest->a0);
  return {lead < 0. ? lead : std::max(0., lead - most), std::sqrt(variance)};
}

HoldDiagnosis check_hold(const Bvrm& model, std::span<const Segment> segments,
                         double sampling_rate_hz, const SrivcOptions& told) {
  if (model.modes.empty()) throw signals::UserError("hold check: the model has no mode");
  std::vector<Candidate> candidates{try_hold(model, segments, sampling_rate_hz, told, told.hold)};
  // A mode that can be distinguished from its aliases under band_limited may not be under the other
  // holds.
  for (const Hold hold : {Hold::zero_order, Hold::first_order, Hold::band_limited})
    if (hold != told.hold && is_told_from_aliases(model, hold, sampling_rate_hz))
      candidates.push_back(try_hold(model, segments, sampling_rate_hz, told, hold));

  HoldDiagnosis diagnosis{.told = told.hold, .likely = told.hold, .words = {}, .trials = {}};
  for (const Candidate& candidate : candidates) diagnosis.trials.push_back(candidate.trial);
  const Candidate& first = candidates[0];
  const double size = mean_square(segments);
  const auto by_residual = [](const Candidate& c) { return c.trial.residual_rms_n_m; };
  const Candidate& smallest = *std::ranges::min_element(candidates, {}, by_residual);
  const HoldTrial* likely = nullptr;
  if (smaller_residual(first, smallest, size)) {
    likely = &smallest.trial;
    diagnosis.words = residual_words(first.trial, *likely);
  }
  // Among holds that explain the records equally well, the one whose modes can exist.
  const Candidate& best = likely ? smallest : first;
  for (const Candidate& other : candidates) {
    if (&other == &best || smaller_residual(other, best, size) ||
        !delayed(best.trial, other.trial, sampling_rate_hz))
      continue;
    const std::string words = delay_words(best.trial, other.trial, sampling_rate_hz);
    diagnosis.words = likely ? diagnosis.words + "; " + words : words;
    likely = &other.trial;
    break;
  }
  if (likely) diagnosis.likely = likely->hold;
  // Two steps may lead back to the given hold.
  if (diagnosis.likely == told.hold) diagnosis.words.clear();
  return diagnosis;
}

}  // namespace vibrissa::separation
