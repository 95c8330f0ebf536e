#include "separation/nonlinear/nonlinear_c_header.h"

#include <cmath>
#include <sstream>

#include "separation/model/c_text.h"
#include "separation/model/mode_step.h"
#include "separation/nonlinear/mode_integrator.h"
#include "signals/base/number_text.h"
#include "signals/system/output_file.h"

namespace vibrissa::separation {

namespace {

// @X stands for what differs from model to model.
constexpr const char* body = R"(#ifndef @NAME_H
#define @NAME_H

#define @NAME_MODES @COUNT
#define @NAME_DELAY @DELAY /* whole samples */

typedef struct {
  float x[@NAME_MODES], v[@NAME_MODES]; /* in units of the largest ones */
  float past[@NAME_DELAY + 1];          /* ring buffer of the inputs */
  float first, last, older;
  int next, seen;
} @NAME_state;

static inline void @NAME_reset(@NAME_state *state) {
  state->next = 0;
  state->seen = 0;
}
@TANH
/* Force of the joint law per modal mass and unit of speed [1/s] */
static inline float @NAME_law(float x, float v) {
  (void)x;
  (void)v;
  return @LAW;
}

/* Rate of the speed of mode k */
static inline float @NAME_rate(int k, float x, float v, float input) {
  static const float gain[@NAME_MODES] = {@GAIN};
  static const float stiffness[@NAME_MODES] = {@STIFFNESS};
  static const float damping[@NAME_MODES] = {@DAMPING};
  float rate = gain[k] * input - stiffness[k] * x - damping[k] * v;
  return k == @MODE ? rate - @NAME_law(x, v) : rate;
}

/* n steps of the classical Runge-Kutta rule with an input along a straight line */
static inline void @NAME_advance(@NAME_state *state, int k, int n, float h, float start,
                                 float end) {
  static const float ratio[@NAME_MODES] = {@RATIO}; /* unit of speed per unit of deflection */
  const float r = ratio[k], slope = (end - start) / (float)n;
  float x = state->x[k], v = state->v[k];
  int i;
  for (i = 0; i < n; ++i) {
    const float u1 = start + (float)i * slope, u2 = u1 + 0.5f * slope, u4 = u1 + slope;
    const float k1 = @NAME_rate(k, x, v, u1);
    const float v2 = v + 0.5f * h * k1;
    const float k2 = @NAME_rate(k, x + 0.5f * h * r * v, v2, u2);
    const float v3 = v + 0.5f * h * k2;
    const float k3 = @NAME_rate(k, x + 0.5f * h * r * v2, v3, u2);
    const float v4 = v + h * k3;
    const float k4 = @NAME_rate(k, x + h * r * v3, v4, u4);
    x += h * r / 6.0f * (v + 2.0f * (v2 + v3) + v4);
    v += h / 6.0f * (k1 + 2.0f * (k2 + k3) + k4);
  }
  if (k == @MODE && !(x < @LIMIT && x > -@LIMIT && v - v == 0.0f)) x = v = 0.0f; /* diverged */
  state->x[k] = x;
  state->v[k] = v;
}

/* Takes one sample of the base acceleration [m/s^2] and returns the base moment of the vibration
   [N m]. The function assumes that the sensor is at rest at the first sample after a reset. */
static inline float @NAME_step(@NAME_state *state, float acceleration) {
  static const float by_x[@NAME_MODES] = {@BYX};
  static const float by_v[@NAME_MODES] = {@BYV};
  float u0, u1, u2, moment;
  int k;
  state->past[state->next] = acceleration;
  state->next = state->next == @NAME_DELAY ? 0 : state->next + 1;
  if (state->seen == 0) state->first = acceleration;
  if (state->seen <= @NAME_DELAY) {
    ++state->seen;
    state->last = state->older = state->first;
    for (k = 0; k < @NAME_MODES; ++k) state->x[k] = state->v[k] = 0.0f;
    return @DIRECT * state->first;
  }
  u0 = state->older;
  u1 = state->last;
  u2 = state->past[state->next];
  (void)u0;
  moment = @DIRECT * (@NOW);
  for (k = 0; k < @NAME_MODES; ++k) {
@PIECES    moment += by_x[k] * state->x[k] + by_v[k] * state->v[k];
  }
@READOUT  state->older = u1;
  state->last = u2;
  return moment;
}

#endif
)";

// tanh by its continued fraction at an eighth of the argument and three times the double angle.
constexpr const char* tanh_function = R"(
static inline float @NAME_tanh(float z) {
  float y, t;
  int i;
  if (z > 9.0f) return 1.0f;
  if (z < -9.0f) return -1.0f;
  z *= 0.125f;
  y = z * z;
  t = z / (1.0f + y / (3.0f + y / (5.0f + y / (7.0f + y / 9.0f))));
  for (i = 0; i < 3; ++i) t = 2.0f * t / (1.0f + t * t);
  return t;
}
)";

