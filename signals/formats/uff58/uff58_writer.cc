#include <algorithm>
#include <cstdio>

#include "signals/formats/uff58_file.h"
#include "signals/system/file_bytes.h"

namespace vibrissa::signals::formats {
namespace {

std::string fixed(const std::string& text, const std::size_t width) {
  std::string result = text.substr(0, width);
  result.resize(width, ' ');
  return result;
}

template <typename... Values>
std::string formatted(const char* const format, const Values... values) {
  std::array<char, 160> line;
  const int n = std::snprintf(line.data(), line.size(), format, values...);
  return {line.data(), static_cast<std::size_t>(n)};
}

// snprintf takes the decimal mark of the locale.
std::string real_text(const double value, const int width, const int digits) {
  std::string text = formatted("%*.*E", width, digits, value);
  std::replace(text.begin(), text.end(), ',', '.');
  return text;
}

std::string axis_line(const Uff58Axis& axis) {
  return formatted("%10d%5d%5d%5d ", axis.quantity, axis.length_exponent, axis.force_exponent,
                   axis.temperature_exponent) +
         fixed(axis.label.empty() ? "NONE" : axis.label, 20) + " " +
         fixed(axis.unit.empty() ? "NONE" : axis.unit, 20) + "\n";
}

std::string head_text(const Uff58Function& function, const std::size_t number) {
  std::string text;
  for (const std::string& line : function.id_lines)
    text += (line.empty() ? "NONE" : line.substr(0, 80)) + "\n";
  text += formatted("%5d%10zu%5d%10d", function.function_type, number, 0, 0);
  text += " NONE      " + formatted("%10d%4d", function.response_node, function.response_direction);
  text +=
      " NONE      " + formatted("%10d%4d\n", function.reference_node, function.reference_direction);
  text += formatted("%10d%10zu%10d", function.is_complex ? complex_double : real_double,
                    function.values.size(), function.abscissa.empty() ? 1 : 0);
  text += real_text(function.abscissa_start, 13, 5) + real_text(function.abscissa_step, 13, 5) +
          real_text(0., 13, 5) + "\n";
  return text + axis_line(function.abscissa_axis) + axis_line(function.ordinate_axis) +
         axis_line(function.denominator_axis) + axis_line({});
}

std::string function_text(const Uff58Function& function, const std::size_t number) {
  std::string text = "    -1\n    58\n" + head_text(function, number);
  const bool is_even = function.abscissa.empty();
  const std::size_t points_a_line = function.is_complex ? (is_even ? 2 : 1) : (is_even ? 4 : 2);
  for (std::size_t i = 0; i < function.values.size(); ++i) {
    if (!is_even) text += real_text(function.abscissa[i], 13, 5);
    text += real_text(function.values[i].real(), 20, 12);
    if (function.is_complex) text += real_text(function.values[i].imag(), 20, 12);
    if ((i + 1) % points_a_line == 0 || i + 1 == function.values.size()) text += '\n';
  }
  return text + "    -1\n";
}

std::string units_text() {
  return "    -1\n   164\n" + formatted("%10d", 1) + fixed("SI: Meter (newton)", 20) +
         formatted("%10d\n", 2) + real_text(1., 25, 17) + real_text(1., 25, 17) +
         real_text(1., 25, 17) + "\n" + real_text(273.15, 25, 17) + "\n    -1\n";
}

}  // namespace

void write_uff58(const std::filesystem::path& file, const std::vector<Uff58Function>& functions) {
  std::string text = units_text();
  for (std::size_t i = 0; i < functions.size(); ++i) text += function_text(functions[i], i + 1);
  write_bytes(file, text);
}

}  // namespace vibrissa::signals::formats
