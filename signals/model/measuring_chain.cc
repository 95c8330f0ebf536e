#include "signals/model/measuring_chain.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/model/band_limited_simulation.h"

namespace vibrissa::signals {

namespace {

std::span<const double> channel_or_empty(const Record& record, const std::string& name) {
  return record.has(name) ? record.channel(name) : std::span<const double>();
}

class StructureLink : public Link {
 public:
  explicit StructureLink(ReducedModel model) : model_(std::move(model)) { check(model_); }

  LinkPlace place() const override { return LinkPlace::structure; }
  std::string name() const override { return "reduced model '" + model_.name + "'"; }

  void pass(Record& record, std::mt19937_64&) const override {
    const ReducedInput input{
        .sampling_rate_hz = record.sampling_rate_hz(),
        .n_samples = record.n_samples(),
        .base_acceleration = channel_or_empty(record, channel::base_acceleration),
        .cross_acceleration = channel_or_empty(record, channel::cross_acceleration),
        .wind_speed = channel_or_empty(record, channel::wind_speed)};
    if (input.base_acceleration.empty() && input.cross_acceleration.empty() &&
        input.wind_speed.empty())
      throw UserError(name() + ": the record has no input that moves the sensor; it needs " +
                      channel::base_acceleration + ", " + channel::cross_acceleration + " or " +
                      channel::wind_speed);
    ReducedOutput output = simulate_band_limited(model_, input);
    const bool has_cross = !input.cross_acceleration.empty();
    record.set_channel(channel::base_moment, std::move(output.base_moment));
    if (has_cross) record.set_channel(channel::cross_moment, std::move(output.cross_moment));
  }

 private:
  ReducedModel model_;
};

/// White Gaussian noise on some channels, one after the other from one stream.
class NoiseLink : public Link {
 public:
  NoiseLink(LinkPlace place, std::string name, std::vector<std::string> channels,
            double standard_deviation)
      : place_(place),
        name_(std::move(name)),
        channels_(std::move(channels)),
        standard_deviation_(standard_deviation) {
    if (!(standard_deviation >= 0.) || !std::isfinite(standard_deviation))
      throw UserError(name_ + ": standard deviation " + to_text(standard_deviation) +
                      " is negative or not finite");
  }

  LinkPlace place() const override { return place_; }
  std::string name() const override { return name_; }

  void pass(Record& record, std::mt19937_64& random) const override {
    std::normal_distribution<double> standard_normal;
    for (const std::string& channel : channels_) {
      if (!record.has(channel)) continue;
      const auto clean = record.channel(channel);
      std::vector<double> noisy(clean.begin(), clean.end());
      for (double& x : noisy) x += standard_deviation_ * standard_normal(random);
      record.set_channel(channel, std::move(noisy));
    }
  }

 private:
  LinkPlace place_;
  std::string name_;
  std::vector<std::string> channels_;
  double standard_deviation_;
};

std::mt19937_64 make_stream(std::uint64_t seed, LinkPlace place, std::uint32_t index) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(place), index};
  return std::mt19937_64(sequence);
}

}  // namespace

std::string to_string(LinkPlace place) {
  switch (place) {
    case LinkPlace::mount:
      return "mount";
    case LinkPlace::wind:
      return "wind";
    case LinkPlace::structure:
      return "structure";
    case LinkPlace::sensor:
      return "sensor";
    case LinkPlace::reference:
      return "reference";
    case LinkPlace::clock:
      return "clock";
  }
  assert(false);
  return "unknown";
}

std::unique_ptr<Link> make_structure_link(ReducedModel model) {
  return std::make_unique<StructureLink>(std::move(model));
}

std::unique_ptr<Link> make_sensor_noise(double standard_deviation_n_m) {
  return std::make_unique<NoiseLink>(
      LinkPlace::sensor, "sensor noise",
      std::vector<std::string>{channel::base_moment, channel::cross_moment},
      standard_deviation_n_m);
}

std::unique_ptr<Link> make_reference_noise(double standard_deviation_m_s2) {
  return std::make_unique<NoiseLink>(
      LinkPlace::reference, "reference noise",
      std::vector<std::string>{channel::base_acceleration, channel::cross_acceleration},
      standard_deviation_m_s2);
}

void MeasuringChain::add(std::unique_ptr<Link> link) {
  assert(link);
  const auto behind = std::ranges::upper_bound(links_, link->place(), std::less(),
                                               [](const auto& other) { return other->place(); });
  links_.insert(behind, std::move(link));
}

Record MeasuringChain::measure(Record truth, std::uint64_t seed) const {
  std::map<LinkPlace, std::uint32_t> n_passed;
  for (const auto& link : links_) {
    std::mt19937_64 random = make_stream(seed, link->place(), n_passed[link->place()]++);
    link->pass(truth, random);
  }
  return truth;
}

}  // namespace vibrissa::signals
