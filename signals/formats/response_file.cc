#include "signals/formats/response_file.h"

#include <algorithm>
#include <cmath>

#include "signals/error.h"
#include "signals/formats/file_format.h"
#include "signals/formats/mat_file.h"

namespace vibrissa::signals::formats {
namespace {

constexpr int x_direction = 1, y_axis = 5, base_node = 1;
constexpr int frequency_response = 4;

const std::string convention = "exp(+j w t), one-sided, Hz, N m s^2/m";

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

}  // namespace

Uff58Function uff58_of(const FrequencyResponse& response, const std::string& name) {
  const std::vector<double>& f = response.frequency_hz;
  Uff58Function function{
      .id_lines = {name, "base moment / base acceleration: " + convention, "", "", ""},
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
  if (!is_even(f)) {
    function.abscissa = f;
  } else if (!f.empty()) {
    function.abscissa_start = f.front();
    const auto n_steps = static_cast<double>(std::max<std::size_t>(1, f.size() - 1));
    function.abscissa_step = (f.back() - f.front()) / n_steps;
  }
  return function;
}

void write_response(const std::filesystem::path& file, const FrequencyResponse& response,
                    const std::string& name) {
  const std::string extension = extension_of(file);
  if (extension == ".uff" || extension == ".unv" || extension == ".uf58")
    return write_uff58(file, {uff58_of(response, name)});
  if (extension == ".mat") return write_mat(file, response, convention);
  throw UserError(file.string() +
                  ": a frequency response is written as .uff, .unv, .uf58 (Universal File, type "
                  "58) or .mat; name the file so");
}

}  // namespace vibrissa::signals::formats
