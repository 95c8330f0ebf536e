#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "case/recorded_input.h"
#include "case/transient_parameters.h"
#include "fem/sensor/sensor.h"
#include "separation/filters/fdaf.h"
#include "signals/excitation/multisine.h"

namespace dealii {
class ParameterHandler;
}

namespace vibrissa::sensor_case {

enum class BaseMotionKind { none, multisine, recorded };

/// Subsection "Base motion": acceleration of the base along the axial direction.
struct BaseMotion {
  BaseMotionKind kind = BaseMotionKind::multisine;
  std::vector<double> line_frequency_hz;  // lines of the multisine
  double peak_m_s2 = 0.;
  signals::MultisinePhase phase = signals::MultisinePhase::schroeder;
  RecordedInput recorded;
};

/// Subsection "Records": sampling, noise, seed.
struct RecordParameters {
  double sampling_rate_hz = 500.;
  double duration_s = 20.;
  std::uint64_t seed = 1;
  double accelerometer_noise_m_s2 = 0.;
  double moment_noise_n_m = 0.;
  std::size_t n_samples() const;
};

/// Subsection "Separation".
struct SeparationParameters {
  unsigned int largest_order = 6;
  separation::FdafOptions fdaf;
  double settling_s = 2.;
};

/// Subsection "Output".
struct OutputParameters {
  std::optional<std::string> folder;
  bool vtk = true, pictures = true;
  double full_order_duration_s = 0.06;
};

/// All parameters of a case file.
struct Case {
  fem::SensorParameters sensor;
  BaseMotion base;
  RecordedInput wind_record;
  RecordParameters records;
  TransientParameters transient;
  SeparationParameters separation;
  OutputParameters output;
};

/// A case file with checked entries: unknown entries, text that is not a number, and values out of
/// range give a UserError with file, line and the known names or the range.
class CaseFile {
 public:
  /// Throws UserError when the file is missing or has a wrong entry. cases/flow_sensor.prm and
  /// cases/whisker_sensor.prm are built in for those who have no such file. Proven by
  /// tests/apps/results_test.cc.
  explicit CaseFile(const std::filesystem::path& file);
  ~CaseFile();
  CaseFile(CaseFile&&) noexcept;

  /// Replaces one entry, as a command-line option does; errors name the option.
  void set(const std::string& section, const std::string& entry, const std::string& value,
           const std::string& option);
  /// The text of a declared entry.
  std::string get(const std::string& section, const std::string& entry) const;
  /// Reads the case. Throws UserError with entries and lines when values are inconsistent.
  Case read();
  /// Text of the case file with all defaults; it reads back to the same case.
  std::string resolved() const;

 private:
  std::filesystem::path file_;
  std::unique_ptr<dealii::ParameterHandler> prm_;
};

}  // namespace vibrissa::sensor_case
