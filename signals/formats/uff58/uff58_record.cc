#include "signals/formats/uff58/uff58_record.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "signals/base/error.h"
#include "signals/formats/numeric_table.h"
#include "signals/formats/record_columns.h"
#include "signals/formats/uff58/uff58_exact.h"
#include "signals/formats/uff58_file.h"

namespace vibrissa::signals::formats {
namespace {

Uff58Axis axis_of_channel(const std::string& channel) {
  Uff58Axis axis{.label = channel};
  if (channel.ends_with("_N_m")) {
    axis = {
        .quantity = 9, .length_exponent = 1, .force_exponent = 1, .label = "Moment", .unit = "N m"};
  } else if (channel.ends_with("_m_s2")) {
    axis = {.quantity = 12, .label = "Acceleration", .unit = "m/s^2"};
  } else if (channel.ends_with("_m_s")) {
    axis = {.quantity = 11, .label = "Velocity", .unit = "m/s"};
  }
  return axis;
}

/// Of the format: +X, +Y, and rotations about them, +RX, +RY. A moment that bends in the plane of x
/// turns about y, one in the plane of y about -x.
int direction_of(const std::string& channel) {
  constexpr int x = 1, y = 2, about_x = 4, about_y = 5;
  const bool is_cross = channel.starts_with("cross");
  if (channel.ends_with("_N_m")) return is_cross ? -about_x : about_y;
  return is_cross ? y : x;
}

std::optional<TimeAxis> clock_in(const std::string& line) {
  const auto exact = record_clock.in(line);
  if (!exact || !(exact->first > 0.)) return {};
  return TimeAxis{exact->second, exact->first};
}

std::string degree_of_freedom(const Uff58Function& function) {
  static constexpr std::array<const char*, 7> directions = {"", "X", "Y", "Z", "RX", "RY", "RZ"};
  const int direction = std::clamp(function.response_direction, -6, 6);
  return std::to_string(function.response_node) + (direction < 0 ? "-" : "+") +
         directions[static_cast<std::size_t>(std::abs(direction))];
}

std::vector<std::string> names_of(const std::vector<Uff58Function>& functions) {
  std::vector<std::string> names;
  std::set<std::string> different;
  for (const Uff58Function& function : functions) {
    names.push_back(function.id_lines[0]);
    different.insert(function.id_lines[0]);
  }
  const bool tell_apart =
      different.size() == names.size() && different.count("") == 0 && different.count("NONE") == 0;
  for (std::size_t i = 0; !tell_apart && i < names.size(); ++i)
    names[i] = degree_of_freedom(functions[i]);
  return names;
}

}  // namespace

std::unique_ptr<RecordTable> read_uff58_table(const std::filesystem::path& file) {
  std::vector<Uff58Function> functions = read_uff58(file);
  const bool has_response = std::any_of(
      functions.begin(), functions.end(),
      [](const auto& function) { return function.function_type == frequency_response; });
  std::erase_if(functions, [](const Uff58Function& function) {
    return function.function_type != time_response || function.is_complex ||
           !function.abscissa.empty() || !(function.abscissa_step > 0.);
  });
  if (functions.empty())
    throw UserError(file.string() + ": contains no uniformly sampled time response" +
                    (has_response ? "; to read its frequency responses, use identify or convert "
                                    "with --frequency-response"
                                  : ""));
  const Uff58Function first = functions.front();
  std::erase_if(functions, [&](const Uff58Function& function) {
    return function.values.size() != first.values.size() ||
           function.abscissa_step != first.abscissa_step;
  });
  const std::vector<std::string> names = names_of(functions);
  std::vector<NumericColumn> columns;
  for (std::size_t i = 0; i < functions.size(); ++i) {
    columns.push_back({names[i], {}, functions[i].single_precision});
    for (const auto& value : functions[i].values) columns.back().values.push_back(value.real());
  }
  const auto exact = clock_in(first.id_lines[3]);
  return std::make_unique<NumericTable>(
      file.string(), std::move(columns),
      exact.value_or(TimeAxis{first.abscissa_start, 1. / first.abscissa_step}));
}

void write_uff58(const std::filesystem::path& file, const Record& record) {
  std::vector<Uff58Function> functions;
  for (const std::string& name : channels_in_writing_order(record)) {
    Uff58Function function;
    function.id_lines = {name, "SI units; time response", "written by vibrissa",
                         record_clock.line(record.sampling_rate_hz(), record.time_s(0)), "NONE"};
    function.response_node = 1;
    function.response_direction = direction_of(name);
    function.abscissa_start = record.time_s(0);
    function.abscissa_step = 1. / record.sampling_rate_hz();
    function.abscissa_axis = {.quantity = 17, .label = "Time", .unit = "s"};
    function.ordinate_axis = axis_of_channel(name);
    for (const double value : record.channel(name)) function.values.emplace_back(value, 0.);
    functions.push_back(std::move(function));
  }
  write_uff58(file, functions);
}

}  // namespace vibrissa::signals::formats
