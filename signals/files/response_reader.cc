#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/lower_case.h"
#include "signals/base/number_text.h"
#include "signals/base/scaled_name.h"
#include "signals/base/unit.h"
#include "signals/files/file_format.h"
#include "signals/files/response_file.h"
#include "signals/formats/uff58/uff58_exact.h"

namespace vibrissa::signals::formats {
namespace {

using Values = std::vector<double>;

const std::string moment_per_acceleration = "N m s2 m-1";

ScaledName scaled_name(const ResponseChoice& choice) {
  try {
    return parse_scaled_name(choice.as, moment_per_acceleration);
  } catch (const UnitError& error) {
    throw UserError("response '" + choice.as + "': " + error.what() +
                    ". The unit of a response is moment per acceleration; a factor may have a "
                    "unit, as in '[uT/g]*0.18[N m/T]'");
  } catch (const UserError& error) {
    throw UserError("response '" + choice.as + "': " + error.what());
  }
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text;
}

/// Columns of a table by name.
class Columns {
 public:
  explicit Columns(const RecordTable& table) : table_(table) {}

  std::optional<std::size_t> find(const std::string& name) const {
    const auto& names = table_.columns();
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) return {};
    return static_cast<std::size_t>(at - names.begin());
  }
  std::optional<std::size_t> find_start(const std::string& start) const {
    const auto& names = table_.columns();
    const auto at = std::find_if(names.begin(), names.end(),
                                 [&](const std::string& name) { return name.starts_with(start); });
    if (at == names.end()) return {};
    return static_cast<std::size_t>(at - names.begin());
  }
  const std::string& name(const std::size_t column) const { return table_.columns()[column]; }
  Values values(const std::size_t column) const {
    const std::array<std::size_t, 1> wanted{column};
    return table_.read({wanted, 1, table_.n_rows()}).columns.front();
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw UserError(table_.place(0) + what + "; columns of the file: " + listed(table_.columns()));
  }

