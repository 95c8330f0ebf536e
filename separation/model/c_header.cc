#include "separation/model/c_header.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>
#include <vector>

#include "separation/model/c_text.h"
#include "separation/model/mode_step.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/system/output_file.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

// One mode: its share of the moment is C s, then s becomes A s + (u, 0). A mode at rest at the
// first sample has s = second * u[0] at the second.
struct Section {
  std::array<double, 4> a{};  // by rows
  std::array<double, 2> c{};
  std::array<double, 2> second{};
};

struct SampledModel {
  std::vector<Section> sections;
  double now = 0., last = 0.;  // factors of the newest input and of the one before
  bool between = false;        // sections take the input before the newest
};

// State matrix with these characteristic coefficients, and the output row that gives
// (k1 z + k2) / (z^2 + pole1 z + pole2) for an input to the first state.
Section realise(double pole1, double pole2, double k1, double k2) {
  const double centre = -0.5 * pole1, square = centre * centre - pole2;
  const double reach = std::sqrt(std::abs(square));
  if (square < 0.)
    return {.a = {centre, -reach, reach, centre}, .c = {k1, (k2 + k1 * centre) / reach}};
  return {.a = {centre + reach, 0., 1., centre - reach}, .c = {k1, k2 + k1 * (centre - reach)}};
}

// The state whose free response begins with these two numbers.
std::array<double, 2> state_of(const Section& s, double first, double second) {
  const std::array<double, 2> next{s.c[0] * s.a[0] + s.c[1] * s.a[2],
                                   s.c[0] * s.a[1] + s.c[1] * s.a[3]};
  const double determinant = s.c[0] * next[1] - s.c[1] * next[0];
  if (determinant == 0.) return {};
  return {(first * next[1] - s.c[1] * second) / determinant,
          (s.c[0] * second - next[0] * first) / determinant};
}

Section add_mode(const ModalTerm& mode, const ModeStep& step, bool between, SampledModel& model) {
  std::array<double, 4> tap;
  for (std::size_t j = 0; j < tap.size(); ++j)
    tap[j] = mode.b1 * step.b1_taps[j].value + mode.b0 * step.b0_taps[j].value;
  std::array<double, 3> rest;
  for (std::size_t j = 0; j < rest.size(); ++j)
    rest[j] = mode.b1 * step.b1_rest[j].value + mode.b0 * step.b0_rest[j].value;
  const double p1 = step.pole1.value, p2 = step.pole2.value;
  // Long division by the poles, one tap at a time.
  model.now += tap[0];
  std::array<double, 3> left{tap[1] - p1 * tap[0], tap[2] - p2 * tap[0], tap[3]};
  if (between) {
    model.last += left[0];
    left = {left[1] - p1 * left[0], left[2] - p2 * left[0], 0.};
  }
  Section section = realise(p1, p2, left[0], left[1]);
  // Where outputs lie between the samples, the free response begins at the second.
  if (between) {
    section.second = state_of(section, rest[1], rest[2] - p1 * rest[1]);
  } else {
    const auto [s0, s1] = state_of(section, rest[0], rest[1] - p1 * rest[0]);
    section.second = {section.a[0] * s0 + section.a[1] * s1 + 1.,
                      section.a[2] * s0 + section.a[3] * s1};
  }
  return section;
}

SampledModel sample(const Bvrm& bvrm, double rate_hz, Hold hold) {
  const SampledDelay delay = sampled_delay(bvrm.delay_s, rate_hz);
  const bool between = delay.fraction > 0.;
  SampledModel model;
  model.between = between;
  const double older = !between ? 0. : hold == Hold::zero_order ? 1. : delay.fraction;
  model.now = (1. - older) * bvrm.direct_term_kg_m;
  model.last = older * bvrm.direct_term_kg_m;
  for (const ModalTerm& mode : bvrm.modes) {
    const ModeStep step(mode.a1, mode.a0, rate_hz, hold, delay.fraction);
    model.sections.push_back(add_mode(mode, step, between, model));
  }
  return model;
}

template <std::size_t n>
std::string list(const std::array<double, n>& values) {
  std::string text = "{";
  for (std::size_t i = 0; i < n; ++i) text += (i ? ", " : "") + c_number(values[i]);
  return text + "}";
}

// @X stands for what differs from model to model.
constexpr const char* body = R"(#ifndef @NAME_H
#define @NAME_H

#define @NAME_SECTIONS @COUNT
#define @NAME_DELAY @DELAY /* whole samples */

typedef struct {
  float s[@NAME_SECTIONS][2];
  float past[@NAME_DELAY + 1]; /* ring buffer of the inputs */
  float first, last;
  int next, seen;
} @NAME_state;

static inline void @NAME_reset(@NAME_state *state) {
  state->next = 0;
  state->seen = 0;
}

/* Takes one sample of the base acceleration [m/s^2] and returns the base moment of the vibration
   [N m]. The function assumes that the sensor is at rest at the first sample after a reset. */
