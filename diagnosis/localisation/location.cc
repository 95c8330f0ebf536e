#include "diagnosis/localisation/location.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "diagnosis/model/words.h"

namespace vibrissa::diagnosis {

Location locate_gap(const Experiment& experiment) {
  Location out;
  const RestNoise rest = rest_noise(experiment);
  std::vector<RecordGap> gaps;
  for (const PreparedRecord& record : experiment.records)
    if (kind_of(record) != "rest") gaps.push_back(gap_of(experiment, record, rest));
  set_map(experiment, gaps, rest, out);
  set_properties(gaps, rest, out);
  out.present_at_rest = rest.coloured;
  out.p_value = rest.p_value;
  for (const ChannelGap& channel : out.map) out.p_value = std::min(out.p_value, channel.p_value);
  out.p_value = std::min(1., 2. * out.p_value);  // two kinds of tests: bands, and presence at rest
  return out;
}

std::vector<std::string> likely_links(const SearchResult& result) {
  constexpr double least = 0.1;
  if (result.candidates.front().name == "none") return {};
  std::map<std::string, double> sums;
  for (const Candidate& candidate : result.candidates) {
    std::set<std::string> links;
    for (const std::string& id : effect_ids(candidate.name))
      if (const Effect* effect = effect_or_none(id)) links.insert(to_string(effect->link));
    for (const std::string& link : links) sums[link] += candidate.probability;
  }
  std::vector<std::string> links;
  for (const auto& [link, sum] : sums)
    if (sum > least) links.push_back(link);
  std::ranges::stable_sort(links, std::ranges::greater(),
                           [&](const std::string& link) { return sums[link]; });
  return links;
}

std::string location_sentence(const Location& location) {
  if (location.channels.empty()) return "No gap larger than noise.";
  std::ostringstream text;
  text.precision(3);
  text << "The gap appears ";
  std::vector<std::string> when;
  for (const std::string& channel : location.channels)
    when.push_back(channel == "rest"      ? "at rest"
                   : channel == "product" ? "only with base motion and wind together"
                   : channel == "base"    ? "in records with base motion"
                                          : "in records with " + channel);
  text << joined(when, " and ");
  if (!location.bands_hz.empty())
    text << ", at " << location.bands_hz.front()[0] << " to " << location.bands_hz.back()[1]
         << " Hz";
  if (location.mode) text << ", strongest near mode " << *location.mode;
  if (location.level_exponent && location.level_exponent->value != 0.)
    text << "; with twice the excitation the error's share of the moment is "
         << std::exp2(location.level_exponent->value) << " times as large";
  if (location.harmonics != Harmonics::none)
    text << "; it has "
         << (location.harmonics == Harmonics::both ? "odd and even" : to_string(location.harmonics))
         << " harmonics of the excitation";
  if (location.varies_in_time) text << "; it changes over time";
  text << ".";
  return text.str();
}

}  // namespace vibrissa::diagnosis
