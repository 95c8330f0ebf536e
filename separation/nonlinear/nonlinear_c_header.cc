#include "separation/nonlinear/nonlinear_c_header.h"

#include <cmath>
#include <sstream>

#include "separation/model/c_text.h"
#include "separation/model/input_shaper.h"
#include "separation/model/mode_step.h"
#include "separation/nonlinear/mode_integrator.h"
#include "separation/nonlinear/nonlinear_c_text.h"
#include "signals/base/number_text.h"
#include "signals/system/output_file.h"

namespace vibrissa::separation {

namespace {

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

std::string taps_in_c(const std::vector<double>& taps) {
  std::string text;
  for (std::size_t j = 0; j < taps.size(); ++j) text += (j ? ", " : "") + c_number(taps[j]);
  return text;
}

/// State and step of the hold, and what they need.
void replace_step(std::string& text, const CHeaderOptions& options, const SampledDelay& delay,
                  const InputPath& path) {
  const bool is_shaped = options.hold == Hold::band_limited;
  replace_all(text, "@STATE", is_shaped ? c_shaped_state : c_held_state);
  replace_all(text, "@STEP", is_shaped ? c_shaped_step : c_held_step);
  replace_all(text, "@LAG", std::to_string(is_shaped ? InputShaper::half_length : 0));
  if (!is_shaped) {
    replace_all(text, "@NOW", sum_of_inputs(path.direct));
    return;
  }
  const InputShaper shaper(options.hold, delay.fraction);
  const std::vector<double>& direct = shaper.direct_taps();
  replace_all(text, "@NODE", taps_in_c(shaper.node_taps()));
  replace_all(text, "@MIDPOINT", taps_in_c(shaper.midpoint_taps()));
  replace_all(text, "@DIRECTTAPS",
              direct.empty()
                  ? ""
                  : "  static const float direct_tap[@NAME_TAPS] = {" + taps_in_c(direct) + "};\n");
  replace_all(text, "@NOW",
              direct.empty() ? "state->past[(state->next + @NAME_LAG) % @NAME_TAPS]"
                             : "@NAME_shaped(state, direct_tap)");
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
  const InputPath path(options.hold, options.hold == Hold::band_limited ? 0. : delay.fraction);
  std::string text = c_body;
  replace_step(text, options, delay, path);
  replace_all(text, "@COUNT", std::to_string(model.linear.modes.size()));
  replace_all(text, "@TANH", has_friction(model) ? c_tanh : "");
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
