#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace vibrissa::signals {

/// Can the base move? A clamped stage stands still while its coil may be driven.
enum class Stage { free, clamped };

/// What was changed on the bench for one record (docs/records.md); the defaults are the sensor as
/// it is.
struct BenchSetup {
  double added_mass_kg = 0., added_mass_height_m = 0.;  // above the base
  double tilt_deg = 0.;                                 // of the sensor's axis, from the vertical
  double rotation_deg = 0.;  // of the sensor about its own axis; the accelerometer stays
  Stage stage = Stage::free;
  bool coil_driven = true;
  bool magnet = true;
  bool operator==(const BenchSetup&) const = default;
};

/// What differs from the defaults, in words; empty when nothing does.
std::string to_string(const BenchSetup& setup);

/// where: the file and the place in it, for messages. Throws UserError for an unknown entry (lists
/// the known ones), a wrong kind, a negative mass or height. Proven by
/// tests/signals/files/dataset_test.cc.
BenchSetup read_bench_setup(const nlohmann::json& entry, const std::string& where);

}  // namespace vibrissa::signals
