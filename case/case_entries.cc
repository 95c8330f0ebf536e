#include "case/case_entries.h"

#include <cmath>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::sensor_case {

namespace {

namespace Patterns = dealii::Patterns;
using dealii::ParameterHandler;
using signals::UserError;

void declare_recorded(ParameterHandler& prm, const std::string& unit) {
  prm.declare_entry("File", "", Patterns::Anything(),
                    "File of the recording: CSV, MATLAB, HDF5, NumPy, Universal File 58 or WAV.");
  prm.declare_entry("Column", "", Patterns::Anything(),
                    "Name of the column, with its unit in brackets unless the unit is SI, as in "
                    "ax[g]; empty: the column that has the name of the channel.");
  prm.declare_entry("Scale", "1", Patterns::Double(),
                    "Additional factor that gives the channel in " + unit + ".");
  prm.declare_entry("Sampling rate", "", Patterns::List(Patterns::Double(1e-3), 0, 1),
                    "Sampling rate of the file [Hz]; empty: from its column time_s.");
  prm.declare_entry("First row", "1", Patterns::Integer(1),
                    "First data row that is used; the first row of the file has the number 1.");
  prm.declare_entry("Rows", "", Patterns::List(Patterns::Integer(1), 0, 1),
                    "Number of data rows that are used; empty: up to the last row.");
  prm.declare_entry("Remove mean", "false", Patterns::Bool(),
                    "Whether the mean (gravity, offset) is removed.");
  prm.declare_entry("Range", "", Patterns::List(Patterns::Double(), 0, 2),
                    "Lowest and highest value; the recording is scaled linearly to this range [" +
                        unit + "]; empty: no scaling.");
}

std::vector<double> numbers(ParameterHandler& prm, const std::string& entry) {
  return dealii::Utilities::string_to_double(
      dealii::Utilities::split_string_list(prm.get(entry), ','));
}

RecordedInput parse_recorded(ParameterHandler& prm, const std::string& section, const bool used) {
  RecordedInput input;
  input.file = prm.get("File");
  if (used && input.file.empty()) {
    throw UserError(section +
                    "/File is empty, but Kind = recorded; name the file of the recording");
  }
  input.column = prm.get("Column");
  input.scale = prm.get_double("Scale");
  if (input.scale == 0.) throw UserError(section + "/Scale is 0; give a factor other than 0");
  if (const auto rate = numbers(prm, "Sampling rate"); !rate.empty()) {
    input.sampling_rate_hz = rate.front();
  }
  input.first_row = static_cast<std::size_t>(prm.get_integer("First row"));
  if (const auto rows = numbers(prm, "Rows"); !rows.empty()) {
    input.n_rows = static_cast<std::size_t>(rows.front());
  }
  input.remove_mean = prm.get_bool("Remove mean");
  const auto range = numbers(prm, "Range");
  if (range.size() == 1 || (range.size() == 2 && !(range[0] < range[1]))) {
    throw UserError(section + "/Range needs two values: the lowest, then the highest");
  }
  if (range.size() == 2) input.range = {range[0], range[1]};
  return input;
}

void declare_base_motion(ParameterHandler& prm) {
  prm.enter_subsection("Base motion");
  prm.declare_entry("Kind", "multisine", Patterns::Selection("none|multisine|recorded"),
                    "Acceleration of the base along the axial direction.");
  prm.declare_entry("Lines", "2, 5, 9, 16, 27, 38, 60, 95, 140, 200",
                    Patterns::List(Patterns::Double(1e-3), 1, 10000),
                    "Frequencies of the multisine lines [Hz].");
  prm.declare_entry("Peak", "3.92", Patterns::Double(0.),
                    "Peak acceleration of the multisine [m/s^2] (3.92 = 0.4 g).");
  prm.declare_entry("Phases", "schroeder", Patterns::Selection("schroeder|random|ascending|zero"),
                    "Phases of the multisine lines; ascending: steps of 30 degrees.");
  prm.enter_subsection("Recorded");
  declare_recorded(prm, "m/s^2");
  prm.leave_subsection();
  prm.leave_subsection();
}

BaseMotion parse_base_motion(ParameterHandler& prm) {
  prm.enter_subsection("Base motion");
  BaseMotion base;
  const std::string kind = prm.get("Kind"), phases = prm.get("Phases");
  base.kind = kind == "none"        ? BaseMotionKind::none
              : kind == "multisine" ? BaseMotionKind::multisine
                                    : BaseMotionKind::recorded;
  base.phase = phases == "schroeder" ? signals::MultisinePhase::schroeder
               : phases == "random"  ? signals::MultisinePhase::random
               : phases == "zero"    ? signals::MultisinePhase::zero
                                     : signals::MultisinePhase::ascending;
  base.line_frequency_hz = numbers(prm, "Lines");
  base.peak_m_s2 = prm.get_double("Peak");
  prm.enter_subsection("Recorded");
  base.recorded =
      parse_recorded(prm, "Base motion/Recorded", base.kind == BaseMotionKind::recorded);
  prm.leave_subsection();
  prm.leave_subsection();
  return base;
}

void declare_records(ParameterHandler& prm) {
  prm.enter_subsection("Records");
  prm.declare_entry("Sampling rate", "500", Patterns::Double(1., 1e6),
                    "Sampling rate of all records [Hz].");
  prm.declare_entry("Duration", "20", Patterns::Double(0.2, 1e5), "Duration of all records [s].");
  prm.declare_entry("Seed", "1", Patterns::Integer(0),
                    "Seed of the random numbers for turbulence and noise.");
  prm.declare_entry("Accelerometer noise", "0.0785", Patterns::Double(0., 1e3),
                    "Standard deviation of the noise of the measured base acceleration, sample by "
                    "sample [m/s^2] (0.0785 = 0.008 g).");
  prm.declare_entry("Moment noise", "1e-6", Patterns::Double(0., 1e3),
                    "Standard deviation of the noise of the measured base moment, sample by sample "
                    "[N m] (1e-6 = 5.43 uT).");
  prm.leave_subsection();
}

RecordParameters parse_records(ParameterHandler& prm) {
  prm.enter_subsection("Records");
  RecordParameters records;
  records.sampling_rate_hz = prm.get_double("Sampling rate");
  records.duration_s = prm.get_double("Duration");
  records.seed = static_cast<std::uint64_t>(prm.get_integer("Seed"));
  records.accelerometer_noise_m_s2 = prm.get_double("Accelerometer noise");
  records.moment_noise_n_m = prm.get_double("Moment noise");
  prm.leave_subsection();
  return records;
}

void declare_separation(ParameterHandler& prm) {
  prm.enter_subsection("Separation");
  prm.declare_entry(
      "Largest order", "6", Patterns::Integer(2, 40),
      "Highest number of poles that is tried for the base vibration response model [1].");
  prm.declare_entry("Block length", "64", Patterns::Integer(1, 65536),
                    "Number of new samples in each block of the adaptive filter [samples].");
  prm.declare_entry("Filter length", "512", Patterns::Integer(1, 1048576),
                    "Number of taps of the adaptive filter [samples].");
  prm.declare_entry("Step", "0.1", Patterns::Double(1e-9, 2.),
                    "Step size mu of the adaptive filter, normalised by the input's power [1].");
  prm.declare_entry(
      "Settling time", "2", Patterns::Double(0., 1e4),
      "Time at the start of the record that the scores do not use, for every method [s].");
  prm.leave_subsection();
}

SeparationParameters parse_separation(ParameterHandler& prm) {
  prm.enter_subsection("Separation");
  SeparationParameters separation;
  separation.largest_order = static_cast<unsigned int>(prm.get_integer("Largest order"));
  separation.fdaf.block_length = static_cast<std::size_t>(prm.get_integer("Block length"));
  separation.fdaf.filter_length = static_cast<std::size_t>(prm.get_integer("Filter length"));
  separation.fdaf.step.step = prm.get_double("Step");
  separation.settling_s = prm.get_double("Settling time");
  prm.leave_subsection();
  return separation;
}

void declare_output(ParameterHandler& prm) {
  prm.enter_subsection("Output");
  prm.declare_entry(
      "Folder", "", Patterns::Anything(),
      "Folder of the results; it must not exist yet. Empty: a free name below results/.");
  prm.declare_entry("VTK", "true", Patterns::Bool(), "Whether .vtu and .pvd files are written.");
  prm.declare_entry("Pictures", "true", Patterns::Bool(), "Whether plots are drawn.");
  prm.declare_entry("Full-order duration", "0.06", Patterns::Double(0., 1e4),
                    "Duration that the full-order solid simulates, to check the reduced model and "
                    "to give stress fields [s]; 0: none.");
  prm.leave_subsection();
}

OutputParameters parse_output(ParameterHandler& prm) {
  prm.enter_subsection("Output");
  OutputParameters output;
  const std::string folder = prm.get("Folder");
  if (!folder.empty()) output.folder = folder;
  output.vtk = prm.get_bool("VTK");
  output.pictures = prm.get_bool("Pictures");
  output.full_order_duration_s = prm.get_double("Full-order duration");
  prm.leave_subsection();
  return output;
}

void check(const Case& all) {
  fem::check(all.sensor);
  const double nyquist = 0.5 * all.records.sampling_rate_hz;
  if (all.base.kind == BaseMotionKind::multisine) {
    for (const double f : all.base.line_frequency_hz) {
      if (f >= nyquist) {
        throw UserError("Base motion/Lines contains " + signals::to_text(f) +
                        " Hz, which is not below half of Records/Sampling rate (" +
                        signals::to_text(nyquist) +
                        " Hz); remove the line or raise the sampling rate");
      }
    }
  }
  if (all.base.kind == BaseMotionKind::none && all.sensor.wind.kind == flow::WindKind::none) {
    throw UserError(
        "Base motion/Kind and Wind/Kind are both none, so nothing moves the sensor; set one of "
        "them");
  }
}

}  // namespace

