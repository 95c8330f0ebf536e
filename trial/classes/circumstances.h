#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace vibrissa::trial {

/// Which records of a sensor exist.
enum class RecordSet {
  complete,         // at rest, two levels, wind, both together, held-out records
  base_only,        // no fan and no probe
  two_files,        // one file of a simulation, one of a bench: 20 s of random vibration
  no_rest,          // complete without the record at rest
  one_level,        // all base motion has one level
  no_wind_channel,  // complete, but nobody measured the wind
  ten_times_noise   // complete, with ten times the noise of the moment sensor
};

/// How far the sensor is from its simulation in modulus, damping, gains and drag.
enum class Distance {
  exact,
  as_built,  // a few percent
  as_paper   // as far as the reference paper's sensor
};

/// Relative rms error of the simulated moment that no value of the simulation's parameters removes.
enum class FormError { zero, one_percent, three_percent };

/// How the simulation is given: as records, or as a case file (.prm) that is solved.
enum class WayIn { records, model };

/// What a sensor of a trial comes with beside its effects. The default: complete records and an
/// exact simulation.
struct Circumstances {
  RecordSet set = RecordSet::complete;
  Distance distance = Distance::exact;
  FormError form_error = FormError::zero;
  WayIn way_in = WayIn::records;
  bool operator==(const Circumstances&) const = default;
};

/// Name in labels, options and scores, e.g. "base_only".
std::string to_string(RecordSet set);
std::string to_string(Distance distance);
std::string to_string(FormError error);
std::string to_string(WayIn way);

/// All values, in the order of their declaration.
const std::vector<RecordSet>& record_sets();
const std::vector<Distance>& distances();
const std::vector<FormError>& form_errors();

/// 0, 0.01 or 0.03.
double size_of(FormError error);
/// What the maker of such a simulation says of its accuracy: 3 % where it is known to be rough,
/// otherwise the usual 1 % (the default of --simulation-accuracy).
double stated_accuracy(FormError error);

/// {"set": "base_only", "distance": "exact", "form_error": "0 %", "way_in": "records"}.
nlohmann::json to_json(const Circumstances& circumstances);
/// Throws UserError that lists the known names, or names the missing entry. Proven by
/// tests/trial/classes/circumstances_test.cc.
Circumstances circumstances_from(const nlohmann::json& document);

/// Least share of the reducible gap that an effect closes whose name belongs to the verdict; an
/// effect that closes less belongs to a note, so it is right with or without it.
inline constexpr double least_gap_share = 0.05;

/// Can unknown calibrations imitate this effect exactly? On sensors at a distance such effects have
/// no meaning of their own.
bool is_a_calibration(const std::string& id);

}  // namespace vibrissa::trial
