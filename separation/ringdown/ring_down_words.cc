#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "separation/ringdown/ring_down.h"
#include "signals/base/significant_digits.h"
#include "signals/base/student.h"

namespace vibrissa::separation {

namespace {

using signals::rounded;

std::string with_interval(const Estimate& estimate) {
  const double half = signals::normal_quantile_975 * estimate.standard_deviation;
  const int n =
      half > 0.
          ? std::clamp(1 + static_cast<int>(std::ceil(std::log10(std::abs(estimate.value) / half))),
                       2, 8)
          : 6;
  return rounded(estimate.value, n) + " ± " + rounded(half, 2);
}

std::string at_amplitude(const DecayPoint& point, const std::string& unit) {
  return rounded(point.amplitude_n_m, 3) + " " + unit + ": " + with_interval(point.frequency_hz) +
         " Hz, damping ratio " + with_interval(point.damping_ratio);
}

std::string shares_of(const EquivalentMode& mode) {
  std::string out;
  for (const auto& [name, share] :
       {std::pair("viscous", mode.viscous_share), std::pair("drag", mode.drag_share),
        std::pair("friction", mode.friction_share)})
    if (share >= 0.005)
      out += (out.empty() ? "" : ", ") + std::string(name) + " " + rounded(100. * share, 2) + " %";
  return out;
}

}  // namespace

std::string words_of(const RingDown& found) {
  std::string laws;
  for (const std::string& law : found.damping_laws) laws += (laws.empty() ? "" : " and ") + law;
  std::string out;
  if (found.is_doubtful())
    out = "Doubtful: the law leaves an error of " + rounded(found.error_rms_n_m, 2) + " " +
          found.unit + " (rms), the quietest part of the record has " +
          rounded(found.decays.noise_rms, 2) + " " + found.unit +
          ", and the rows without a law differ from it by " + rounded(found.deviation_of_rows, 2) +
          " of their standard deviations (rms): another mode near by, a base that moves, or a law "
          "that is not tried. The intervals are too narrow; believe the rows without a law. ";
  out += "At the largest amplitude that was fitted, " +
         at_amplitude(found.fitted.front(), found.unit) + "; at the smallest, " +
         at_amplitude(found.fitted.back(), found.unit) + " (95 % intervals). The damping is " +
         laws + " (at the largest amplitude: " + shares_of(found.largest) +
         "; at the smallest: " + shares_of(found.smallest) + ").";
  if (found.fit.parts.cubic)
    out += found.fit.law.cubic > 0. ? " The spring stiffens with the deflection."
                                    : " The spring softens with the deflection.";
  return out;
}

nlohmann::json ring_down_json(const RingDown& found) {
  const auto points = [](const std::vector<DecayPoint>& list) {
    nlohmann::json out = nlohmann::json::array();
    for (const DecayPoint& point : list)
      out.push_back({{"amplitude", point.amplitude_n_m},
                     {"frequency_hz", point.frequency_hz.value},
                     {"frequency_sd_hz", point.frequency_hz.standard_deviation},
                     {"damping_ratio", point.damping_ratio.value},
                     {"damping_sd", point.damping_ratio.standard_deviation}});
    return out;
  };
  nlohmann::json pieces = nlohmann::json::array();
  for (const DecayPiece& piece : found.decays.pieces)
    pieces.push_back({{"first_sample", piece.first}, {"end_sample", piece.end}});
  const DecayLaw& law = found.fit.law;
  return {{"words", found.words},
          {"unit", found.unit},
          {"doubtful", found.is_doubtful()},
          {"error_rms", found.error_rms_n_m},
          {"noise_rms", found.decays.noise_rms},
          {"deviation_of_rows", found.deviation_of_rows},
          {"damping_laws", found.damping_laws},
          {"law",
           {{"frequency_hz", law.frequency_hz},
            {"damping_ratio", law.damping_ratio},
            {"cubic", law.cubic},
            {"drag", law.drag},
            {"slip", law.slip},
            {"stick_ratio", law.stick_ratio}}},
          {"pieces", pieces},
          {"measured", points(found.measured)},
          {"fitted", points(found.fitted)}};
}

}  // namespace vibrissa::separation