struct Units {
  double deflection = 1., speed = 1.;
};

// Of a mode: the largest deflection and speed for the one with the law; a common order of size for
// the others.
Units units_of(const NonlinearBvrm& model, std::size_t k) {
  if (k == model.mode) return {model.largest_deflection_m, model.largest_speed_m_s};
  const double frequency = std::sqrt(model.linear.modes[k].a0);
  return {1. / model.linear.modes[k].a0, 1. / frequency};
}

std::string product(const std::string& factor, int power) {
  std::string text;
  for (int i = 0; i < power; ++i) text += " * " + factor;
  return text;
}

std::string term_in_c(const LawTerm& term, const Units& unit, const std::string& name) {
  const auto scaled = [&](double size) { return c_number(term.coefficient * size / unit.speed); };
  const auto powers = [&](int i, int j) {
    return scaled(std::pow(unit.deflection, i) * std::pow(unit.speed, j)) + product("x", i) +
           product("v", j);
  };
  switch (term.kind) {
    case LawKind::quadratic_stiffness:
      return powers(2, 0);
    case LawKind::cubic_stiffness:
      return powers(3, 0);
    case LawKind::quadratic_damping:
      return powers(0, 2) + " * (v < 0.0f ? -1.0f : 1.0f)";
    case LawKind::friction:
      return scaled(1.) + " * " + name + "_tanh(" + c_number(unit.speed / term.speed_m_s) + " * v)";
    case LawKind::monomial:
      return powers(term.deflection_power, term.velocity_power);
  }
  return {};
}

std::string law_in_c(const NonlinearBvrm& model, const std::string& name) {
  std::string text;
  for (const LawTerm& term : model.law)
    text +=
        (text.empty() ? "" : " +\n         ") + term_in_c(term, units_of(model, model.mode), name);
  return text.empty() ? "0.0f" : text;
}

std::string sum_of_inputs(const InputPath::Knots& weights) {
  std::string text;
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] != 0.)
      text += (text.empty() ? "" : " + ") + (weights[i] == 1. ? "" : c_number(weights[i]) + " * ") +
              "u" + std::to_string(i);
  return text;
}

template <typename Value>
std::string list(const NonlinearBvrm& model, const Value& value) {
  std::string text;
  for (std::size_t k = 0; k < model.linear.modes.size(); ++k)
    text += (k ? ", " : "") + c_number(value(model.linear.modes[k], units_of(model, k)));
  return text;
}

// The steps of each mode over each piece.
std::string pieces_in_c(const NonlinearBvrm& model, const CHeaderOptions& options,
                        const InputPath& path) {
  std::string text;
  for (std::size_t p = 0; p < path.pieces.size(); ++p)
    for (std::size_t k = 0; k < model.linear.modes.size(); ++k) {
      const auto piece =
          ModeIntegrator::steps_of(model.linear.modes[k], options.sampling_rate_hz, path)[p];
      text += "    if (k == " + std::to_string(k) + ")\n      @NAME_advance(state, k, " +
              std::to_string(piece.n_steps) + ", " + c_number(piece.step_s) + ", " +
              sum_of_inputs(piece.start) + ", " + sum_of_inputs(piece.end) + ");\n";
    }
  return text;
}

