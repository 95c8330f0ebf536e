#include "signals/base/scaled_name.h"

#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/trimmed.h"
#include "signals/base/unit.h"

namespace vibrissa::signals {
namespace {

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

bool can_scale(const double factor) {
  return std::isfinite(factor) && factor != 0.;
}

// Takes the factors off the end of the text, the last one first.
std::vector<Factor> take_factors(std::string& text) {
  std::vector<Factor> factors;
  for (;;) {
    const std::size_t star = last_star(text);
    if (star == std::string::npos) return factors;
    const auto factor = factor_of(text.substr(star + 1));
    if (!factor && !factors.empty()) return factors;  // a star in the column's own name
    if (!factor || !can_scale(factor->value))
      throw UserError("the scale '" +
                      std::string(trimmed(std::string_view(text).substr(star + 1))) +
                      "' must be a finite number other than 0");
    factors.push_back(*factor);
    text.erase(star);
  }
}

}  // namespace

ScaledName parse_scaled_name(const std::string& text, const std::string& needed_unit) {
  std::string rest = text;
  const std::vector<Factor> factors = take_factors(rest);
  const Quantity quantity = quantity_of(rest);
  ScaledName found{.name = quantity.text};
  if (quantity.unit) found.name_with_unit = trimmed(rest);
  std::string units = quantity.unit ? "(" + *quantity.unit + ")" : "";
  for (const Factor& factor : factors) {
    found.scale *= factor.value;
    if (factor.unit) units.append(units.empty() ? "" : ".").append("(" + *factor.unit + ")");
  }
  if (!units.empty()) {
    const UnitConversion conversion = convert_unit(units, needed_unit);
    found.scale *= conversion.scale;
    found.offset = conversion.offset;
    found.has_unit = true;
  }
  if (!can_scale(found.scale))
    throw UserError("the product of the factors is " + to_text(found.scale) +
                    "; it must be a finite number other than 0");
  return found;
}

}  // namespace vibrissa::signals
