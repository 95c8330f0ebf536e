#include "signals/files/record_stream.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/files/file_format.h"
#include "signals/files/record_rows.h"

namespace vibrissa::signals {
namespace {

constexpr std::size_t block_samples = std::size_t{1} << 14;

}  // namespace

RecordStream::RecordStream(const std::filesystem::path& file, const ReadOptions& options)
    : file_(file), options_(options), table_(formats::open_table(file, options.text)) {
  if (!options.remove_mean.empty())
    throw UserError(
        "--remove-mean needs the whole record, but a stream reads one block after the other; leave "
        "the option out");
  if (options.resample_hz)
    throw UserError("--resample needs the whole record; leave out the option of the stream");
  check(options);
  sources_ = find_sources(*table_, options_);
  if (sources_.time_is_beside_rate) sources_.time.reset();
  n_rows_ = number_of_rows(*table_, options_);
  find_axis();
}

Record RecordStream::read(const std::size_t first, const std::size_t count) const {
  ReadOptions part = options_;
  part.first_row = options_.first_row + first;
  std::optional<Clock> clock;
  if (is_from_all_stamps_) {
    clock.emplace();
    clock->sampling_rate_hz = axis_.sampling_rate_hz;
    clock->pieces = {{0, count, axis_.start_s + double(first) / axis_.sampling_rate_hz}};
  }
  return std::move(read_rows(*table_, file_.string(), sources_, part, count, clock).front());
}

// The rate of the first block, unless the time of the last sample contradicts it. Stamps that
// jitter need a regression over all.
void RecordStream::find_axis() {
  ReadOptions options = options_;
  options.gaps = Gaps::refuse;
  const std::size_t few = std::min(block_samples, n_rows_);
  const Clock first = read_clock(*table_, file_.string(), sources_, options, few);
  axis_ = {first.pieces.front().start_s, first.sampling_rate_hz};
  if (!sources_.time || few == n_rows_) {
    is_from_all_stamps_ = first.rate_error_hz > 0.;
    return;
  }
  if (first.rate_error_hz > 0.) {
    const Clock all = read_clock(*table_, file_.string(), sources_, options, n_rows_);
    axis_ = {all.pieces.front().start_s, all.sampling_rate_hz};
    is_from_all_stamps_ = true;
    return;
  }
  const std::size_t n_last = std::min<std::size_t>(n_rows_, 64);
  const Record last = read(n_rows_ - n_last, n_last);
  const double span_s = last.time_s(n_last - 1) - axis_.start_s;
  const double off_samples = std::abs(span_s * axis_.sampling_rate_hz - double(n_rows_ - 1));
  constexpr double allowed_samples = 0.1;
  if (off_samples >= allowed_samples)
    axis_.sampling_rate_hz = static_cast<double>(n_rows_ - 1) / span_s;
}

void RecordStream::check_joins(const Record& block, const std::size_t first) const {
  if (!sources_.time || is_from_all_stamps_) return;
  const double expected_s = axis_.start_s + static_cast<double>(first) / axis_.sampling_rate_hz;
  constexpr double allowed_samples = 0.45;
  if (std::abs(block.time_s(0) - expected_s) * axis_.sampling_rate_hz <= allowed_samples) return;
  throw UserError(table_->place(options_.first_row + first) + "time jumps to " +
                  to_text(block.time_s(0)) + " s, but " + to_text(expected_s) +
                  " s was expected; samples are never added or removed");
}

std::optional<Record> RecordStream::next() {
  if (n_read_ == n_rows_) return std::nullopt;
  std::size_t count = std::min(block_samples, n_rows_ - n_read_);
  // A last block that is too short to determine its rate is joined to the previous block.
  if (n_rows_ - n_read_ - count < least_samples) count = n_rows_ - n_read_;
  Record block = read(n_read_, count);
  check_joins(block, n_read_);
  n_read_ += count;
  return block;
}

}  // namespace vibrissa::signals
