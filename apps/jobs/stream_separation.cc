#include "apps/jobs/stream_separation.h"

#include <algorithm>

#include "signals/formats/csv_record.h"
#include "signals/system/output_file.h"
#include "signals/system/progress.h"

namespace vibrissa::apps {
namespace {

using signals::Record;

/// The wind moments of one method that have come out and are not written yet, the first one that of
/// the oldest sample not written.
class Outcome {
 public:
  explicit Outcome(NamedSeparator& method)
      : method_(method), n_early_(method.separator->latency_samples()) {
    method_.separator->reset();
  }

  void process(const std::span<const double> acceleration, const std::span<const double> moment) {
    std::vector<double> wind(moment.size());
    method_.separator->process(acceleration, moment, wind);
    const std::size_t n_skipped = std::min(n_early_, wind.size());
    n_early_ -= n_skipped;
    due_.insert(due_.end(), wind.begin() + static_cast<std::ptrdiff_t>(n_skipped), wind.end());
  }

  // The record goes on as it ended until its last samples have come out.
  void finish(const double acceleration, const double moment) {
    const std::size_t latency = method_.separator->latency_samples();
    process(std::vector<double>(latency, acceleration), std::vector<double>(latency, moment));
  }

  std::size_t n_due() const { return due_.size(); }
  std::string channel() const { return "wind_moment_" + method_.name + "_N_m"; }
  std::vector<double> take(const std::size_t count) {
    const auto end = due_.begin() + static_cast<std::ptrdiff_t>(count);
    std::vector<double> taken(due_.begin(), end);
    due_.erase(due_.begin(), end);
    return taken;
  }

 private:
  NamedSeparator& method_;
  std::size_t n_early_;
  std::vector<double> due_;
};

Record joined(const std::optional<Record>& first, const Record& second) {
  if (!first) return second;
  Record all(second.sampling_rate_hz(), first->n_samples() + second.n_samples(), first->time_s(0));
  for (const std::string& name : second.channel_names()) {
    const auto before = first->channel(name), after = second.channel(name);
    std::vector<double> values(before.begin(), before.end());
    values.insert(values.end(), after.begin(), after.end());
    all.set_channel(name, std::move(values));
  }
  return all;
}

/// Blocks on their way through the separators to the file.
class Stream {
 public:
  Stream(std::vector<NamedSeparator>& methods, const signals::TimeAxis& axis, std::ostream& out)
      : outcomes_(methods.begin(), methods.end()), axis_(axis), out_(out) {}

  void take(const Record& block) {
    const auto acceleration = block.channel(signals::channel::base_acceleration);
    const auto moment = block.channel(signals::channel::base_moment);
    for (Outcome& outcome : outcomes_) outcome.process(acceleration, moment);
    waiting_ = joined(waiting_, block);
    write_what_is_due();
  }

  void finish(const double last_acceleration, const double last_moment) {
    for (Outcome& outcome : outcomes_) outcome.finish(last_acceleration, last_moment);
    write_what_is_due();
  }

 private:
  void write_what_is_due() {
    if (!waiting_) return;
    std::size_t n = waiting_->n_samples();
    for (const Outcome& outcome : outcomes_) n = std::min(n, outcome.n_due());
    if (n == 0) return;
    Record ready = waiting_->slice(0, n);
    for (Outcome& outcome : outcomes_) ready.set_channel(outcome.channel(), outcome.take(n));
    if (n_written_ == 0) signals::formats::write_csv_header(out_, ready);
    signals::formats::write_csv_rows(out_, ready, axis_, n_written_);
    n_written_ += n;
    const std::size_t n_left = waiting_->n_samples() - n;
    waiting_ = n_left == 0 ? std::nullopt : std::optional(waiting_->slice(n, n_left));
  }

  std::vector<Outcome> outcomes_;
  signals::TimeAxis axis_;
  std::ostream& out_;
  std::optional<Record> waiting_;  // samples whose wind moments are not all there
  std::size_t n_written_ = 0;
};

}  // namespace

void separate_stream(signals::RecordStream& record, std::vector<NamedSeparator>& methods,
                     const std::filesystem::path& output, const bool show_progress) {
  signals::Progress progress("separating", record.n_samples(), show_progress);
  signals::write_file(output, [&](std::ostream& out) {
    Stream stream(methods, {record.start_s(), record.sampling_rate_hz()}, out);
    double last_acceleration = 0., last_moment = 0.;
    while (const auto block = record.next()) {
      stream.take(*block);
      last_acceleration = block->channel(signals::channel::base_acceleration).back();
      last_moment = block->channel(signals::channel::base_moment).back();
      progress.advance(block->n_samples());
    }
    stream.finish(last_acceleration, last_moment);
  });
}

}  // namespace vibrissa::apps
