#include "signals/files/column_choice.h"

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

ScaledName scaled_column(const std::string& column, const std::string& needed_unit,
                         const std::string& choice) {
  try {
    return parse_scaled_name(column, needed_unit);
  } catch (const UnitError& error) {
    refuse(choice, std::string(error.what()) + ". The channel is in " + needed_unit +
                       "; a factor may have a unit, as in base_moment=B[uT]*0.18[N m/T]");
  } catch (const UserError& error) {
    refuse(choice, error.what());
  }
}

}  // namespace

ColumnChoice parse_column_choice(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos)
    refuse(text, "write channel=column, channel=column[unit] or channel=column*scale");
  const std::string name(trimmed(std::string_view(text).substr(0, equals)));
  const std::string channel = full_channel_name(name);
  if (channel.empty()) refuse(text, unknown_name("channel", name, known_channels()));
  const ScaledName column = scaled_column(text.substr(equals + 1), unit_of_channel(channel), text);
  if (column.name.empty()) refuse(text, "the name of the column is missing after '='");
  return {channel,       column.name,           column.scale,
          column.offset, column.name_with_unit, column.has_unit};
}

}  // namespace vibrissa::signals
