#include "separation/nonlinear/identify_nonlinear.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "separation/metrics/metrics.h"
#include "separation/verdict/identification_json.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using signals::Record;
namespace channel = signals::channel;

Segment segment_of(const Record& record) {
  return {record.channel(channel::base_acceleration), record.channel(channel::base_moment)};
}

double rms(std::span<const double> x) {
  double sum = 0.;
  for (const double value : x) sum += value * value / static_cast<double>(x.size());
  return std::sqrt(sum);
}

double deviation(std::span<const double> x) {
  double mean = 0.;
  for (const double value : x) mean += value / static_cast<double>(x.size());
  return std::sqrt(std::max(0., std::pow(rms(x), 2) - mean * mean));
}

// A joint law acts with the level, so the quietest third is the most linear one.
Record quietest_part(const Record& record) {
  const std::size_t third = record.n_samples() / 3;
  std::size_t quietest = 0;
  double least = 0., most = 0.;
  for (std::size_t k = 0; k < 3; ++k) {
    const double level =
        deviation(record.slice(k * third, third).channel(channel::base_acceleration));
    if (k == 0 || level < least) {
      least = level;
      quietest = k;
    }
    most = std::max(most, level);
  }
  return least < 0.5 * most ? record.slice(quietest * third, third) : record;
}

LawChoice best_choice(const Bvrm& start, std::span<const Segment> segments, double rate_hz,
                      const LawChoiceOptions& options) {
  // Modes of the linear fit may only have stood for the law.
  Bvrm alone = start;
  alone.modes = {start.modes[strongest_mode(start, segments, rate_hz, options.fit.hold)]};
  LawChoice fewer = choose_law(alone, segments, rate_hz, options);
  const NonlinearBvrm all{.linear = start, .mode = 0, .law = {}};
  if (start.modes.size() == 1 ||
      !NonlinearProblem(all, segments, rate_hz, options.fit).admissible(all))
    return fewer;
  LawChoice choice = choose_law(start, segments, rate_hz, options);
  return !fewer.model.law.empty() && fewer.unseen_rms_n_m <= choice.unseen_rms_n_m ? fewer : choice;
}

std::string describe(const NonlinearIdentification& found) {
  if (found.fit.end != FitEnd::converged)
    return "the fit ended with " + to_string(found.fit.end) +
           ", so the model cannot be believed: record longer, or at a lower level";
  if (!found.has_law())
    return "the record asks for no joint law: no term lowers the error on unseen data "
           "significantly";
  std::string terms;
  for (const LawTerm& term : found.fit.model.law)
    terms += (terms.empty() ? "" : ", ") + term.name();
  return "the record asks for " + terms + "; the channel shows the " +
         (found.fit.model.readout == LawReadout::moment ? "moment of the joint with its law"
                                                        : "deflection alone") +
         "; valid to a deflection of " + signals::to_text(found.fit.model.largest_deflection_m) +
         " m of the mode and a speed of " + signals::to_text(found.fit.model.largest_speed_m_s) +
         " m/s, beyond by extrapolation";
}

void score(const Record& held_out, const OutputErrorOptions& fit, NonlinearIdentification& found) {
  const Segment segment = segment_of(held_out);
  const double rate = held_out.sampling_rate_hz();
  const std::vector<double> error =
      nonlinear_errors(found.scored, std::span(&segment, 1), rate, fit).front();
  found.held_out_rms_n_m = rms(error);
  OutputErrorOptions linear = fit;
  linear.hold = found.linear.hold;
  found.linear_held_out_rms_n_m =
      rms(output_errors(found.linear.scored, std::span(&segment, 1), rate, linear));
  std::vector<double> simulated(error.size());
  for (std::size_t i = 0; i < error.size(); ++i) simulated[i] = segment.base_moment[i] - error[i];
  found.held_out_fit_percent = fit_percent(segment.base_moment, simulated);
}

}  // namespace

NonlinearIdentification identify_nonlinear(const Record& record,
                                           const std::optional<Record>& held_out,
                                           const IdentifyOptions& options) {
  if (options.method != IdentifyMethod::output_error)
    throw signals::UserError("nonlinear identification: the method is output-error; leave out '" +
                             to_string(options.method) + "'");
  const auto [fit_record, scoring] =
      held_out ? SplitRecord{record, *held_out} : hold_out_part(record);
  NonlinearIdentification found;
  found.linear = identify_bvrm(fit_record, scoring, options);
  const Record quiet = quietest_part(fit_record);
  const double rate = record.sampling_rate_hz();
  const Identification low = quiet.n_samples() < fit_record.n_samples()
                                 ? identify_bvrm(quiet, scoring, options)
                                 : found.linear;
  LawChoiceOptions choice{.fit = {.hold = low.hold,
                                  .direct_term = low.direct_term,
                                  .viscous_term = low.viscous_term,
                                  .nuisance = options.nuisance}};
  const Segment fitted = segment_of(fit_record);
  found.choice = best_choice(low.fit.model, std::span(&fitted, 1), rate, choice);
  found.scored =
      refine_nonlinear(found.choice.model, std::span(&fitted, 1), rate, choice.fit).model;
  std::vector<Segment> all{segment_of(record)};
  if (held_out) all.push_back(segment_of(*held_out));
  found.fit = refine_nonlinear(found.scored, all, rate, choice.fit);
  score(scoring, choice.fit, found);
  found.words = describe(found);
  return found;
}

nlohmann::json nonlinear_report(const NonlinearIdentification& found) {
  const NonlinearBvrm& model = found.fit.model;
  const Eigen::Index n = n_parameters(model.linear.modes.size(), true);
  nlohmann::json document = fitted_json(make_fitted(to_parameters(model.linear, true),
                                                    found.fit.covariance.topLeftCorner(n, n), true,
                                                    model.linear.delay_s));
  document["end"] = to_string(found.fit.end);
  document["law"] = nlohmann::json::array();
  for (std::size_t k = 0; k < model.law.size(); ++k)
    document["law"].push_back({{"term", model.law[k].name()},
                               {"coefficient", model.law[k].coefficient},
                               {"coefficient_sd", found.fit.coefficient_deviation(k)},
                               {"unit", model.law[k].unit()}});
  document["readout"] = to_string(model.readout);
  document["hold"] = to_string(model.hold_or({}));
  document["held_out_rms_N_m"] = found.held_out_rms_n_m;
  document["linear_held_out_rms_N_m"] = found.linear_held_out_rms_n_m;
  document["fit_percent"] = found.held_out_fit_percent;
  document["largest_deflection_m"] = model.largest_deflection_m;
  document["largest_speed_m_s"] = model.largest_speed_m_s;
  document["trials"] = nlohmann::json::array();
  for (const LawTrial& trial : found.choice.trials)
    document["trials"].push_back({{"term", trial.term},
                                  {"readout", trial.readout},
                                  {"unseen_rms_N_m", trial.unseen_rms_n_m},
                                  {"gain_deviations", trial.gain_deviations},
                                  {"accepted", trial.accepted}});
  document["words"] = found.words;
  return document;
}

}  // namespace vibrissa::separation
