#include "diagnosis/checks/period_check.h"

#include <algorithm>
#include <numbers>

#include "diagnosis/model/words.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// Share of the power that lies in tones off the lines of the period.
double share_between(const std::vector<double>& power, std::size_t n_periods) {
  std::vector<double> between;
  double all = 0., off = 0.;
  for (std::size_t k = 1; k + 1 < power.size(); ++k) {
    all += power[k];
    if (k % n_periods == 0) continue;
    off += power[k];
    between.push_back(power[k]);
  }
  constexpr double coloured = 5.;
  if (all == 0. || colour(between) < coloured) return 0.;
  return off / all;
}

}  // namespace

void check_period(const signals::DatasetRecord& entry, std::vector<Finding>& findings) {
  const std::string& name = signals::channel::base_acceleration;
  const std::size_t period = entry.period_samples, n = entry.record.n_samples();
  if (period == 0 || !entry.excitation.base || !entry.record.has(name)) return;
  if (n % period != 0) {
    findings.push_back({FindingKind::partial_period, entry.name,
                        std::to_string(n) + " samples are not a whole number of periods of " +
                            std::to_string(period) +
                            " samples: the record is treated as not periodic"});
    return;
  }
  constexpr double much = 0.2;
  const double share = share_between(powers(spectrum_of(entry.record.channel(name))), n / period);
  if (share > much)
    findings.push_back(
        {FindingKind::broken_period, entry.name,
         "base_acceleration_m_s2 does not repeat after " + std::to_string(period) +
             " samples: " + three_digits(100. * share) +
             " % of its power lies off the lines of that period; correct period_samples in "
             "dataset.json (0 for a record that does not repeat)"});
}

}  // namespace vibrissa::diagnosis