static inline float @NAME_step(@NAME_state *state, float acceleration) {
  static const float a[@NAME_SECTIONS][4] = {@A};
  static const float c[@NAME_SECTIONS][2] = {@C};
  static const float second[@NAME_SECTIONS][2] = {@SECOND};
  float newest, moment, drive;
  int k;
  state->past[state->next] = acceleration;
  state->next = state->next == @NAME_DELAY ? 0 : state->next + 1;
  if (state->seen == 0) state->first = acceleration;
  if (state->seen <= @NAME_DELAY) {
    ++state->seen;
    state->last = state->first;
    for (k = 0; k < @NAME_SECTIONS; ++k) {
      state->s[k][0] = second[k][0] * state->first;
      state->s[k][1] = second[k][1] * state->first;
    }
    return @DIRECT * state->first;
  }
  newest = state->past[state->next];
  moment = @NOW * newest + @LAST * state->last;
  drive = @DRIVE;
  for (k = 0; k < @NAME_SECTIONS; ++k) {
    float *s = state->s[k], s0 = s[0], s1 = s[1];
    moment += c[k][0] * s0 + c[k][1] * s1;
    s[0] += (a[k][0] * s0 + a[k][1] * s1) + drive;
    s[1] += a[k][2] * s0 + a[k][3] * s1;
  }
  state->last = newest;
  return moment;
}

#endif
)";

// A - 1: what a state changes by from sample to sample, which single precision represents much
// better than a factor near one.
std::array<double, 4> change(const Section& section) {
  const auto& a = section.a;
  return {a[0] - 1., a[1], a[2], a[3] - 1.};
}

template <typename Part>
std::string table(const std::vector<Section>& sections, const Part& part) {
  std::string text;
  for (std::size_t k = 0; k < sections.size(); ++k)
    text += (k ? ", " : "") + list(part(sections[k]));
  return text;
}

}  // namespace

std::string begin_of_comment(const std::string& what, const Bvrm& model,
                             const CHeaderOptions& options) {
  std::ostringstream text;
  text << "/* " << what << " of an airflow sensor at " << signals::to_text(options.sampling_rate_hz)
       << " Hz, " << to_string(options.hold) << " hold, delay " << signals::to_text(model.delay_s)
       << " s.\n";
  for (const ModalTerm& mode : model.modes)
    text << "   mode: " << signals::to_text(mode.frequency_hz()) << " Hz, damping ratio "
         << signals::to_text(mode.damping_ratio()) << ", static gain "
         << signals::to_text(mode.static_gain_kg_m()) << " kg m\n";
  return text.str();
}

void check(const Bvrm& model, const CHeaderOptions& options) {
  check(model);
  if (!(options.sampling_rate_hz > 0.) || !std::isfinite(options.sampling_rate_hz))
    throw UserError("C header: the sampling rate " + signals::to_text(options.sampling_rate_hz) +
                    " Hz is not positive and finite");
  if (sampled_delay(model.delay_s, options.sampling_rate_hz).shift < 0)
    throw UserError("C header: the moment leads the acceleration by " +
                    signals::to_text(-model.delay_s) +
                    " s, but a filter in real time cannot look ahead; delay the moment instead");
  if (model.modes.empty()) throw UserError("C header: the model has no mode");
  const auto is_word = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
  if (options.name.empty() || std::isdigit(static_cast<unsigned char>(options.name[0])) ||
      !std::ranges::all_of(options.name, is_word))
    throw UserError("C header: the name \"" + options.name + "\" is not a C identifier");
}

std::string c_header(const Bvrm& model, const CHeaderOptions& options) {
  check(model, options);
  if (options.hold == Hold::band_limited)
    throw UserError(
        "C header: the hold band_limited needs future samples; take first_order or zero_order");
  const SampledModel sampled = sample(model, options.sampling_rate_hz, options.hold);
  const auto& sections = sampled.sections;
  std::string text = body;
  replace_all(text, "@COUNT", std::to_string(sections.size()));
  replace_all(text, "@DELAY",
              std::to_string(sampled_delay(model.delay_s, options.sampling_rate_hz).shift));
  replace_all(text, "@A", table(sections, change));
  replace_all(text, "@C", table(sections, [](const Section& s) { return s.c; }));
  replace_all(text, "@SECOND", table(sections, [](const Section& s) { return s.second; }));
  replace_all(text, "@DIRECT", c_number(model.direct_term_kg_m));
  replace_all(text, "@NOW", c_number(sampled.now));
  replace_all(text, "@LAST", c_number(sampled.last));
  replace_all(text, "@DRIVE", sampled.between ? "state->last" : "newest");
  replace_all(text, "@NAME", options.name);
  return begin_of_comment("Base vibration response model", model, options) +
         "   direct term: " + signals::to_text(model.direct_term_kg_m) + " kg m */\n" + text;
}

void write_c_header(const std::filesystem::path& file, const Bvrm& model,
                    const CHeaderOptions& options) {
  const std::string text = c_header(model, options);
  signals::write_file(file, [&](std::ostream& out) { out << text; });
}

}  // namespace vibrissa::separation
