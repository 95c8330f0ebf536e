#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace vibrissa::signals {

/// Whether the base can move. A clamped stage does not move, even when its coil is driven.
enum class Stage { free, clamped };

/// Changes on the bench for one record (docs/records.md); the defaults mean no change.
struct BenchSetup {
  double added_mass_kg = 0., added_mass_height_m = 0.;  // above the base
  double tilt_deg = 0.;  // angle between the sensor's axis and the vertical
  double rotation_deg =
      0.;  // rotation of the sensor about its own axis; the accelerometer is not rotated
  Stage stage = Stage::free;
  bool coil_driven = true;
  bool magnet = true;
  bool operator==(const BenchSetup&) const = default;
};

/// Text of the differences from the defaults; empty when there are none.
std::string to_string(const BenchSetup& setup);

/// Reads the setup of a record; `where` is the file and the place in it, for messages. Throws
/// UserError for an unknown entry (lists the known ones), a wrong type, a negative mass or height.
/// Proven by tests/signals/files/dataset_test.cc.
BenchSetup read_bench_setup(const nlohmann::json& entry, const std::string& where);

}  // namespace vibrissa::signals
