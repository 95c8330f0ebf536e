#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "signals/model/reduced_model.h"
#include "signals/record/record.h"

namespace vibrissa::signals {

/// Link of the measuring chain: reference -> mount -> structure <- wind; structure -> sensor ->
/// clock. Signals pass mount, wind, structure, sensor, reference, clock in this order.
enum class Link { mount, wind, structure, sensor, reference, clock };
std::string to_string(Link link);

/// What acts at one link of the measuring chain. Its input is the record with the true motion, wind
/// and (after the structure) moment; its output is the record after it. An effect is an element
/// other than the identity.
class ChainElement {
 public:
  virtual ~ChainElement() = default;
  virtual Link link() const = 0;
  virtual std::string name() const = 0;
  virtual void pass(Record& record, std::mt19937_64& random) const = 0;
};

/// The structure: the reduced model adds base_moment (and cross_moment when there is a cross
/// acceleration). Inputs are the base acceleration, cross acceleration and wind speed of the
/// record, band-limited between their samples (band_limited_simulation.h). pass() throws UserError
/// when the record has none of them, or has wind and the model has no wind load.
std::unique_ptr<ChainElement> make_structure_element(ReducedModel model);
/// White Gaussian noise on the sensor's moment (and cross moment) [N m] (5.43 uT = 1e-6 N m).
/// Throws UserError when the standard deviation is negative or not finite.
std::unique_ptr<ChainElement> make_sensor_noise(double standard_deviation_n_m);
/// White Gaussian noise on the measured base (and cross) acceleration [m/s^2] (0.008 g = 0.0785
/// m/s^2). Throws as make_sensor_noise.
std::unique_ptr<ChainElement> make_reference_noise(double standard_deviation_m_s2);

/// The measuring chain. Each link has any number of elements, applied in the order in which they
/// were added; no element means the identity. Proven by
/// tests/signals/model/measuring_chain_test.cc.
class MeasuringChain {
 public:
  void add(std::unique_ptr<ChainElement> element);
  /// The record that the rig writes for this true motion and wind. Equal seeds give equal records
  /// (with the same standard library, because std::normal_distribution differs between libraries).
  /// Each element has its own random stream, so that an added element does not change the others.
  Record measure(Record truth, std::uint64_t seed) const;

 private:
  std::vector<std::unique_ptr<ChainElement>> elements_;
};

}  // namespace vibrissa::signals