 private:
  const RecordTable& table_;
};

Values frequencies(const Columns& columns) {
  for (const char* const name : {"frequency_hz", "frequency", "freq", "f"})
    if (const auto column = columns.find(name)) return columns.values(*column);
  columns.refuse("no frequency column (frequency_hz, frequency, freq or f)");
}

using Complex = std::vector<std::complex<double>>;

std::optional<Complex> by_parts(const Columns& columns, const std::string& real,
                                const std::string& imaginary) {
  const auto a = columns.find(real), b = columns.find(imaginary);
  if (!a || !b) return {};
  const Values x = columns.values(*a), y = columns.values(*b);
  Complex value;
  for (std::size_t i = 0; i < x.size(); ++i) value.emplace_back(x[i], y[i]);
  return value;
}

bool is_in_decibels(const std::string& column) {
  return lower_case(column).ends_with("db");
}

std::optional<Complex> by_magnitude(const Columns& columns) {
  const auto magnitude = columns.find_start("magnitude");
  const auto degrees = columns.find("phase_deg"), radians = columns.find("phase_rad");
  if (!magnitude || (!degrees && !radians)) return {};
  const double unit = degrees ? std::numbers::pi / 180. : 1.;
  Values r = columns.values(*magnitude);
  const Values phase = columns.values(degrees ? *degrees : *radians);
  if (is_in_decibels(columns.name(*magnitude)))
    for (double& value : r) value = std::pow(10., value / 20.);
  Complex value;
  for (std::size_t i = 0; i < r.size(); ++i)
    value.push_back(std::polar(1., unit * phase[i]) * r[i]);
  return value;
}

Complex responses(const Columns& columns, const std::string& name) {
  std::vector<std::string> names = {"response", "frf", "H"};
  if (!name.empty()) names = {name};
  for (const std::string& known : names)
    if (auto value = by_parts(columns, known + "_real", known + "_imaginary")) return *value;
  if (name.empty()) {
    if (auto value = by_parts(columns, "real", "imaginary")) return *value;
    if (auto value = by_magnitude(columns)) return *value;
    columns.refuse(
        "no response columns (response_real and response_imaginary, real and imaginary, or "
        "magnitude or magnitude_dB and phase_deg)");
  }
  columns.refuse("no columns '" + name + "_real' and '" + name + "_imaginary'");
}

FrequencyResponse from_table(const std::filesystem::path& file, const ScaledName& choice) {
  const auto table = open_table(file);
  const Columns columns(*table);
  FrequencyResponse response{frequencies(columns), responses(columns, choice.name), {}, {}};
  for (auto& value : response.value) value *= choice.scale;
  if (const auto column = columns.find("coherence")) response.coherence = columns.values(*column);
  if (const auto column = columns.find_start("standard_deviation")) {
    response.standard_deviation = columns.values(*column);
    for (double& sd : response.standard_deviation) sd *= std::abs(choice.scale);
  }
  return response;
}

using Places = std::vector<std::size_t>;

Places responses_in(const std::vector<Uff58Function>& functions) {
  Places places;
  for (std::size_t i = 0; i < functions.size(); ++i)
    if (functions[i].function_type == frequency_response && functions[i].is_complex)
      places.push_back(i);
  return places;
}

std::string numbered_titles(const std::vector<Uff58Function>& functions, const Places& places) {
  std::string text;
  for (std::size_t i = 0; i < places.size(); ++i)
    text.append(i == 0 ? "" : ", ")
        .append(std::to_string(i + 1))
        .append(" '")
        .append(functions[places[i]].id_lines[0])
        .append("'");
  return text;
}

/// Index of the response with this number (counted among responses) or first line.
std::size_t chosen(const std::vector<Uff58Function>& functions, const std::string& name,
                   const std::string& file) {
  const Places places = responses_in(functions);
  if (places.empty())
    throw UserError(file + ": contains no complex frequency response (function of type 4)");
  if (name.empty() && places.size() == 1) return places.front();
  const std::string known = "the file contains the responses " +
                            numbered_titles(functions, places) +
                            "; choose one by its number or its first line";
  if (name.empty()) throw UserError(file + ": " + known);
  if (const auto number = to_number(name)) {
    const auto n = static_cast<double>(places.size());
    if (!(*number >= 1. && *number <= n && *number == std::floor(*number)))
      throw UserError(file + ": has no response " + name + "; " + known);
    return places[static_cast<std::size_t>(*number) - 1];
  }
  for (const std::size_t place : places)
    if (functions[place].id_lines[0] == name) return place;
  throw UserError(file + ": has no response '" + name + "'; " + known);
}

bool is_told(const std::string& unit) {
  return !unit.empty() && unit != "NONE";
}

/// Factor from the units of the file to moment per acceleration.
double scale_of(const Uff58Function& function, const std::string& file) {
  const std::string &above = function.ordinate_axis.unit, &below = function.denominator_axis.unit;
  if (!is_told(above) || !is_told(below)) return 1.;
  try {
    return convert_unit(above, "N m").scale / convert_unit(below, "m/s2").scale;
  } catch (const UnitError& error) {
    throw UserError(file + ": the response is in " + above + " per " + below + ": " + error.what() +
                    ". Give the conversion factor, as in '[uT/g]*0.18[N m/T]'");
  }
}

std::vector<double> frequencies(const Uff58Function& function) {
  if (!function.abscissa.empty()) return function.abscissa;
  auto [start_hz, step_hz] = std::pair{function.abscissa_start, function.abscissa_step};
  if (const auto exact = frequency_grid.in(function.id_lines[3]); exact && exact->second > 0.)
    std::tie(start_hz, step_hz) = *exact;
  std::vector<double> frequency_hz;
  for (std::size_t i = 0; i < function.values.size(); ++i)
    frequency_hz.push_back(start_hz + static_cast<double>(i) * step_hz);
  return frequency_hz;
}

bool is_beside(const Uff58Function& a, const Uff58Function& b) {
  return !a.is_complex && a.values.size() == b.values.size() &&
         a.response_node == b.response_node && a.response_direction == b.response_direction &&
         a.reference_node == b.reference_node && a.reference_direction == b.reference_direction;
}

/// Values of the first function of that type between the same degrees of freedom, searched first
/// after the response, then before it.
std::vector<double> beside(const std::vector<Uff58Function>& functions, const std::size_t response,
                           const std::function<bool(const Uff58Function&)>& is_wanted) {
  for (std::size_t i = 1; i < functions.size(); ++i) {
    const Uff58Function& function = functions[(response + i) % functions.size()];
    if (!is_wanted(function) || !is_beside(function, functions[response])) continue;
    std::vector<double> values;
    for (const auto& value : function.values) values.push_back(value.real());
    return values;
  }
  return {};
}

FrequencyResponse from_universal_file(const std::filesystem::path& file, const ScaledName& choice) {
  const std::vector<Uff58Function> functions = read_uff58(file);
  const std::size_t i = chosen(functions, choice.name, file.string());
  const Uff58Function& function = functions[i];
  const double scale = choice.has_unit ? choice.scale : choice.scale * scale_of(function, file);
  FrequencyResponse response{frequencies(function), function.values, {}, {}};
  for (auto& value : response.value) value *= scale;
  response.coherence = beside(functions, i, [](const Uff58Function& other) {
    return other.function_type == coherence_function;
  });
  response.standard_deviation = beside(functions, i, [](const Uff58Function& other) {
    return other.function_type == general_function && other.id_lines[1] == deviation_title;
  });
  for (double& deviation : response.standard_deviation) deviation *= std::abs(scale);
  return response;
}

void check_frequencies(const Values& frequency_hz, const std::string& file) {
  for (std::size_t i = 0; i < frequency_hz.size(); ++i)
    if (!(frequency_hz[i] >= 0.) || !std::isfinite(frequency_hz[i]) ||
        (i > 0 && frequency_hz[i] < frequency_hz[i - 1]))
      throw UserError(file + ": frequency " + std::to_string(i + 1) + " (" +
                      to_text(frequency_hz[i]) +
                      " Hz) is negative, not finite or below the frequency before it");
}

// Two lines may have the same frequency: a Universal File keeps six digits of non-uniform
// frequencies.
FrequencyResponse rising_lines(const FrequencyResponse& response) {
  FrequencyResponse lines;
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    const double before = lines.frequency_hz.empty() ? 0. : lines.frequency_hz.back();
    if (response.frequency_hz[i] <= before) continue;
    lines.frequency_hz.push_back(response.frequency_hz[i]);
    lines.value.push_back(response.value[i]);
    if (!response.coherence.empty()) lines.coherence.push_back(response.coherence[i]);
    if (!response.standard_deviation.empty())
      lines.standard_deviation.push_back(response.standard_deviation[i]);
  }
  return lines;
}

}  // namespace

FrequencyResponse read_response(const std::filesystem::path& file, const ResponseChoice& choice) {
  const ScaledName name = scaled_name(choice);
  const FrequencyResponse response = format_of(file).has(universal_extension)
                                         ? from_universal_file(file, name)
                                         : from_table(file, name);
  check_frequencies(response.frequency_hz, file.string());
  FrequencyResponse lines = rising_lines(response);
  if (lines.value.empty())
    throw UserError(
        file.string() +
        ": contains no line of a frequency response above 0 Hz; at least one line is needed");
  return lines;
}

}  // namespace vibrissa::signals::formats