std::size_t RecordParameters::n_samples() const {
  return static_cast<std::size_t>(std::llround(duration_s * sampling_rate_hz));
}

void declare_case(ParameterHandler& prm) {
  meshes::SensorGeometry::declare(prm);
  materials::SensorMaterials::declare(prm);
  fem::ModelParameters::declare(prm);
  declare_base_motion(prm);
  flow::WindParameters::declare(prm);
  prm.enter_subsection("Wind");
  prm.enter_subsection("Recorded");
  declare_recorded(prm, "m/s");
  prm.leave_subsection();
  prm.leave_subsection();
  declare_records(prm);
  TransientParameters::declare(prm);
  declare_separation(prm);
  declare_output(prm);
}

Case parse_case(ParameterHandler& prm) {
  Case all;
  all.sensor.geometry.parse(prm);
  all.sensor.materials.parse(prm);
  all.sensor.model.parse(prm);
  all.sensor.wind.parse(prm);
  all.base = parse_base_motion(prm);
  prm.enter_subsection("Wind");
  prm.enter_subsection("Recorded");
  all.wind_record =
      parse_recorded(prm, "Wind/Recorded", all.sensor.wind.kind == flow::WindKind::recorded);
  prm.leave_subsection();
  prm.leave_subsection();
  all.records = parse_records(prm);
  all.transient.parse(prm);
  all.separation = parse_separation(prm);
  all.output = parse_output(prm);
  check(all);
  return all;
}

}  // namespace vibrissa::sensor_case
