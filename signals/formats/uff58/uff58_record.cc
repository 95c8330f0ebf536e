#include "signals/formats/uff58/uff58_record.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "signals/base/error.h"
#include "signals/formats/numeric_table.h"
#include "signals/formats/record_columns.h"
#include "signals/formats/uff58/uff58_exact.h"
#include "signals/formats/uff58_file.h"
#include "signals/record/channel_name.h"

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

bool tell_apart(const std::vector<std::string>& names) {
  const std::set<std::string> different(names.begin(), names.end());
  return different.size() == names.size() && different.count("") == 0 &&
         different.count("NONE") == 0;
}

// The first line of the functions, the label of their values, or their degree of freedom.
std::vector<std::string> names_of(const std::vector<Uff58Function>& functions) {
  std::vector<std::string> titles, labels, freedoms;
  for (const Uff58Function& function : functions) {
    titles.push_back(function.id_lines[0]);
    labels.push_back(function.ordinate_axis.label);
    freedoms.push_back(degree_of_freedom(function));
  }
  if (tell_apart(titles) && titles.size() > 1) return titles;
  if (tell_apart(labels) && labels.size() > 1) return labels;
  return tell_apart(titles) ? titles : freedoms;
}

constexpr int time_axis = 17;

bool is_over_time(const Uff58Function& function) {
  if (function.is_complex || function.values.size() < 2) return false;
  if (!function.abscissa.empty()) return function.abscissa_axis.quantity == time_axis;
  return function.abscissa_step > 0. &&
         (function.function_type == time_response || function.abscissa_axis.quantity == time_axis);
}

std::string kind_of(const Uff58Function& function) {
  static const std::map<int, std::string> kinds{{0, "general function"},
                                                {1, "time response"},
                                                {2, "auto spectrum"},
                                                {3, "cross spectrum"},
                                                {4, "frequency response function"},
                                                {5, "transmissibility"},
                                                {6, "coherence"},
                                                {7, "autocorrelation"},
                                                {8, "cross correlation"},
                                                {9, "power spectral density"},
                                                {10, "energy spectral density"},
                                                {11, "probability density"},
                                                {12, "spectrum"}};
  const auto found = kinds.find(function.function_type);
  return "type " + std::to_string(function.function_type) +
         (found == kinds.end() ? "" : ", " + found->second);
}

[[noreturn]] void refuse_functions(const std::string& file,
                                   const std::vector<Uff58Function>& functions) {
  std::set<std::string> kinds;
  bool has_response = false;
  for (const Uff58Function& function : functions) {
    kinds.insert(kind_of(function) + (function.values.size() < 2 ? " of one point" : ""));
    has_response = has_response || function.function_type == frequency_response;
  }
  std::string text;
  for (const std::string& kind : kinds) text += (text.empty() ? "" : "; ") + kind;
  throw UserError(file + ": contains no uniformly sampled time response" +
                  (has_response ? "; to read its frequency responses, use identify or convert "
                                  "with --frequency-response"
                                : "") +
                  ". Its functions: " + text);
}

std::string unit_of(const Uff58Axis& axis) {
  return axis.unit == "NONE" ? "" : axis.unit;
}

}  // namespace

std::unique_ptr<RecordTable> read_uff58_table(const std::filesystem::path& file) {
  const std::vector<Uff58Function> all = read_uff58(file);
  std::vector<Uff58Function> functions;
  std::copy_if(all.begin(), all.end(), std::back_inserter(functions), is_over_time);
  if (functions.empty()) refuse_functions(file.string(), all);
  const Uff58Function first = functions.front();
  std::erase_if(functions, [&](const Uff58Function& function) {
    return function.values.size() != first.values.size() ||
           function.abscissa_step != first.abscissa_step || function.abscissa != first.abscissa;
  });
  const std::vector<std::string> names = names_of(functions);
  std::vector<NumericColumn> columns;
  if (!first.abscissa.empty()) columns.push_back({time_channel, first.abscissa, false, "s"});
  for (std::size_t i = 0; i < functions.size(); ++i) {
    columns.push_back(
        {names[i], {}, functions[i].single_precision, unit_of(functions[i].ordinate_axis)});
    for (const auto& value : functions[i].values) columns.back().values.push_back(value.real());
  }
  if (!first.abscissa.empty())
    return std::make_unique<NumericTable>(file.string(), std::move(columns));
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
