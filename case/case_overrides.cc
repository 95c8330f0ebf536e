#include "case/case_overrides.h"

#include <map>

#include "signals/base/error.h"
#include "signals/files/column_choice.h"
#include "signals/files/row_range.h"
#include "signals/record/channel_name.h"
#include "signals/record/record.h"

namespace vibrissa::sensor_case {

namespace {

using signals::UserError;

// Section of the case file for each recorded channel.
const std::map<std::string, std::string>& recorded_sections() {
  static const std::map<std::string, std::string> sections{
      {signals::channel::base_acceleration, "Base motion/Recorded"},
      {signals::channel::wind_speed, "Wind/Recorded"}};
  return sections;
}

std::string section_of(const std::string& channel, const std::string& option) {
  const auto found = recorded_sections().find(channel);
  if (found == recorded_sections().end()) {
    throw UserError(option + ": '" + channel +
                    "' is not an input of a run; the inputs are base_acceleration and wind_speed" +
                    (channel == signals::time_channel
                         ? "; for a file without a column time_s give --rate HZ"
                         : ""));
  }
  return found->second;
}

std::pair<std::string, std::string> split(const std::string& text, const std::string& option) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) {
    throw UserError(option + ": '" + text + "' has no '='; write NAME=VALUE");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

// NAME=VALUE for one input, or VALUE for all of them.
void set_for(CaseFile& file, const std::string& text, const std::string& option,
             const std::string& entry) {
  if (text.find('=') == std::string::npos) {
    for (const auto& [channel, section] : recorded_sections()) {
      file.set(section, entry, text, option);
    }
    return;
  }
  const auto [name, value] = split(text, option);
  file.set(section_of(signals::known_channel(name), option), entry, value, option);
}

void set_column(CaseFile& file, const std::string& text) {
  const auto choice = signals::parse_column_choice(text);
  const std::string section = section_of(choice.channel, "--column");
  file.set(section, "Column", split(text, "--column").second, "--column");
  file.set(section, "Scale", "1", "--column");
}

void set_rows(CaseFile& file, const std::string& text) {
  const auto [name, value] = split(text, "--rows");
  const signals::RowRange range = signals::parse_rows(value, "--rows");
  const std::string section = section_of(signals::known_channel(name), "--rows");
  file.set(section, "First row", std::to_string(range.first), "--rows");
  file.set(section, "Rows", std::to_string(range.count), "--rows");
}

void set_range(CaseFile& file, const std::string& text) {
  auto [name, value] = split(text, "--range");
  const auto colon = value.find(':');
  if (colon == std::string::npos) throw UserError("--range: write NAME=LOW:HIGH");
  value[colon] = ',';
  file.set(section_of(signals::known_channel(name), "--range"), "Range", value, "--range");
}

bool is_recorded(const CaseFile& file, const std::string& channel) {
  const std::string& section = recorded_sections().at(channel);
  return file.get(section.substr(0, section.find('/')), "Kind") == "recorded";
}

// An option for a recording is an error when the run reads no recording.
void refuse_unread(const CaseFile& file, const std::vector<std::string>& texts,
                   const std::string& option) {
  for (const std::string& text : texts) {
    const bool is_for_all = option == "--rate" && text.find('=') == std::string::npos;
    const std::string name = text.substr(0, text.find('='));
    bool is_read = false;
    for (const auto& [channel, section] : recorded_sections())
      is_read = is_read || (is_recorded(file, channel) &&
                            (is_for_all || signals::known_channel(name) == channel));
    if (!is_read)
      throw UserError(option + " " + text +
                      ": this run does not read this recording; give it by --base-acceleration "
                      "FILE or --wind FILE, or leave the option out");
  }
}

/// One replacement of an entry.
struct Setting {
  std::string section, entry, value;
  std::string path() const { return section + "/" + entry; }
};

Setting parse_setting(const std::string& text) {
  const auto [path, value] = split(text, "--set");
  const auto slash = path.rfind('/');
  if (slash == std::string::npos) {
    throw UserError("--set: '" + path + "' has no '/'; write SECTION/ENTRY=VALUE");
  }
  return {path.substr(0, slash), path.substr(slash + 1), value};
}

bool changes_resonances(const Setting& setting) {
  return setting.path().starts_with("Geometry/") || setting.path().starts_with("Materials/") ||
         setting.path() == "Model/Mesh file" || setting.path() == "Transient/Gravity";
}

void set_entries(CaseFile& file, const std::vector<std::string>& texts) {
  bool is_changed = false, is_noted = false;
  for (const std::string& text : texts) {
    const Setting setting = parse_setting(text);
    file.set(setting.section, setting.entry, setting.value, "--set");
    is_noted = is_noted || setting.path() == "Model/Calibration note";
    is_changed = is_changed || changes_resonances(setting);
  }
  if (is_changed && !is_noted) file.set("Model", "Calibration note", "", "--set");
}

void refuse_unused(const CaseUse use, const CaseFile& file, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const std::string reason = why_unused(use, file, parse_setting(text).path());
    if (!reason.empty()) throw UserError("--set " + text + ": " + reason + "; leave it out");
  }
}

}  // namespace

bool CaseOverrides::is_plain() const {
  return !base_acceleration_file && !wind_file && !output_folder && !duration_s &&
         columns.empty() && rates.empty() && rows.empty() && ranges.empty() &&
         remove_means.empty() && settings.empty();
}

CaseFile CaseOverrides::load() const {
  CaseFile file(case_file);
  if (base_acceleration_file) {
    file.set("Base motion", "Kind", "recorded", "--base-acceleration");
    file.set("Base motion/Recorded", "File", *base_acceleration_file, "--base-acceleration");
  }
  if (wind_file) {
    file.set("Wind", "Kind", "recorded", "--wind");
    file.set("Wind/Recorded", "File", *wind_file, "--wind");
  }
  for (const auto& text : columns) set_column(file, text);
  for (const auto& text : rates) set_for(file, text, "--rate", "Sampling rate");
  for (const auto& text : rows) set_rows(file, text);
  for (const auto& text : ranges) set_range(file, text);
  for (const auto& name : remove_means) {
    file.set(section_of(signals::known_channel(name), "--remove-mean"), "Remove mean", "true",
             "--remove-mean");
  }
  if (duration_s) file.set("Records", "Duration", *duration_s, "--duration");
  if (output_folder) file.set("Output", "Folder", *output_folder, "--output");
  set_entries(file, settings);
  if (use) refuse_unused(*use, file, settings);
  refuse_unread(file, columns, "--column");
  refuse_unread(file, rates, "--rate");
  refuse_unread(file, rows, "--rows");
  refuse_unread(file, ranges, "--range");
  refuse_unread(file, remove_means, "--remove-mean");
  return file;
}

}  // namespace vibrissa::sensor_case
