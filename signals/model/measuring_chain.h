#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "signals/model/reduced_model.h"
#include "signals/record/record.h"

namespace vibrissa::signals {

/// Where in the chain a link stands: reference -> mount -> structure <- wind; structure -> sensor
/// -> clock. Signals pass mount, wind, structure, sensor, reference, clock in this order.
enum class LinkPlace { mount, wind, structure, sensor, reference, clock };
std::string to_string(LinkPlace place);

/// One link of the measuring chain: turns the record that holds the true motion, wind and (after
/// the structure) moment into the one behind the link. An effect is a link other than the identity.
class Link {
 public:
  virtual ~Link() = default;
  virtual LinkPlace place() const = 0;
  virtual std::string name() const = 0;
  virtual void pass(Record& record, std::mt19937_64& random) const = 0;
};

/// The structure: adds base_moment (and cross_moment when there is a cross acceleration) from those
/// of base acceleration, cross acceleration and wind speed that the record has, by the reduced
/// model, with inputs that are band-limited between their samples (band_limited_simulation.h).
/// pass() throws UserError when it has none of them, or wind for a model without wind load.
std::unique_ptr<Link> make_structure_link(ReducedModel model);
/// White Gaussian noise on the sensor's moment (and cross moment) [N m] (settled: 5.43 uT = 1e-6 N
/// m). Throws UserError when the standard deviation is negative or not finite; so does the next.
std::unique_ptr<Link> make_sensor_noise(double standard_deviation_n_m);
/// White Gaussian noise on the measured base (and cross) acceleration [m/s^2] (0.008 g = 0.0785).
std::unique_ptr<Link> make_reference_noise(double standard_deviation_m_s2);

/// The measuring chain: each place holds any number of links, passed in the order of their adding;
/// none means the identity. Proven by tests/signals/model/measuring_chain_test.cc.
class MeasuringChain {
 public:
  void add(std::unique_ptr<Link> link);
  /// The record that the rig would have written for this true motion and wind. Same seed, same
  /// record (within one standard library: std::normal_distribution is not the same in all); each
  /// link has a random stream of its own, so that adding one does not change another's.
  Record measure(Record truth, std::uint64_t seed) const;

 private:
  std::vector<std::unique_ptr<Link>> links_;
};

}  // namespace vibrissa::signals
