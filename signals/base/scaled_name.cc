#include "signals/base/scaled_name.h"

#include <algorithm>
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

// Takes the last factor off the end of the text; nothing where the text has no more of them.
std::optional<Factor> take_factor(std::string& text, const bool is_last) {
  const std::size_t star = last_star(text);
  if (star == std::string::npos) return {};
  const auto factor = factor_of(text.substr(star + 1));
  if (!factor && !is_last) return {};  // a star in the column's own name
  if (!factor || !can_scale(factor->value))
    throw UserError("the scale '" + std::string(trimmed(std::string_view(text).substr(star + 1))) +
                    "' must be a finite number other than 0");
  text.erase(star);
  return factor;
}

void convert(const std::string& units, const std::string& needed_unit, ScaledName& name) {
  const UnitConversion conversion = convert_unit(units, needed_unit);
  name.scale *= conversion.scale;
  name.offset = conversion.offset;
  name.has_unit = true;
}

std::string product_of_units(const std::optional<std::string>& first,
                             const std::vector<Factor>& factors) {
  std::string units = first ? "(" + *first + ")" : "";
  for (const Factor& factor : factors)
    if (factor.unit) units.append(units.empty() ? "" : ".").append("(" + *factor.unit + ")");
  return units;
}

// The name with its factors, before units are converted.
ScaledName unconverted(const std::string& rest, const Quantity& quantity,
                       const std::vector<Factor>& factors) {
  ScaledName found{
      .name = quantity.text, .unit = quantity.unit.value_or(""), .has_factor = !factors.empty()};
  if (quantity.unit) found.name_with_unit = trimmed(rest);
  for (const Factor& factor : factors) found.scale *= factor.value;
  return found;
}

void check_scale(const ScaledName& name) {
  if (!can_scale(name.scale))
    throw UserError("the product of the factors is " + to_text(name.scale) +
                    "; it must be a finite number other than 0");
}

}  // namespace

ScaledName parse_scaled_name(const std::string& text, const std::string& needed_unit) {
  std::string rest = text;
  std::vector<Factor> factors;
  while (const auto factor = take_factor(rest, factors.empty())) factors.push_back(*factor);
  const Quantity quantity = quantity_of(rest);
  ScaledName found = unconverted(rest, quantity, factors);
  const std::string units = product_of_units(quantity.unit, factors);
  if (!units.empty()) convert(units, needed_unit, found);
  check_scale(found);
  return found;
}

ScaledName split_scaled_name(const std::string& text) {
  std::string rest = text;
  for (std::size_t star = last_star(rest);
       star != std::string::npos && factor_of(rest.substr(star + 1)); star = last_star(rest))
    rest.erase(star);
  ScaledName found = unconverted(rest, quantity_of(rest), {});
  found.has_factor = rest.size() < text.size();
  return found;
}

std::optional<ScaledName> name_as_it_stands(const std::string& text, const std::string& needed_unit,
                                            const std::vector<std::string>& names) {
  std::string rest(trimmed(text));
  std::vector<Factor> factors;
  while (std::ranges::find(names, rest) == names.end()) {
    const std::size_t star = last_star(rest);
    const auto factor = star == std::string::npos ? std::nullopt : factor_of(rest.substr(star + 1));
    if (!factor) return {};
    factors.push_back(*factor);
    rest = std::string(trimmed(std::string_view(rest).substr(0, star)));
  }
  const Quantity quantity = quantity_of(rest);
  ScaledName found = unconverted(rest, quantity, factors);
  found.name = rest;
  const auto converts = [&](const std::string& units) {
    try {
      if (!units.empty()) convert(units, needed_unit, found);
      return true;
    } catch (const UnitError&) {
      return false;
    }
  };
  if (!converts(product_of_units(quantity.unit, factors))) {
    found.name_with_unit.clear();
    found.unit.clear();
    if (!converts(product_of_units({}, factors))) return {};
  }
  return can_scale(found.scale) ? std::optional(found) : std::nullopt;
}

}  // namespace vibrissa::signals
