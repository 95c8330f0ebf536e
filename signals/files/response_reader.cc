#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <numeric>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/lower_case.h"
#include "signals/base/median.h"
#include "signals/base/number_text.h"
#include "signals/base/scaled_name.h"
#include "signals/base/trimmed.h"
#include "signals/base/unit.h"
#include "signals/files/file_format.h"
#include "signals/files/response_file.h"
#include "signals/formats/response_unit.h"
#include "signals/formats/uff58/uff58_exact.h"
#include "signals/record/column_unit.h"

namespace vibrissa::signals::formats {
namespace {

using Values = std::vector<double>;

std::string wanted_unit(const ResponseChoice& choice) {
  return choice.output_unit + (choice.per_acceleration ? " s^2/m" : "");
}

/// The unit that the choice gives or the file states.
ResponseUnit unit_of_values(const bool is_given, const std::string& stated,
                            const ResponseChoice& choice, const std::filesystem::path& file) {
  const std::string wanted = wanted_unit(choice);
  if (is_given) return {.unit = wanted, .words = "frequency response, unit as given"};
  return response_unit(stated, wanted, choice.may_keep_unit, file.string());
}

/// The names are those that the file has.
ScaledName scaled_name(const std::string& text, const ResponseChoice& choice,
                       const std::vector<std::string>& names) {
  try {
    if (const auto name = name_as_it_stands(text, wanted_unit(choice), names)) return *name;
    return parse_scaled_name(text, wanted_unit(choice));
  } catch (const UnitError& error) {
    const std::string quantity = choice.output_unit == "N m" ? "moment" : choice.output_unit;
    throw UserError("response '" + text + "': " + error.what() + ". The unit of a response is " +
                    quantity + (choice.per_acceleration ? " per acceleration" : "") +
                    "; a factor may have a unit, as in '[uT/g]*0.18[N m/T]'");
  } catch (const UserError& error) {
    throw UserError("response '" + text + "': " + error.what());
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
  /// The column with this name, with or without a unit behind it.
  std::optional<std::size_t> find_value(const std::string& name) const {
    if (const auto column = find(name)) return column;
    for (std::size_t i = 0; i < size(); ++i)
      if (split_unit(table_.columns()[i]).name == name) return i;
    return {};
  }
  /// The unit that the file states beside the name or in brackets behind it: the end of
  /// "magnitude_n_m_s2_per_m" is no unit of its own.
  std::string unit(const std::size_t column) const {
    const std::string beside = table_.units()[column];
    const bool has_brackets = name(column).ends_with(']') || name(column).ends_with(')');
    return beside.empty() && has_brackets ? split_unit(name(column)).unit : beside;
  }
  std::size_t size() const { return table_.columns().size(); }
  const std::vector<std::string>& names() const { return table_.columns(); }
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

// The name in lower case without its unit, and the unit: "phase", "deg" of "Phase [deg]" and
// "phase_deg".
NamedUnit plain_name(const std::string& column) {
  std::string name = lower_case(column);
  const std::size_t open = name.find_first_of("[(");
  if (open != std::string::npos && (name.ends_with(']') || name.ends_with(')')))
    return {std::string(trimmed(name.substr(0, open))),
            std::string(trimmed(name.substr(open + 1, name.size() - open - 2)))};
  for (const std::string unit : {"deg", "rad", "db", "hz"})
    if (name.ends_with("_" + unit)) return {name.substr(0, name.size() - unit.size() - 1), unit};
  return {name, ""};
}

// Columns whose plain name begins so, and their units.
std::vector<std::pair<std::size_t, std::string>> columns_called(
    const Columns& columns, const std::initializer_list<std::string_view> names) {
  std::vector<std::pair<std::size_t, std::string>> found;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const NamedUnit parts = plain_name(columns.name(i));
    for (const std::string_view name : names)
      if (parts.name.starts_with(name)) {
        found.emplace_back(i, parts.unit);
        break;
      }
  }
  return found;
}

Values frequencies(const Columns& columns) {
  for (const char* const name : {"frequency_hz", "frequency", "freq", "f"})
    if (const auto column = columns.find(name)) return columns.values(*column);
  const auto similar = columns_called(columns, {"freq"});
  if (similar.size() == 1) {
    Values values = columns.values(similar.front().first);
    const double factor = similar.front().second == "khz" ? 1e3 : 1.;
    for (double& value : values) value *= factor;
    return values;
  }
  columns.refuse("no frequency column (frequency_hz, frequency, freq or f)");
}

using Complex = std::vector<std::complex<double>>;

/// Values and the unit that the file states for them.
struct Stated {
  Complex value{};
  std::string unit{};
  bool unit_is_given = false;
};

std::optional<Stated> by_parts(const Columns& columns, const std::string& real,
                               const std::string& imaginary) {
  const auto a = columns.find_value(real), b = columns.find_value(imaginary);
  if (!a || !b) return {};
  const Values x = columns.values(*a), y = columns.values(*b);
  Stated found{.unit = columns.unit(*a)};
  for (std::size_t i = 0; i < x.size(); ++i) found.value.emplace_back(x[i], y[i]);
  return found;
}

// A magnitude is never negative, but its logarithm is.
bool is_in_decibels(const std::string& unit, const Values& magnitude) {
  return unit == "db" ||
         std::any_of(magnitude.begin(), magnitude.end(), [](const double r) { return r < 0.; });
}

// Whether the column contains decibels. Only a response without unit may tell so by its sign alone.
bool in_decibels(const Columns& columns, const std::size_t column, const std::string& unit,
                 const Values& magnitude, const bool is_named) {
  if (unit == "db" || lower_case(columns.name(column)).ends_with("_db")) return true;
  if (!is_named) return is_in_decibels(unit, magnitude);
  if (is_in_decibels(unit, magnitude))
    columns.refuse(
        "column '" + columns.name(column) +
        "' has negative values, which no magnitude has; where it is in decibels, name it "
        "..._dB");
  return false;
}

// Column and unit that the choice names, or the first of those with the usual names.
std::optional<std::pair<std::size_t, std::string>> column_of(
    const Columns& columns, const std::string& chosen,
    const std::initializer_list<std::string_view> usual) {
  if (chosen.empty()) {
    const auto found = columns_called(columns, usual);
    return found.empty() ? std::nullopt : std::optional(found.front());
  }
  const auto column = columns.find_value(chosen);
  if (!column) columns.refuse("no column '" + chosen + "'");
  return std::pair(*column, plain_name(columns.name(*column)).unit);
}

std::optional<Stated> by_magnitude(const Columns& columns, const ResponseChoice& choice) {
  const ScaledName chosen = choice.magnitude.empty()
                                ? ScaledName{}
                                : scaled_name(choice.magnitude, choice, columns.names());
  const auto magnitude = column_of(columns, chosen.name, {"magnitude", "amplitude", "gain"});
  const auto phases = column_of(columns, choice.phase, {"phase"});
  if (!magnitude || !phases) return {};
  const auto& [phase_column, phase_unit] = *phases;
  const bool is_in_radians = phase_unit.starts_with("rad");
  if (!is_in_radians && !phase_unit.starts_with("deg") && phase_unit != "\u00b0")
    columns.refuse("the unit of column '" + columns.name(phase_column) +
                   "' is not known; name it phase_deg or phase_rad");
  Values r = columns.values(magnitude->first);
  const Values phase = columns.values(phase_column);
  Stated found{.unit_is_given = chosen.has_unit};
  if (in_decibels(columns, magnitude->first, magnitude->second, r, !choice.magnitude.empty()))
    for (double& value : r) value = std::pow(10., value / 20.);
  else
    found.unit = columns.unit(magnitude->first);
  for (std::size_t i = 0; i < r.size(); ++i)
    found.value.push_back(
        std::polar(1., (is_in_radians ? 1. : std::numbers::pi / 180.) * phase[i]) *
        (chosen.scale * r[i]));
  return found;
}

// Names of the complex columns of the file.
std::vector<std::string> complex_names(const Columns& columns) {
  std::vector<std::string> names;
  constexpr std::string_view real = "_real";
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string name = split_unit(columns.name(i)).name;
    if (!name.ends_with(real)) continue;
    const std::string before = name.substr(0, name.size() - real.size());
    if (columns.find_value(before + "_imaginary")) names.push_back(before);
  }
  return names;
}

Stated responses(const Columns& columns, const std::string& name, const ResponseChoice& choice) {
  if (!choice.magnitude.empty()) return *by_magnitude(columns, choice);
  std::vector<std::string> names = {"response", "frf", "H"};
  if (!name.empty()) names = {name};
  for (const std::string& known : names)
    if (auto value = by_parts(columns, known + "_real", known + "_imaginary")) return *value;
  if (name.empty()) {
    if (auto value = by_parts(columns, "real", "imaginary")) return *value;
    if (auto value = by_magnitude(columns, choice)) return *value;
    const std::vector<std::string> known = complex_names(columns);
    if (known.size() == 1) return *by_parts(columns, known[0] + "_real", known[0] + "_imaginary");
    columns.refuse(
        "no response columns (response_real and response_imaginary, real and imaginary, or "
        "magnitude or magnitude_dB and phase_deg)" +
        (known.empty() ? ""
                       : "; name one of the complex columns by --response-as: " + listed(known)));
  }
  columns.refuse("no columns '" + name + "_real' and '" + name + "_imaginary'");
}

Values coherence_of(const Columns& columns) {
  if (const auto column = columns.find("coherence")) return columns.values(*column);
  std::vector<std::size_t> similar;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (lower_case(columns.name(i)).find("coh") != std::string::npos) similar.push_back(i);
  if (similar.size() != 1) return {};
  Values values = columns.values(similar.front());
  // An analyser may print more than 1 where it had no signal, which is no coherence.
  if (median(values) > 1.) return {};
  constexpr double rounding = 1e-3;
  for (double& c : values) c = c >= 0. && c <= 1. + rounding ? std::min(c, 1.) : 0.;
  return values;
}

FileResponse from_table(const std::filesystem::path& file, const std::string& as,
                        const ResponseChoice& choice) {
  const auto table = open_table(file);
  const Columns columns(*table);
  const ScaledName name = scaled_name(as, choice, complex_names(columns));
  Stated found = responses(columns, name.name, choice);
  const ResponseUnit unit =
      unit_of_values(name.has_unit || found.unit_is_given, found.unit, choice, file);
  const double scale = name.scale * unit.scale;
  FileResponse response{
      {frequencies(columns), std::move(found.value), {}, {}}, unit.unit, unit.words};
  for (auto& value : response.value) value *= scale;
  response.coherence = coherence_of(columns);
  if (const auto column = columns.find_start("standard_deviation")) {
    response.standard_deviation = columns.values(*column);
    for (double& sd : response.standard_deviation) sd *= std::abs(scale);
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

// "mN mm/g" of a function whose axes are told; empty: the file states none.
std::string unit_of(const Uff58Function& function) {
  const auto told = [](const std::string& unit) { return unit == "NONE" ? "" : unit; };
  const std::string above = told(function.ordinate_axis.unit),
                    below = told(function.denominator_axis.unit);
  if (above.empty() || below.empty()) return above;
  return unit_of_ratio(above, below);
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

FileResponse from_universal_file(const std::filesystem::path& file, const std::string& as,
                                 const ResponseChoice& choice) {
  const std::vector<Uff58Function> functions = read_uff58(file);
  std::vector<std::string> first_lines;
  for (const Uff58Function& function : functions) first_lines.push_back(function.id_lines[0]);
  const ScaledName name = scaled_name(as, choice, first_lines);
  const std::size_t i = chosen(functions, name.name, file.string());
  const Uff58Function& function = functions[i];
  const ResponseUnit unit = unit_of_values(name.has_unit, unit_of(function), choice, file);
  const double scale = name.scale * unit.scale;
  FileResponse response{{frequencies(function), function.values, {}, {}}, unit.unit, unit.words};
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

[[noreturn]] void refuse_line(const Values& frequency_hz, const std::size_t i,
                              const std::string& file, const std::string& what) {
  throw UserError(file + ": frequency " + std::to_string(i + 1) + " (" + to_text(frequency_hz[i]) +
                  " Hz) " + what);
}

void check_frequencies(const Values& frequency_hz, const std::string& file) {
  for (std::size_t i = 0; i < frequency_hz.size(); ++i)
    if (!(frequency_hz[i] >= 0.) || !std::isfinite(frequency_hz[i]) ||
        (i > 0 && frequency_hz[i] < frequency_hz[i - 1]))
      refuse_line(frequency_hz, i, file,
                  "is negative, not finite or below the frequency before it");
}

// Whether all lines stand in falling order. One turn is an upward and a downward sweep; more turns
// are no sweep.
bool falls(const Values& f, const std::string& file) {
  std::vector<std::size_t> turns;
  double before = 0.;
  for (std::size_t i = 1; i < f.size(); ++i) {
    const double step = f[i] - f[i - 1];
    if (step * before < 0.) turns.push_back(i);
    if (step != 0.) before = step;
  }
  if (turns.size() == 1)
    refuse_line(f, turns.front(), file,
                "turns back: the file mixes an upward and a downward sweep; give each its own file "
                "or columns");
  if (!turns.empty())
    refuse_line(f, turns.front(), file, "is out of order; sort the lines by frequency");
  return f.size() > 1 && f.back() < f.front();
}

void reverse(FrequencyResponse& response) {
  std::ranges::reverse(response.frequency_hz);
  std::ranges::reverse(response.value);
  std::ranges::reverse(response.coherence);
  std::ranges::reverse(response.standard_deviation);
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

FileResponse read_response(const std::filesystem::path& file, const ResponseChoice& choice) {
  constexpr std::string_view start = "conj(";
  const bool is_conjugated = choice.as.starts_with(start) && choice.as.ends_with(')');
  const std::string as = is_conjugated
                             ? choice.as.substr(start.size(), choice.as.size() - start.size() - 1)
                             : choice.as;
  FileResponse response = format_of(file).has(universal_extension)
                              ? from_universal_file(file, as, choice)
                              : from_table(file, as, choice);
  if (choice.may_fall && falls(response.frequency_hz, file.string())) reverse(response);
  check_frequencies(response.frequency_hz, file.string());
  FileResponse lines{rising_lines(response), response.unit, response.words};
  if (lines.value.empty())
    throw UserError(
        file.string() +
        ": contains no line of a frequency response above 0 Hz; at least one line is needed");
  if (is_conjugated)
    for (auto& value : lines.value) value = std::conj(value);
  return lines;
}

std::vector<double> read_response_column(const std::filesystem::path& file,
                                         const std::string& column, const std::string& unit,
                                         const ResponseChoice& choice) {
  if (format_of(file).has(universal_extension))
    throw UserError(file.string() + ": a Universal File has no column '" + column +
                    "'; give the number itself");
  const auto table = open_table(file);
  const Columns columns(*table);
  const auto as_it_stands = name_as_it_stands(column, unit, columns.names());
  const ScaledName name = as_it_stands ? *as_it_stands : parse_scaled_name(column, unit);
  const auto found = columns.find_value(name.name);
  if (!found) columns.refuse("no column '" + name.name + "'");
  FrequencyResponse lines{frequencies(columns), {}, {}, {}};
  const std::string stated = columns.unit(*found);
  const UnitConversion to_unit = name.has_unit || name.has_factor || stated.empty()
                                     ? UnitConversion{name.scale, name.offset}
                                     : convert_unit(stated, unit);
  for (const double value : columns.values(*found))
    lines.value.emplace_back(to_unit.scale * value + to_unit.offset);
  if (choice.may_fall && falls(lines.frequency_hz, file.string())) reverse(lines);
  std::vector<double> out;
  for (const auto& value : rising_lines(lines).value) out.push_back(value.real());
  return out;
}

}  // namespace vibrissa::signals::formats
