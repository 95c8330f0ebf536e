#include "signals/files/dataset_response.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "signals/base/error.h"
#include "signals/base/median.h"
#include "signals/base/number_text.h"
#include "signals/base/unit.h"
#include "signals/files/response_file.h"
#include "signals/record/dataset_entry.h"
#include "signals/spectra/response_noise.h"

namespace vibrissa::signals {
namespace {

using nlohmann::json;

const std::vector<std::string> response_keys{"kind",   "file",  "drive",    "direction",
                                             "values", "phase", "averages", "response_of",
                                             "repeat", "split", "columns",  "setup"};
const std::vector<std::string> drive_keys{"level", "unit"},
    column_keys{"response", "magnitude", "phase"};

const std::vector<std::pair<std::string, ResponseQuantity>> quantities{
    {"moment", ResponseQuantity::moment},
    {"rotation", ResponseQuantity::rotation},
    {"deflection", ResponseQuantity::deflection},
    {"velocity", ResponseQuantity::velocity},
    {"acceleration", ResponseQuantity::acceleration}};

ResponseQuantity quantity_of(const json& entry, const std::string& where) {
  const std::string word = text_of(entry, "response_of", where, "moment");
  std::vector<std::string> known;
  for (const auto& [name, quantity] : quantities) {
    if (name == word) return quantity;
    known.push_back(name);
  }
  refuse_dataset(where + "/response_of", unknown_name("quantity", word, known));
}

/// One of the known words; the first of them where the entry is missing.
std::string word_of(const json& entry, const std::string& key, const std::string& where,
                    const std::vector<std::string>& known) {
  const std::string word = text_of(entry, key, where, known.front());
  if (std::find(known.begin(), known.end(), word) == known.end())
    refuse_dataset(where + "/" + key, unknown_name("word", word, known));
  return word;
}

std::size_t number_of(const json& entry, const std::string& key, const std::string& where,
                      const std::size_t fallback) {
  if (!entry.contains(key)) return fallback;
  if (!entry[key].is_number_unsigned())
    refuse_dataset(where + "/" + key, "must be a whole number, 0 or more");
  return entry[key].get<std::size_t>();
}

/// Factor from the unit of the drive to m/s2.
double unit_of_drive(const json& drive, const std::string& where) {
  const std::string unit = text_of(drive, "unit", where, "m/s2");
  try {
    return convert_unit(unit, "m/s2").scale;
  } catch (const UnitError& error) {
    refuse_dataset(where + "/unit", std::string(error.what()) +
                                        "; the drive is the amplitude of the base acceleration");
  }
}

/// Amplitude of the base acceleration at each line: a number, or a column of the file.
std::vector<double> levels_of(const json& entry, const std::filesystem::path& file,
                              const formats::ResponseChoice& choice, const std::size_t n_lines,
                              const std::string& where) {
  if (!entry.contains("drive") || !entry["drive"].is_object() || !entry["drive"].contains("level"))
    refuse_dataset(where + "/drive",
                   "the level is missing: give the amplitude of the base acceleration, "
                   "{\"level\": 0.98, \"unit\": \"m/s2\"}, or the name of its column");
  const json& drive = entry["drive"];
  const std::string place = where + "/drive";
  refuse_unknown_entries(drive, drive_keys, place);
  const double factor = unit_of_drive(drive, place);
  std::vector<double> levels;
  if (drive["level"].is_number())
    levels.assign(n_lines, drive["level"].get<double>());
  else if (drive["level"].is_string())
    levels = formats::read_response_column(file, drive["level"], "", choice);
  else
    refuse_dataset(place + "/level", "must be a number or the name of a column");
  for (double& level : levels) {
    level *= factor;
    if (!(level > 0.) || !std::isfinite(level))
      refuse_dataset(place + "/level", "must be above 0 at each line");
  }
  if (levels.size() != n_lines)
    refuse_dataset(place + "/level",
                   "must be known at each of the " + std::to_string(n_lines) + " lines");
  return levels;
}

formats::ResponseChoice choice_of(const json& entry, const ResponseQuantity quantity,
                                  const std::string& where) {
  formats::ResponseChoice choice{
      .output_unit = unit_of(quantity),
      .per_acceleration =
          word_of(entry, "values", where, {"per_drive", "amplitude"}) == "per_drive",
      .may_fall = true};
  if (!entry.contains("columns")) return choice;
  const json& columns = entry["columns"];
  const std::string place = where + "/columns";
  if (!columns.is_object()) refuse_dataset(place, "must be an object that names columns");
  refuse_unknown_entries(columns, column_keys, place);
  choice.as = text_of(columns, "response", place, "");
  choice.magnitude = text_of(columns, "magnitude", place, "");
  choice.phase = text_of(columns, "phase", place, "");
  return choice;
}

std::vector<double> deviations_of(const FrequencyResponse& response, const json& entry,
                                  const std::string& where) {
  if (!response.standard_deviation.empty()) return response.standard_deviation;
  const std::size_t n_averages = number_of(entry, "averages", where, 0);
  if (n_averages > 0 && !response.coherence.empty())
    return deviation_from_coherence(response, static_cast<double>(n_averages));
  try {
    return deviation_from_neighbours(response);
  } catch (const UserError& error) {
    refuse_dataset(where, error.what());
  }
}

/// Turn of the phase [rad] over the lines about the largest one, as far as half its height.
double turn_at_the_peak(const DatasetResponse& response) {
  const auto height = [&](const std::size_t i) {
    return std::abs(response.value[i]) / response.level_m_s2[i];
  };
  std::size_t peak = 0;
  for (std::size_t i = 1; i < response.value.size(); ++i)
    if (height(i) > height(peak)) peak = i;
  double turn = 0.;
  for (std::size_t i = 1; i < response.value.size(); ++i)
    if (std::min(height(i), height(i - 1)) > 0.5 * height(peak))
      turn += std::arg(response.value[i] * std::conj(response.value[i - 1]));
  return turn;
}

/// The phase of a response falls through its resonance.
void refuse_conjugated(const DatasetResponse& response, const std::string& where) {
  constexpr double clear_turn = std::numbers::pi / 3.;
  if (turn_at_the_peak(response) > clear_turn)
    refuse_dataset(where,
                   "the phase rises through the resonance, so it is conjugated (convention "
                   "exp(-j w t), or phase of the drive relative to the response); say \"phase\": "
                   "\"conjugated\"");
}

using Measurement = std::tuple<ResponseQuantity, SweepDirection, double>;
Measurement measurement_of(const DatasetResponse& response) {
  return {response.quantity, response.direction, median(response.level_m_s2)};
}
bool is_same(const DatasetResponse& a, const DatasetResponse& b) {
  return measurement_of(a) == measurement_of(b) && a.setup == b.setup;
}

FrequencyResponse as_frequency_response(const DatasetResponse& response) {
  return {response.frequency_hz, response.value, {}, {}};
}

}  // namespace

std::string unit_of(const ResponseQuantity quantity) {
  switch (quantity) {
    case ResponseQuantity::moment:
      return "N m";
    case ResponseQuantity::rotation:
      return "rad";
    case ResponseQuantity::deflection:
      return "m";
    case ResponseQuantity::velocity:
      return "m/s";
    case ResponseQuantity::acceleration:
      return "m/s2";
  }
  return "";
}

std::string to_string(const ResponseQuantity quantity) {
  for (const auto& [name, one] : quantities)
    if (one == quantity) return name;
  return "";
}

std::string to_string(const SweepDirection direction) {
  return direction == SweepDirection::up ? "up" : "down";
}

bool is_response(const json& entry, const std::string& where) {
  return word_of(entry, "kind", where, {"record", "response"}) == "response";
}

DatasetResponse read_dataset_response(const std::filesystem::path& folder, const json& document,
                                      const json& entry, const std::string& where) {
  refuse_unknown_entries(entry, response_keys, where);
  const std::filesystem::path name = file_of(entry, where), file = folder / name;
  const std::string direction = word_of(entry, "direction", where, {"up", "down"}),
                    phase = word_of(
                        entry, "phase", where,
                        {"known", "unknown_offset", "conjugated", "conjugated_unknown_offset"});
  DatasetResponse out{.name = name.stem().string(),
                      .direction = direction == "up" ? SweepDirection::up : SweepDirection::down,
                      .quantity = quantity_of(entry, where),
                      .phase_offset_is_known = !phase.ends_with("unknown_offset"),
                      .repeat = number_of(entry, "repeat", where, 0),
                      .split = split_of(entry, where),
                      .setup = setup_of(document, entry, where)};
  const formats::ResponseChoice choice = choice_of(entry, out.quantity, where);
  FrequencyResponse response = formats::read_response(file, choice);
  out.level_m_s2 = levels_of(entry, file, choice, response.value.size(), where);
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    const double per_value = choice.per_acceleration ? out.level_m_s2[i] : 1.;
    response.value[i] *= per_value;
    if (phase.starts_with("conjugated")) response.value[i] = std::conj(response.value[i]);
    if (!response.standard_deviation.empty()) response.standard_deviation[i] *= per_value;
  }
  out.standard_deviation = deviations_of(response, entry, where);
  out.frequency_hz = std::move(response.frequency_hz);
  out.value = std::move(response.value);
  refuse_conjugated(out, where + " (" + file.string() + ")");
  return out;
}

