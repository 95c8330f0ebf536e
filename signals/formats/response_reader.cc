#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "signals/error.h"
#include "signals/formats/file_format.h"
#include "signals/formats/response_file.h"
#include "signals/lower_case.h"
#include "signals/number_text.h"
#include "signals/scaled_name.h"
#include "signals/unit.h"

namespace vibrissa::signals::formats {
namespace {

using Values = std::vector<double>;

const std::string moment_per_acceleration = "N m s2 m-1";

ScaledName scaled_name(const ResponseChoice& choice) {
  try {
    return parse_scaled_name(choice.as, moment_per_acceleration);
  } catch (const UnitError& error) {
    throw UserError("response '" + choice.as + "': " + error.what() +
                    ". A response is a moment per acceleration; a factor can bring its own unit, "
                    "as in '[uT/g]*0.18[N m/T]'");
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
    throw UserError(table_.place(0) + what + "; the file has: " + listed(table_.columns()));
  }

 private:
  const RecordTable& table_;
};

Values frequencies(const Columns& columns) {
  for (const char* const name : {"frequency_hz", "frequency", "freq", "f"})
    if (const auto column = columns.find(name)) return columns.values(*column);
  columns.refuse("no column of frequencies (frequency_hz, frequency, freq or f)");
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
        "no response (response_real and response_imaginary, real and imaginary, or magnitude or "
        "magnitude_dB and phase_deg)");
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

std::string numbered_titles(const std::vector<Uff58Function>& functions) {
  std::string text;
  for (std::size_t i = 0; i < functions.size(); ++i)
    text.append(i == 0 ? "" : ", ")
        .append(std::to_string(i + 1))
        .append(" '")
        .append(functions[i].id_lines[0])
        .append("'");
  return text;
}

const Uff58Function& chosen(const std::vector<Uff58Function>& functions, const std::string& name,
                            const std::string& file) {
  if (functions.empty())
    throw UserError(file + ": holds no complex frequency response (function of type 4)");
  if (name.empty() && functions.size() == 1) return functions.front();
  const std::string known = ": holds the responses " + numbered_titles(functions) +
                            "; choose one by its number or first line";
  if (name.empty()) throw UserError(file + known);
  if (const auto number = to_number(name)) {
    const auto n = static_cast<double>(functions.size());
    if (!(*number >= 1. && *number <= n && *number == std::floor(*number)))
      throw UserError(file + ": has no response " + name + known.substr(1));
    return functions[static_cast<std::size_t>(*number) - 1];
  }
  for (const Uff58Function& function : functions)
    if (function.id_lines[0] == name) return function;
  throw UserError(file + ": has no response '" + name + "'" + known.substr(1));
}

bool is_told(const std::string& unit) {
  return !unit.empty() && unit != "NONE";
}

/// What the file's own units take to become moments per acceleration.
double scale_of(const Uff58Function& function, const std::string& file) {
  const std::string &above = function.ordinate_axis.unit, &below = function.denominator_axis.unit;
  if (!is_told(above) || !is_told(below)) return 1.;
  try {
    return convert_unit(above, "N m").scale / convert_unit(below, "m/s2").scale;
  } catch (const UnitError& error) {
    throw UserError(file + ": the response is in " + above + " per " + below + ": " + error.what() +
                    ". Say what it takes, as in '[uT/g]*0.18[N m/T]'");
  }
}

FrequencyResponse from_universal_file(const std::filesystem::path& file, const ScaledName& choice) {
  std::vector<Uff58Function> functions = read_uff58(file);
  std::erase_if(functions, [](const Uff58Function& function) {
    return function.function_type != frequency_response || !function.is_complex;
  });
  const Uff58Function& function = chosen(functions, choice.name, file.string());
  const double scale = choice.has_unit ? choice.scale : choice.scale * scale_of(function, file);
  FrequencyResponse response{function.abscissa, function.values, {}, {}};
  for (std::size_t i = 0; function.abscissa.empty() && i < function.values.size(); ++i)
    response.frequency_hz.push_back(function.abscissa_start +
                                    static_cast<double>(i) * function.abscissa_step);
  for (auto& value : response.value) value *= scale;
  return response;
}

void check_frequencies(const Values& frequency_hz, const std::string& file) {
  for (std::size_t i = 0; i < frequency_hz.size(); ++i)
    if (!(frequency_hz[i] >= 0.) || !std::isfinite(frequency_hz[i]) ||
        (i > 0 && frequency_hz[i] < frequency_hz[i - 1]))
      throw UserError(file + ": frequency " + std::to_string(i + 1) + " (" +
                      std::to_string(frequency_hz[i]) +
                      " Hz) is negative, not finite or below the one before");
}

// Two lines may fall together: a Universal File has six digits of uneven frequencies.
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
    throw UserError(file.string() +
                    ": holds no line of a frequency response above zero frequency; write at least "
                    "one");
  return lines;
}

}  // namespace vibrissa::signals::formats
