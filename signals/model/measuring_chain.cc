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

class StructureElement : public ChainElement {
 public:
  explicit StructureElement(ReducedModel model) : model_(std::move(model)) { check(model_); }

  Link link() const override { return Link::structure; }
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
class NoiseElement : public ChainElement {
 public:
  NoiseElement(Link link, std::string name, std::vector<std::string> channels,
               double standard_deviation)
      : link_(link),
        name_(std::move(name)),
        channels_(std::move(channels)),
        standard_deviation_(standard_deviation) {
    if (!(standard_deviation >= 0.) || !std::isfinite(standard_deviation))
      throw UserError(name_ + ": standard deviation " + to_text(standard_deviation) +
                      " is negative or not finite");
  }

  Link link() const override { return link_; }
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
  Link link_;
  std::string name_;
  std::vector<std::string> channels_;
  double standard_deviation_;
};

std::mt19937_64 make_stream(std::uint64_t seed, Link link, std::uint32_t index) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(link), index};
  return std::mt19937_64(sequence);
}

}  // namespace

std::string to_string(const Link link) {
  switch (link) {
    case Link::mount:
      return "mount";
    case Link::wind:
      return "wind";
    case Link::structure:
      return "structure";
    case Link::sensor:
      return "sensor";
    case Link::reference:
      return "reference";
    case Link::clock:
      return "clock";
  }
  assert(false);
  return "unknown";
}

std::unique_ptr<ChainElement> make_structure_element(ReducedModel model) {
  return std::make_unique<StructureElement>(std::move(model));
}

std::unique_ptr<ChainElement> make_sensor_noise(double standard_deviation_n_m) {
  return std::make_unique<NoiseElement>(
      Link::sensor, "sensor noise",
      std::vector<std::string>{channel::base_moment, channel::cross_moment},
      standard_deviation_n_m);
}

std::unique_ptr<ChainElement> make_reference_noise(double standard_deviation_m_s2) {
  return std::make_unique<NoiseElement>(
      Link::reference, "reference noise",
      std::vector<std::string>{channel::base_acceleration, channel::cross_acceleration},
      standard_deviation_m_s2);
}

void MeasuringChain::add(std::unique_ptr<ChainElement> element) {
  assert(element);
  const auto behind = std::ranges::upper_bound(elements_, element->link(), std::less(),
                                               [](const auto& other) { return other->link(); });
  elements_.insert(behind, std::move(element));
}

Record MeasuringChain::measure(Record truth, std::uint64_t seed) const {
  std::map<Link, std::uint32_t> n_passed;
  for (const auto& element : elements_) {
    std::mt19937_64 random = make_stream(seed, element->link(), n_passed[element->link()]++);
    element->pass(truth, random);
  }
  return truth;
}

}  // namespace vibrissa::signals