void refuse_doubled_levels(const std::vector<DatasetResponse>& responses,
                           const std::string& where) {
  for (std::size_t i = 0; i < responses.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const DatasetResponse &a = responses[j], &b = responses[i];
      if (!is_same(a, b) || a.repeat != b.repeat) continue;
      refuse_dataset(where, "the responses '" + a.name + "' and '" + b.name +
                                "' have the same level, " + to_text(median(b.level_m_s2)) +
                                " m/s2, and direction; correct one of them, or number repeated "
                                "measurements by \"repeat\": 1, 2");
    }
}

void use_repeats(std::vector<DatasetResponse>& responses) {
  for (const DatasetResponse& first : responses) {
    std::vector<DatasetResponse*> repeats;
    for (DatasetResponse& other : responses)
      if (is_same(first, other) && other.frequency_hz == first.frequency_hz)
        repeats.push_back(&other);
    if (repeats.size() < 2 || repeats.front() != &first) continue;
    std::vector<FrequencyResponse> values;
    for (const DatasetResponse* repeat : repeats) values.push_back(as_frequency_response(*repeat));
    std::vector<const FrequencyResponse*> pointers;
    for (const FrequencyResponse& value : values) pointers.push_back(&value);
    const std::vector<double> deviation = deviation_from_repeats(pointers);
    for (DatasetResponse* repeat : repeats) repeat->standard_deviation = deviation;
  }
}

}  // namespace vibrissa::signals
