#include "signals/files/several_rates.h"

#include <algorithm>
#include <exception>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/files/joined_recording.h"
#include "signals/files/one_rate_table.h"
#include "signals/files/record_sources.h"
#include "signals/record/channel_name.h"

namespace vibrissa::signals {
namespace {

void check_options(const ReadOptions& options, const std::string& name) {
  if (options.sampling_rate_hz)
    throw UserError(name + ": states a rate for each channel; leave --rate out");
  if (options.first_row != 1 || options.n_rows)
    throw UserError(
        name +
        ": its channels have several rates, so a row is not one time; leave --rows out, "
        "or choose rows of what 'vibrissa convert' writes");
}

bool is_read(const ColumnChoice& choice, const std::vector<Recording>& recordings) {
  return choice.channel == time_channel ||
         std::ranges::any_of(recordings, [&](const Recording& recording) {
           return recording.pieces.front().has(choice.channel);
         });
}

void check_all_are_read(const formats::RecordTable& table, const ReadOptions& options,
                        const std::vector<Recording>& recordings,
                        const std::exception_ptr& failure) {
  for (const ColumnChoice& choice : options.columns) {
    if (is_read(choice, recordings)) continue;
    // A column may have its unit behind the name.
    const bool is_there = std::ranges::any_of(
        table.columns(), [&](const std::string& name) { return name.starts_with(choice.column); });
    if (failure && is_there) std::rethrow_exception(failure);
    throw UserError(table.place(0) + unknown_name("column", choice.column, table.columns()));
  }
  if (failure && recordings.empty()) std::rethrow_exception(failure);
}

}  // namespace

Recording read_several_rates(const formats::RecordTable& table, const std::string& name,
                             const ReadOptions& options) {
  check_options(options, name);
  ReadOptions of_each = options;
  of_each.skips_missing_columns = true;
  std::vector<Recording> recordings;
  std::exception_ptr failure;
  std::string rates;
  for (const formats::RateGroup& group : table.rate_groups()) {
    OneRateTable one_rate(table, group);
    try {
      find_sources(one_rate, of_each);
    } catch (const UserError&) {
      failure = std::current_exception();
      continue;
    }
    recordings.push_back(read_recording(one_rate, name, of_each));
    rates += (rates.empty() ? "" : ", ") + to_text(group.clock.sampling_rate_hz);
  }
  check_all_are_read(table, options, recordings, failure);
  Recording all = recordings.front();
  std::string words = table.layout_text() + "; " + all.words;
  for (std::size_t i = 1; i < recordings.size(); ++i) {
    all = joined(all, recordings[i]);
    words += "; " + recordings[i].words;
  }
  if (recordings.size() > 1)
    words += "; channels at " + rates + " Hz " + all.words +
             " (for the full rate of some, choose these by --column)";
  all.words = words;
  return all;
}

}  // namespace vibrissa::signals
