#include "trial/generator/record_set.h"

#include <algorithm>

namespace vibrissa::trial {
namespace {

constexpr double the_level = 4.4;  // m/s^2, of the higher usual take

bool has_wind(const Take& take) {
  return take.wind_mean > 0.;
}

bool has_fan(const RecordSet set) {
  return set != RecordSet::base_only && set != RecordSet::two_files;
}

std::vector<Take> at_one_level(std::vector<Take> takes) {
  std::erase_if(takes, [](const Take& take) {
    return take.name == "base_low" || take.name == "other_level";
  });
  for (Take& take : takes)
    if (take.base_rms > 0.) take.base_rms = the_level;
  return takes;
}

}  // namespace

std::vector<Take> takes_of(const RecordSet set) {
  if (set == RecordSet::two_files)
    return {{.name = "bench", .base_rms = 3., .n_samples = 10000, .drive = 9}};
  std::vector<Take> out = usual_takes();
  for (const Take& take : transfer_takes()) out.push_back(take);
  if (set == RecordSet::base_only)
    std::erase_if(out, [](const Take& take) { return take.base_rms == 0. || has_wind(take); });
  if (set == RecordSet::no_rest)
    std::erase_if(out, [](const Take& take) { return take.is_at_rest(); });
  return set == RecordSet::one_level ? at_one_level(std::move(out)) : out;
}

bool has_wind_channel(const RecordSet set) {
  return has_fan(set) && set != RecordSet::no_wind_channel;
}

std::vector<FurtherExperiment> further_experiments(const RecordSet set) {
  std::vector<FurtherExperiment> out = further_experiments();
  if (!has_fan(set))
    std::erase_if(out, [](const FurtherExperiment& experiment) {
      return std::any_of(experiment.takes.begin(), experiment.takes.end(), has_wind);
    });
  return out;
}

double noise_factor(const RecordSet set) {
  return set == RecordSet::ten_times_noise ? 10. : 1.;
}

}  // namespace vibrissa::trial