std::string readout_in_c(const NonlinearBvrm& model) {
  const std::string k = std::to_string(model.mode);
  if (model.readout == LawReadout::deflection || model.law.empty()) return "";
  return "  moment += " + c_number(model.law_gain_kg_m() * units_of(model, model.mode).speed) +
         " * @NAME_law(state->x[" + k + "], state->v[" + k + "]);\n";
}

std::string describe(const NonlinearBvrm& model, const CHeaderOptions& options) {
  std::ostringstream text;
  text << begin_of_comment("Nonlinear base vibration response model", model.linear, options);
  for (const LawTerm& term : model.law)
    text << "   law of mode " << model.mode + 1 << ": " << term.name() << ", "
         << signals::to_text(term.coefficient) << " " << term.unit() << "\n";
  text << "   fitted to a deflection of " << signals::to_text(model.largest_deflection_m)
       << " m and a speed of " << signals::to_text(model.largest_speed_m_s) << " m/s */\n";
  return text.str();
}

bool has_friction(const NonlinearBvrm& model) {
  for (const LawTerm& term : model.law)
    if (term.kind == LawKind::friction) return true;
  return false;
}

}  // namespace

std::string nonlinear_c_header(const NonlinearBvrm& model, const CHeaderOptions& options) {
  check(model.linear, options);
  check(model);
  const SampledDelay delay = sampled_delay(model.linear.delay_s, options.sampling_rate_hz);
  const InputPath path(options.hold, delay.fraction);
  std::string text = body;
  replace_all(text, "@COUNT", std::to_string(model.linear.modes.size()));
  replace_all(text, "@TANH", has_friction(model) ? tanh_function : "");
  replace_all(text, "@LAW", law_in_c(model, options.name));
  replace_all(text, "@DELAY", std::to_string(delay.shift));
  replace_all(text, "@GAIN",
              list(model, [](const ModalTerm&, const Units& unit) { return 1. / unit.speed; }));
  replace_all(text, "@STIFFNESS", list(model, [](const ModalTerm& mode, const Units& unit) {
                return mode.a0 * unit.deflection / unit.speed;
              }));
  replace_all(text, "@DAMPING",
              list(model, [](const ModalTerm& mode, const Units&) { return mode.a1; }));
  replace_all(text, "@RATIO", list(model, [](const ModalTerm&, const Units& unit) {
                return unit.speed / unit.deflection;
              }));
  replace_all(text, "@BYX", list(model, [](const ModalTerm& mode, const Units& unit) {
                return mode.b0 * unit.deflection;
              }));
  replace_all(text, "@BYV", list(model, [](const ModalTerm& mode, const Units& unit) {
                return mode.b1 * unit.speed;
              }));
  replace_all(text, "@DIRECT", c_number(model.linear.direct_term_kg_m));
  replace_all(text, "@NOW", sum_of_inputs(path.direct));
  replace_all(text, "@PIECES", pieces_in_c(model, options, path));
  replace_all(text, "@READOUT", readout_in_c(model));
  replace_all(text, "@LIMIT", c_number(diverged_in_largest_deflections));
  replace_all(text, "@MODE", std::to_string(model.mode));
  replace_all(text, "@NAME", options.name);
  return describe(model, options) + text;
}

void write_nonlinear_c_header(const std::filesystem::path& file, const NonlinearBvrm& model,
                              const CHeaderOptions& options) {
  const std::string text = nonlinear_c_header(model, options);
  signals::write_file(file, [&](std::ostream& out) { out << text; });
}

}  // namespace vibrissa::separation
