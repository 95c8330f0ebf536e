#include "trial/generator/circumstance_draw.h"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace vibrissa::trial {
namespace {

/// The value for this number from a deck that is shuffled anew for each block.
template <class Value>
Value dealt(std::vector<Value> deck, const std::uint64_t seed, const std::size_t number,
            const std::uint32_t purpose) {
  std::mt19937_64 random(stream_seed(seed, number / deck.size(), purpose));
  std::shuffle(deck.begin(), deck.end(), random);
  return deck[number % deck.size()];
}

}  // namespace

std::uint64_t stream_seed(const std::uint64_t seed, const std::size_t number,
                          const std::uint32_t purpose) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(number), purpose};
  std::array<std::uint32_t, 2> words{};
  sequence.generate(words.begin(), words.end());
  return (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
}

Circumstances draw_circumstances(const std::uint64_t seed, const std::size_t number,
                                 const CaseClass kind) {
  enum : std::uint32_t { of_set = 1, of_distance, of_form, of_way };
  Circumstances out{.set = dealt(record_sets(), seed, number, of_set),
                    .distance = dealt(distances(), seed, number, of_distance),
                    .form_error = dealt(form_errors(), seed, number, of_form)};
  if (kind == CaseClass::calibration_only && out.distance == Distance::exact)
    out.distance = Distance::as_built;
  if (kind == CaseClass::wrong_metadata && out.set == RecordSet::two_files)
    out.set = RecordSet::complete;
  if (out.form_error == FormError::zero && out.set != RecordSet::two_files)
    out.way_in = dealt(std::vector{WayIn::records, WayIn::model}, seed, number, of_way);
  return out;
}

}  // namespace vibrissa::trial
