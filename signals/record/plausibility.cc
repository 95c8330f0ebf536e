#include "signals/record/plausibility.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "signals/base/number_text.h"

namespace vibrissa::signals {
namespace {

double mean_of(const std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
}

double peak_of(const std::span<const double> values) {
  double peak = 0.;
  for (const double value : values) peak = std::max(peak, std::abs(value));
  return peak;
}

std::string to_four_decimals(const double value) {
  return to_text(std::round(value * 1e4) / 1e4);
}

void check_acceleration(const std::string& name, const std::span<const double> values,
                        std::vector<std::string>& remarks) {
  constexpr double gravity_band = 0.05, most_m_s2 = 2000.;
  const double mean = mean_of(values), peak = peak_of(values);
  if (std::abs(std::abs(mean) - 1.) < gravity_band)
    remarks.push_back(name + " has a mean of " + to_four_decimals(mean) +
                      " m/s2, which looks like gravity in g: give the column its unit, as in "
                      "--column 'base_acceleration=ax[g]'");
  if (peak > most_m_s2)
    remarks.push_back(
        name + " reaches " + to_four_decimals(peak) +
        " m/s2, which looks like mm/s2, mg or counts: give the column its unit, as in "
        "--column 'base_acceleration=ax[mg]'");
}

}  // namespace

std::vector<std::string> implausible_magnitudes(const Record& record) {
  constexpr double fastest_wind_m_s = 120., most_moment_n_m = 10.;
  std::vector<std::string> remarks;
  constexpr double slowest_hz = 2., longest_s = 600.;
  if (record.sampling_rate_hz() < slowest_hz && record.duration_s() > longest_s)
    remarks.push_back("the record would last " + to_four_decimals(record.duration_s()) + " s at " +
                      to_four_decimals(record.sampling_rate_hz()) +
                      " Hz, so its time is probably in ms: give the time column its unit, as in "
                      "--column 'time=t[ms]'");
  for (const std::string& name : record.channel_names()) {
    const auto values = record.channel(name);
    if (name.ends_with("_m_s2")) check_acceleration(name, values, remarks);
    const double peak = peak_of(values);
    if (name == channel::wind_speed && peak > fastest_wind_m_s)
      remarks.push_back(name + " reaches " + to_four_decimals(peak) +
                        " m/s: give the column its unit, as in --column 'wind_speed=v[km/h]'");
    if (name.ends_with("_N_m") && peak > most_moment_n_m)
      remarks.push_back(
          name + " reaches " + to_four_decimals(peak) +
          " N m, which looks like a smaller unit or the sensor's raw unit: give the column its "
          "unit, as in --column 'base_moment=M[mN mm]' or 'base_moment=B[uT]*0.18[N m/T]'");
  }
  return remarks;
}

}  // namespace vibrissa::signals
