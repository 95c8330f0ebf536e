#include "separation/filters/separator.h"

#include <algorithm>
#include <cmath>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

std::vector<double> checked_channel(const signals::Record& record, const std::string& name,
                                    std::size_t n_tail) {
  const auto x = record.channel(name);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i]))
      throw signals::UserError("separation: " + name + " is not finite at sample " +
                               std::to_string(i) + " (" + signals::to_text(record.time_s(i)) +
                               " s); remove or replace this sample");
  std::vector<double> values(x.begin(), x.end());
  values.resize(x.size() + n_tail, x.back());
  return values;
}

}  // namespace

std::vector<double> separate_record(Separator& separator, const signals::Record& record) {
  const std::size_t latency = separator.latency_samples();
  // The last samples are repeated until the separator has returned all results.
  const auto acceleration = checked_channel(record, signals::channel::base_acceleration, latency);
  std::vector<double> moment = checked_channel(record, signals::channel::base_moment, latency);
  separator.reset();
  separator.process(acceleration, moment, moment);
  moment.erase(moment.begin(), moment.begin() + static_cast<std::ptrdiff_t>(latency));
  return moment;
}

}  // namespace vibrissa::separation
