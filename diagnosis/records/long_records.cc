#include "diagnosis/records/experiment.h"

#include <cmath>
#include <sstream>
#include <string>

namespace vibrissa::diagnosis {
namespace {

constexpr std::size_t n_pieces = 4;

// A multiple of the period; a period that is longer than a piece is not divided.
std::size_t whole_periods(const std::size_t n_samples, const std::size_t period) {
  if (period == 0) return n_samples;
  return n_samples < period ? period : n_samples / period * period;
}

void add_pieces(const signals::DatasetRecord& entry, signals::Dataset& out) {
  const signals::Record& record = entry.record;
  const std::size_t length = whole_periods(longest_whole_record / n_pieces, entry.period_samples);
  const std::size_t last = record.n_samples() - length;
  for (std::size_t piece = 0; piece < n_pieces; ++piece) {
    std::size_t first = last * piece / (n_pieces - 1);
    if (entry.period_samples > 0) first = first / entry.period_samples * entry.period_samples;
    std::string name = entry.name;
    name.append(1, '_').append(std::to_string(piece + 1));
    out.records.push_back(
        {.name = std::move(name),
         .record = record.slice(first, length),
         .excitation = entry.excitation,
         .period_samples = entry.period_samples,
         .split = entry.split,
         .readout = entry.readout,
         .setup = entry.setup,
         .clock_start_s = entry.clock_start_s + record.time_s(first) - record.time_s(0),
         .readout_is_given = entry.readout_is_given});
  }
  const double piece_s = static_cast<double>(length) / record.sampling_rate_hz();
  std::ostringstream guess;
  guess << entry.name << ": the record is long; " << n_pieces << " pieces of "
        << std::round(piece_s) << " s, spread over its " << std::round(record.duration_s())
        << " s, are used";
  out.guesses.push_back(guess.str());
}

}  // namespace

signals::Dataset in_pieces(const signals::Dataset& dataset) {
  signals::Dataset out;
  out.guesses = dataset.guesses;
  out.responses = dataset.responses;
  for (const signals::DatasetRecord& entry : dataset.records) {
    if (entry.record.n_samples() <= longest_whole_record)
      out.records.push_back(entry);
    else
      add_pieces(entry, out);
  }
  return out;
}

}  // namespace vibrissa::diagnosis
