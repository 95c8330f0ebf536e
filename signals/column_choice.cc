#include "signals/column_choice.h"

#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "signals/channel_name.h"
#include "signals/error.h"
#include "signals/number_text.h"
#include "signals/trimmed.h"
#include "signals/unit.h"

namespace vibrissa::signals {
namespace {

[[noreturn]] void refuse(const std::string& choice, const std::string& reason) {
  throw UserError("column choice '" + choice + "': " + reason);
}

// A name or a number, and the unit in brackets behind it.
struct Quantity {
  std::string text;
  std::optional<std::string> unit;
};

Quantity quantity_of(const std::string& text) {
  const std::string all(trimmed(text));
  const auto open = all.rfind('[');
  if (open == std::string::npos || !all.ends_with(']')) return {all, {}};
  return {std::string(trimmed(std::string_view(all).substr(0, open))),
          all.substr(open + 1, all.size() - open - 2)};
}

// Where the last '*' outside brackets stands.
std::size_t last_star(const std::string& text) {
  int depth = 0;
  for (std::size_t i = text.size(); i-- > 0;) {
    if (text[i] == ']') ++depth;
    if (text[i] == '[' && depth > 0) --depth;
    if (text[i] == '*' && depth == 0) return i;
  }
  return std::string::npos;
}

struct Factor {
  double value;
  std::optional<std::string> unit;
};

std::optional<Factor> factor_of(const std::string& text) {
  const Quantity quantity = quantity_of(text);
  const std::optional<double> value = to_number(quantity.text);
  if (!value) return {};
  return Factor{*value, quantity.unit};
}

// Takes the factors off the end of the text, the last one first.
std::vector<Factor> take_factors(std::string& text, const std::string& choice) {
  std::vector<Factor> factors;
  for (;;) {
    const std::size_t star = last_star(text);
    if (star == std::string::npos) return factors;
    const auto factor = factor_of(text.substr(star + 1));
    if (!factor && !factors.empty()) return factors;  // a star in the column's own name
    if (!factor || !std::isfinite(factor->value) || factor->value == 0.)
      refuse(choice, "the scale '" + std::string(trimmed(std::string_view(text).substr(star + 1))) +
                         "' must be a finite number other than 0");
    factors.push_back(*factor);
    text.erase(star);
  }
}

void convert(ColumnChoice& choice, const std::string& units, const std::string& text) {
  const std::string needed = unit_of_channel(choice.channel);
  try {
    const UnitConversion conversion = convert_unit(units, needed);
    choice.scale *= conversion.scale;
    choice.offset = conversion.offset;
  } catch (const UserError& error) {
    refuse(text, std::string(error.what()) + ". The channel is in " + needed +
                     "; a factor can bring its own unit, as in base_moment=B[uT]*0.18[N m/T]");
  }
}

}  // namespace

ColumnChoice parse_column_choice(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos)
    refuse(text, "expected channel=column, channel=column[unit] or channel=column*scale");
  const std::string name(trimmed(std::string_view(text).substr(0, equals)));
  ColumnChoice choice;
  choice.channel = full_channel_name(name);
  if (choice.channel.empty()) refuse(text, unknown_name("channel", name, known_channels()));
  std::string rest = text.substr(equals + 1);
  const std::vector<Factor> factors = take_factors(rest, text);
  const Quantity column = quantity_of(rest);
  choice.column = column.text;
  if (choice.column.empty()) refuse(text, "the name of the column is missing after '='");
  if (column.unit) choice.column_with_unit = trimmed(rest);
  std::string units = column.unit ? "(" + *column.unit + ")" : "";
  for (const Factor& factor : factors) {
    choice.scale *= factor.value;
    if (factor.unit) units.append(units.empty() ? "" : ".").append("(" + *factor.unit + ")");
  }
  if (!units.empty()) convert(choice, units, text);
  return choice;
}

}  // namespace vibrissa::signals
