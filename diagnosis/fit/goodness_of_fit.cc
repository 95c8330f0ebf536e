#include "diagnosis/fit/goodness_of_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "diagnosis/records/frequency_block.h"

namespace vibrissa::diagnosis {
namespace {

struct Block {
  double power = 0., count = 0., own_share = 0.;
  bool holds_own_noise() const { return own_share >= least_own_share * count; }
  double gain() const {
    constexpr double fewest = 10.;
    if (count < fewest) return 0.;
    // Less power than predicted is no failure, because model form errors are often smaller than
    // their bounds.
    const double mean = std::max(1., power / count);
    return std::max(0., count * (mean - 1. - std::log(mean)) - 0.5 * std::log(count));
  }
};

int kind_of(const PreparedRecord& record) {
  return (record.excitation.base ? 1 : 0) + (record.excitation.wind ? 2 : 0);
}

// The lowest bins contain drift, which is no tone.
double loudest_tone(const Experiment& experiment, const std::span<const WhitenedRecord> records) {
  double loudest = 0., count = 0.;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const signals::Excitation& excitation = experiment.records[r].excitation;
    if (excitation.base || excitation.wind) continue;
    constexpr std::size_t first = 8;
    for (std::size_t b = first; b < records[r].error.size(); ++b) {
      loudest = std::max(loudest, std::norm(records[r].error[b]));
      count += 1.;
    }
  }
  return count == 0. ? 0. : loudest - std::log(count);
}

}  // namespace

GoodnessOfFit goodness_of_fit(const Experiment& experiment,
                              const std::span<const WhitenedRecord> records) {
  std::map<std::pair<int, std::size_t>, Block> blocks;
  for (std::size_t r = 0; r < records.size(); ++r)
    for (std::size_t b = 0; b < records[r].error.size(); ++b) {
      const PreparedRecord& record = experiment.records[r];
      Block& block = blocks[{kind_of(record), frequency_block(experiment, record, b)}];
      block.power += std::norm(records[r].error[b]);
      block.count += 1.;
      block.own_share += records[r].own_share[b];
    }
  GoodnessOfFit out;
  double power = 0., count = 0.;
  for (const auto& [index, block] : blocks) {
    power += block.power;
    count += block.count;
    if (block.holds_own_noise()) out.misshape_nats += block.gain();
    out.surplus_nats_per_bin += block.gain();
  }
  if (count == 0.) return out;
  out.tone_nats = loudest_tone(experiment, records);
  out.predicted = predicted_noise(experiment, records);
  out.excess = power / count - 1.;
  out.surplus_nats_per_bin /= count;
  return out;
}

}  // namespace vibrissa::diagnosis
