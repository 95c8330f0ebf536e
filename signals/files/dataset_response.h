#pragma once

#include <complex>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "signals/record/bench_setup.h"
#include "signals/record/split.h"

namespace vibrissa::signals {

/// What responds. rotation is that of the joint, deflection that of a point of the sensor.
enum class ResponseQuantity { moment, rotation, deflection, velocity, acceleration };
/// SI unit of the quantity: "N m", "rad", "m", "m/s", "m/s2".
std::string unit_of(ResponseQuantity quantity);
/// moment, rotation, ...
std::string to_string(ResponseQuantity quantity);

/// Direction of a stepped or swept sine.
enum class SweepDirection { up, down };
std::string to_string(SweepDirection direction);

/// Steady response to a sine of the base whose level is held, line by line: the fundamental of the
/// response [SI unit] relative to the phase of the base acceleration, exp(+j w t).
struct DatasetResponse {
  std::string name{};
  std::vector<double> frequency_hz{};  // rising
  std::vector<std::complex<double>> value{};
  std::vector<double> standard_deviation{};  // E|error|^2 = sd^2
  std::vector<double> level_m_s2{};          // amplitude of the base acceleration at each line
  SweepDirection direction = SweepDirection::up;
  ResponseQuantity quantity = ResponseQuantity::moment;
  bool phase_offset_is_known = true;
  std::size_t repeat = 0;  // number of a measurement that was made several times
  Split split = Split::fit;
  BenchSetup setup{};
};

/// Is the entry of dataset.json of the kind response? Throws UserError for an unknown kind.
bool is_response(const nlohmann::json& entry, const std::string& where);

/// Reads an entry of the kind response (docs/records.md). The noise is the column
/// standard_deviation, else that of coherence and "averages", else that of neighbouring lines.
/// Throws UserError with file and entry for: a level that is missing, not positive, not an
/// acceleration or not known at each line; a conjugated phase (it rises through the resonance),
/// unless "phase" says that it is; negative magnitudes; lines out of order or of both directions;
/// unknown words; fewer lines than fewest_response_lines. Proven by
/// tests/signals/files/dataset_response_test.cc.
DatasetResponse read_dataset_response(const std::filesystem::path& folder,
                                      const nlohmann::json& document, const nlohmann::json& entry,
                                      const std::string& where);

/// Throws UserError where two fit responses of the same quantity and setup have the same level and
/// direction, unless their entries number them as repeats.
void refuse_doubled_levels(const std::vector<DatasetResponse>& responses, const std::string& where);

/// Takes the noise of repeated responses from their differences.
void use_repeats(std::vector<DatasetResponse>& responses);

}  // namespace vibrissa::signals
