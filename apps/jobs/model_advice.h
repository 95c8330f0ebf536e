#pragma once

#include <optional>
#include <string>
#include <vector>

#include "separation/model/fitted_bvrm.h"
#include "signals/record/record.h"
#include "views/records/separation_scores.h"

namespace vibrissa::apps {

/// What an identification of the record itself tells about its separation without a model.
struct ModelAdvice {
  /// By which the moment is later than the acceleration (see separation::estimate_delay()); nothing
  /// when none was found.
  std::optional<separation::Estimate> delay_s;
  /// The part of the record that the model has not seen, and what the model leaves of its moment.
  std::size_t first = 0, end = 0;
  double moment_rms_n_m = 0., left_rms_n_m = 0.;
};

/// Identifies the first 30000 samples; nothing when they do not determine a model.
std::optional<ModelAdvice> model_advice(const signals::Record& record);

/// The record with its acceleration earlier by the lead of the moment, for filters that only know
/// the past. Returns the record itself when the moment does not lead.
signals::Record without_lead(const signals::Record& record, const ModelAdvice& advice);

/// A sentence when the model leaves clearly less than the best of these methods where no wind
/// blows, which is told by how much of the moment the model explains; else empty.
std::string advice_words(const ModelAdvice& advice,
                         const std::vector<views::SeparatedSignal>& signals,
                         double sampling_rate_hz);

}  // namespace vibrissa::apps
