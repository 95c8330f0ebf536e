#pragma once

namespace vibrissa::separation {

// @X stands for what differs from model to model.
inline constexpr const char* c_body = R"(#ifndef @NAME_H
#define @NAME_H

#define @NAME_MODES @COUNT
#define @NAME_DELAY @DELAY /* whole samples */
#define @NAME_LAG @LAG /* samples by which the returned moment is older than the acceleration */
@STATE@TANH
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

@STEP
#endif
)";

// tanh by its continued fraction at an eighth of the argument and three times the double angle.
inline constexpr const char* c_tanh = R"(
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

// Held inputs: the ring holds back whole samples of delay.
inline constexpr const char* c_held_state = R"(
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
)";
inline constexpr const char* c_held_step =
    R"(/* Takes one sample of the base acceleration [m/s^2] and returns the base moment of the vibration
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
)";

// Band-limited inputs: the filters of the InputShaper on a ring of the last inputs; whole samples
// of delay on the moments, as the BankSeparator does.
inline constexpr const char* c_shaped_state = R"(
#define @NAME_TAPS (2 * @NAME_LAG + 1)

typedef struct {
  float x[@NAME_MODES], v[@NAME_MODES]; /* in units of the largest ones */
  float past[@NAME_TAPS];               /* ring buffer of the inputs */
  float late[@NAME_DELAY + 1];          /* ring buffer of the moments */
  float node, midpoint;                 /* of the step before */
  int next, due, seen;
} @NAME_state;

static inline void @NAME_reset(@NAME_state *state) {
  state->next = 0;
  state->due = 0;
  state->seen = 0;
}
)";
inline constexpr const char* c_shaped_step =
    R"(/* Input @NAME_LAG samples ago, filtered; the ring begins with the oldest one */
static inline float @NAME_shaped(const @NAME_state *state, const float *tap) {
  float sum = 0.0f;
  int j, at = state->next;
  for (j = 0; j < @NAME_TAPS; ++j) {
    sum += tap[j] * state->past[at];
    at = at + 1 == @NAME_TAPS ? 0 : at + 1;
  }
  return sum;
}

/* Takes one sample of the base acceleration [m/s^2] and returns the base moment of the vibration
   [N m] @NAME_LAG samples ago; 0 for the first @NAME_LAG samples. Compare it with the measured moment
   of that time. The function assumes that the sensor is at rest at the first sample after a reset
   and that the acceleration has been constant before. */
static inline float @NAME_step(@NAME_state *state, float acceleration) {
  static const float by_x[@NAME_MODES] = {@BYX};
  static const float by_v[@NAME_MODES] = {@BYV};
  static const float node_tap[@NAME_TAPS] = {@NODE};
  static const float midpoint_tap[@NAME_TAPS] = {@MIDPOINT};
@DIRECTTAPS  const float u0 = state->node, u1 = state->midpoint;
  float u2, moment;
  int k;
  if (state->seen == 0)
    for (k = 0; k < @NAME_TAPS; ++k) state->past[k] = acceleration;
  state->past[state->next] = acceleration;
  state->next = state->next + 1 == @NAME_TAPS ? 0 : state->next + 1;
  if (state->seen < @NAME_LAG) {
    ++state->seen;
    return 0.0f;
  }
  u2 = state->node = @NAME_shaped(state, node_tap);
  state->midpoint = @NAME_shaped(state, midpoint_tap);
  moment = @DIRECT * @NOW;
  if (state->seen == @NAME_LAG) {
    ++state->seen;
    for (k = 0; k < @NAME_MODES; ++k) state->x[k] = state->v[k] = 0.0f;
    for (k = 0; k <= @NAME_DELAY; ++k) state->late[k] = moment;
    return moment;
  }
  for (k = 0; k < @NAME_MODES; ++k) {
@PIECES    moment += by_x[k] * state->x[k] + by_v[k] * state->v[k];
  }
@READOUT  state->late[state->due] = moment;
  state->due = state->due == @NAME_DELAY ? 0 : state->due + 1;
  return state->late[state->due];
}
)";

}  // namespace vibrissa::separation
