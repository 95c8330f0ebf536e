#include "separation/nonlinear/joint_law.h"

#include <array>
#include <cmath>
#include <utility>

#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

const std::array<std::pair<LawKind, std::string>, 5> kind_names{
    {{LawKind::quadratic_stiffness, "quadratic_stiffness"},
     {LawKind::cubic_stiffness, "cubic_stiffness"},
     {LawKind::quadratic_damping, "quadratic_damping"},
     {LawKind::friction, "friction"},
     {LawKind::monomial, "monomial"}}};

constexpr int highest_power = 9;

double power(double base, int exponent) {
  double product = 1.;
  for (int i = 0; i < exponent; ++i) product *= base;
  return product;
}

double power_slope(double base, int exponent) {
  return exponent == 0 ? 0. : exponent * power(base, exponent - 1);
}

LawValue monomial(int i, int j, double x, double v) {
  return {.value = power(x, i) * power(v, j),
          .by_deflection = power_slope(x, i) * power(v, j),
          .by_velocity = power(x, i) * power_slope(v, j)};
}

// Powers of metre and second of the function.
std::pair<int, int> dimension(const LawTerm& term) {
  switch (term.kind) {
    case LawKind::quadratic_stiffness:
      return {2, 0};
    case LawKind::cubic_stiffness:
      return {3, 0};
    case LawKind::quadratic_damping:
      return {2, -2};
    case LawKind::friction:
      return {0, 0};
    case LawKind::monomial:
      return {term.deflection_power + term.velocity_power, -term.velocity_power};
  }
  return {};
}

}  // namespace

std::string to_string(LawKind kind) {
  for (const auto& [value, name] : kind_names)
    if (value == kind) return name;
  return {};
}

LawKind parse_law_kind(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [value, text] : kind_names) {
    if (text == name) return value;
    known.push_back(text);
  }
  throw signals::UserError(signals::unknown_name("joint law", name, known));
}

std::string LawTerm::name() const {
  if (kind != LawKind::monomial) return to_string(kind);
  return "x^" + std::to_string(deflection_power) + " x'^" + std::to_string(velocity_power);
}

std::string LawTerm::unit() const {
  const auto [metres, seconds] = dimension(*this);
  const auto factor = [](const std::string& unit, int exponent) {
    if (exponent == 0) return std::string();
    return exponent == 1 ? unit : unit + "^" + std::to_string(exponent);
  };
  const std::string metre = factor("m", 1 - metres), second = factor("s", -2 - seconds);
  if (metre.empty() && second.empty()) return "1";
  return metre + (metre.empty() || second.empty() ? "" : " ") + second;
}

LawValue law_function(const LawTerm& term, double x, double v) {
  switch (term.kind) {
    case LawKind::quadratic_stiffness:
      return {.value = x * x, .by_deflection = 2. * x, .by_velocity = 0.};
    case LawKind::cubic_stiffness:
      return {.value = x * x * x, .by_deflection = 3. * x * x, .by_velocity = 0.};
    case LawKind::quadratic_damping:
      return {.value = v * std::abs(v), .by_deflection = 0., .by_velocity = 2. * std::abs(v)};
    case LawKind::friction: {
      const double share = std::tanh(v / term.speed_m_s);
      return {.value = share,
              .by_deflection = 0.,
              .by_velocity = (1. - share * share) / term.speed_m_s};
    }
    case LawKind::monomial:
      return monomial(term.deflection_power, term.velocity_power, x, v);
  }
  return {};
}

void check(std::span<const LawTerm> law) {
  for (std::size_t k = 0; k < law.size(); ++k) {
    const LawTerm& term = law[k];
    const auto refuse = [&](const std::string& what) {
      throw signals::UserError("joint law, term " + std::to_string(k + 1) + " (" + term.name() +
                               "): " + what);
    };
    if (!std::isfinite(term.coefficient)) refuse("the coefficient is not finite");
    if (term.kind == LawKind::friction && !(std::isfinite(term.speed_m_s) && term.speed_m_s > 0.))
      refuse("its speed must be positive and finite");
    const int i = term.deflection_power, j = term.velocity_power;
    if (term.kind == LawKind::monomial &&
        (i < 0 || j < 0 || i + j < 1 || i > highest_power || j > highest_power))
      refuse("its powers must be 0 to " + std::to_string(highest_power) + ", not both 0");
  }
}

}  // namespace vibrissa::separation
