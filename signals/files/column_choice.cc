#include "signals/files/column_choice.h"

#include <exception>
#include <string_view>

#include "signals/base/error.h"
#include "signals/base/scaled_name.h"
#include "signals/base/trimmed.h"
#include "signals/base/unit.h"
#include "signals/record/channel_name.h"

namespace vibrissa::signals {
namespace {

[[noreturn]] void refuse(const std::string& choice, const std::string& reason) {
  throw UserError("column choice '" + choice + "': " + reason);
}

/// What is wrong with the text behind '='; empty: nothing.
std::string refusal_of(const std::string& choice, const std::string& needed_unit,
                       const std::exception& error, const bool is_of_unit) {
  std::string text = "column choice '" + choice + "': " + error.what();
  if (is_of_unit)
    text += ". The channel is in " + needed_unit +
            "; a factor may have a unit, as in base_moment=B[uT]*0.18[N m/T]";
  return text;
}

void take(const ScaledName& name, ColumnChoice& choice) {
  choice.column = name.name;
  choice.scale = name.scale;
  choice.offset = name.offset;
  choice.column_with_unit = name.name_with_unit;
  choice.has_unit = name.has_unit;
  choice.unit = name.unit;
  choice.has_factor = name.has_factor;
}

}  // namespace

ColumnChoice parse_column_choice(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos)
    refuse(text, "write channel=column, channel=column[unit] or channel=column*scale");
  const std::string name(trimmed(std::string_view(text).substr(0, equals)));
  const std::string channel = full_channel_name(name);
  if (channel.empty()) refuse(text, unknown_name("channel", name, known_channels()));
  ColumnChoice choice{.channel = channel, .text = std::string(trimmed(text.substr(equals + 1)))};
  const std::string needed_unit = unit_of_channel(channel);
  try {
    take(parse_scaled_name(choice.text, needed_unit), choice);
  } catch (const UnitError& error) {
    choice.refusal = refusal_of(text, needed_unit, error, true);
  } catch (const UserError& error) {
    choice.refusal = refusal_of(text, needed_unit, error, false);
  }
  if (!choice.refusal.empty()) take(split_scaled_name(choice.text), choice);
  if (choice.column.empty()) refuse(text, "the name of the column is missing after '='");
  return choice;
}

ColumnChoice choice_in_file(const ColumnChoice& choice, const std::vector<std::string>& columns) {
  if (choice.text.empty()) return choice;
  const auto name = name_as_it_stands(choice.text, unit_of_channel(choice.channel), columns);
  if (!name) {
    if (!choice.refusal.empty()) throw UserError(choice.refusal);
    return choice;
  }
  ColumnChoice found{.channel = choice.channel, .text = choice.text};
  take(*name, found);
  return found;
}

}  // namespace vibrissa::signals
