#include "signals/files/response_file.h"

#include <algorithm>
#include <cmath>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/files/file_format.h"
#include "signals/formats/mat_file.h"
#include "signals/formats/uff58/uff58_exact.h"
#include "signals/system/output_file.h"

namespace vibrissa::signals::formats {
namespace {

constexpr int x_direction = 1, y_axis = 5, base_node = 1;

const std::string coherence_title = "coherence, 0 .. 1";

std::string convention_in(const std::string& unit) {
  return "exp(+j w t), one-sided, Hz, " + unit;
}

std::string title_in(const std::string& unit) {
  return (unit == moment_per_acceleration ? "base moment / base acceleration: " : "response: ") +
         convention_in(unit);
}

bool is_even(const std::vector<double>& frequency_hz) {
  constexpr double share_of_a_step = 1e-6;
  if (frequency_hz.size() < 2) return true;
  const auto last = static_cast<double>(frequency_hz.size() - 1);
  const double step = (frequency_hz.back() - frequency_hz.front()) / last;
  for (std::size_t i = 0; i < frequency_hz.size(); ++i)
    if (std::abs(frequency_hz[i] - frequency_hz.front() - static_cast<double>(i) * step) >
        share_of_a_step * step)
      return false;
  return true;
}

void write_csv(const std::filesystem::path& file, const FrequencyResponse& response,
               const std::string& unit) {
  write_file(file, [&](std::ostream& out) {
    const bool has_coherence = !response.coherence.empty();
    const bool has_deviation = !response.standard_deviation.empty();
    const std::string in = unit == moment_per_acceleration ? "" : " [" + unit + "]";
    out << "# " << title_in(unit) << "\n"
        << "frequency_hz,response_real" << in << ",response_imaginary" << in
        << (has_coherence ? ",coherence" : "") << (has_deviation ? ",standard_deviation" : "")
        << "\n";
    for (std::size_t i = 0; i < response.value.size(); ++i) {
      out << to_text(response.frequency_hz[i]) << "," << to_text(response.value[i].real()) << ","
          << to_text(response.value[i].imag());
      if (has_coherence) out << "," << to_text(response.coherence[i]);
      if (has_deviation) out << "," << to_text(response.standard_deviation[i]);
      out << "\n";
    }
  });
}

bool all_finite(const std::vector<double>& values) {
  return !values.empty() && std::all_of(values.begin(), values.end(),
                                        [](double value) { return std::isfinite(value); });
}

/// A real function of the same lines between the same degrees of freedom.
Uff58Function beside(const Uff58Function& response, const Uff58FunctionType type,
                     const std::string& title, const std::vector<double>& values) {
  Uff58Function function = response;
  function.function_type = type;
  function.id_lines[1] = title;
  function.is_complex = false;
  function.values.assign(values.begin(), values.end());
  if (type == coherence_function) {
    function.ordinate_axis = {.label = "Coherence"};
    function.denominator_axis = {};
  }
  return function;
}

}  // namespace

std::vector<Uff58Function> uff58_of(const FrequencyResponse& response, const std::string& name,
                                    const std::string& unit) {
  const std::vector<double>& f = response.frequency_hz;
  Uff58Function function{
      .id_lines = {name, title_in(unit), "", "", ""},
      .function_type = frequency_response,
      .response_node = base_node,
      .response_direction = y_axis,
      .reference_node = base_node,
      .reference_direction = x_direction,
      .is_complex = true,
      .values = response.value,
      .abscissa_axis = {.quantity = 18, .label = "Frequency", .unit = "Hz"},
      .ordinate_axis = {.quantity = 9,
                        .length_exponent = 1,
                        .force_exponent = 1,
                        .label = "Moment",
                        .unit = "N m"},
      .denominator_axis = {.quantity = 12, .label = "Acceleration", .unit = "m/s^2"}};
  if (unit != moment_per_acceleration) {
    function.ordinate_axis = {.label = "Response", .unit = unit};
    function.denominator_axis = {};
  }
  if (!is_even(f)) {
    function.abscissa = f;
  } else if (!f.empty()) {
    function.abscissa_start = f.front();
    const auto n_steps = static_cast<double>(std::max<std::size_t>(1, f.size() - 1));
    function.abscissa_step = (f.back() - f.front()) / n_steps;
    if (function.abscissa_step > 0.)
      function.id_lines[3] = frequency_grid.line(function.abscissa_start, function.abscissa_step);
  }
  std::vector<Uff58Function> functions{function};
  if (all_finite(response.coherence))
    functions.push_back(beside(function, coherence_function, coherence_title, response.coherence));
  if (all_finite(response.standard_deviation))
    functions.push_back(
        beside(function, general_function, deviation_title, response.standard_deviation));
  return functions;
}

void write_response(const std::filesystem::path& file, const FrequencyResponse& response,
                    const std::string& name, const std::string& unit) {
  if (format_of(file).has(universal_extension))
    return write_uff58(file, uff58_of(response, name, unit));
  if (format_of(file).has(".mat")) return write_mat(file, response, convention_in(unit));
  if (extension_of(file) == ".csv") return write_csv(file, response, unit);
  throw UserError(file.string() +
                  ": a frequency response can be written as .uff, .unv, .uf58 (Universal File, "
                  "type 58), .mat or .csv; use one of these endings");
}

}  // namespace vibrissa::signals::formats
