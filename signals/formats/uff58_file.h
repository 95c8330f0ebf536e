#pragma once

#include <array>
#include <complex>
#include <filesystem>
#include <string>
#include <vector>

namespace vibrissa::signals::formats {

/// Types of values, with their numbers in the format.
enum Uff58Ordinate { real_single = 2, real_double = 4, complex_single = 5, complex_double = 6 };

/// Types of functions that are read and written here, with their numbers in the format.
enum Uff58FunctionType {
  general_function = 0,
  time_response = 1,
  frequency_response = 4,
  coherence_function = 6
};

/// Quantity of an axis, with the numbers of the format.
struct Uff58Axis {
  int quantity = 0;  // 17 time, 18 frequency, 12 acceleration, 1 any with the exponents
  int length_exponent = 0, force_exponent = 0, temperature_exponent = 0;
  std::string label{}, unit{};
};

/// One function ("function at nodal DOF") of a Universal File, type 58: the exchange format of
/// modal analysis, defined by SDRC I-DEAS.
struct Uff58Function {
  std::array<std::string, 5> id_lines{};
  int function_type = time_response;
  int response_node = 0, response_direction = 0, reference_node = 0, reference_direction = 0;
  bool is_complex = false, single_precision = false;
  double abscissa_start = 0., abscissa_step = 0.;
  std::vector<double> abscissa{};              // only when it is not uniform
  std::vector<std::complex<double>> values{};  // imaginary parts are 0 when the values are real
  Uff58Axis abscissa_axis{}, ordinate_axis{}, denominator_axis{};
};

inline const std::string universal_extension = ".uff";  // and .unv, .uf58

/// Reads every function of type 58 and 58b (binary) of a file; data sets of other types are
/// ignored. Throws UserError with file and line for damaged content, and for more than
/// most_numbers.
std::vector<Uff58Function> read_uff58(const std::filesystem::path& file);
/// The same from the bytes of a file; name is the file name in messages.
std::vector<Uff58Function> parse_uff58(const std::string& bytes, const std::string& name);

/// Writes functions as text, after a data set 164 for SI units: values with 13 significant digits;
/// start and step of the abscissa with 6, as the format defines. Proven by
/// tests/signals/formats/uff58_file_test.cc.
void write_uff58(const std::filesystem::path& file, const std::vector<Uff58Function>& functions);

}  // namespace vibrissa::signals::formats
