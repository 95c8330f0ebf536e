#include "separation/model/modal_bank.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vibrissa::separation {

namespace {

template <std::size_t n>
std::array<double, n> numerator(const ModalTerm& term, const std::array<Sensitive, n>& b1,
                                const std::array<Sensitive, n>& b0) {
  std::array<double, n> taps;
  for (std::size_t j = 0; j < n; ++j) taps[j] = term.b1 * b1[j].value + term.b0 * b0[j].value;
  return taps;
}

// During long silence the state would become subnormal, which is slow.
constexpr double negligible = 1e-280;

template <std::size_t size>
void keep_history(std::array<double, size>& memory, std::size_t history, std::size_t n) {
  for (std::size_t j = 0; j < history; ++j) {
    const double kept = memory[n + j];
    memory[j] = std::abs(kept) < negligible ? 0. : kept;
  }
}

}  // namespace

ModalBank::Mode::Mode(const ModalTerm& term, const ModeStep& step)
    : filter(step.pole1.value, step.pole2.value),
      taps(numerator(term, step.b1_taps, step.b0_taps)),
      mid_taps(numerator(term, step.b1_mid, step.b0_mid)),
      state_taps(step.state_taps),
      b1(term.b1),
      b0(term.b0),
      pole1(step.pole1.value),
      pole2(step.pole2.value) {}

// Finds the memory v[-1], v[-2] for which the mode has this state at the first sample.
void ModalBank::Mode::start(const ModalState& state, double first_node) {
  const auto& [now, last, older] = state_taps;
  std::array<std::array<double, 2>, 2> matrix;
  std::array<double, 2> right{state.position_m, state.velocity_m_s};
  for (std::size_t i = 0; i < 2; ++i) {
    matrix[i] = {last[i] - pole1 * now[i], older[i] - pole2 * now[i]};
    right[i] -= now[i] * first_node;
  }
  const double determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
  v.fill(0.);
  w.fill(0.);
  v[history - 1] = (right[0] * matrix[1][1] - right[1] * matrix[0][1]) / determinant;
  v[history - 2] = (matrix[0][0] * right[1] - matrix[1][0] * right[0]) / determinant;
}

// For a call with one sample, the loops and memory moves would cost more than the mode.
void ModalBank::Mode::add_sample(double node, double& output) {
  static_assert(history == 3);
  const double older = v[1], last = v[2];
  const double now = AllPoleFilter::step(node, pole1, pole2, last, older);
  output += taps[0] * now + taps[1] * last + taps[2] * older + taps[3] * v[0];
  v[0] = older;
  v[1] = last;
  v[2] = std::abs(now) < negligible ? 0. : now;
}

void ModalBank::Mode::add_output(const double* node, const double* midpoint, std::size_t n,
                                 double* output) {
  if (n == 1 && !midpoint) {
    add_sample(node[0], output[0]);
    return;
  }
  const auto length = static_cast<std::ptrdiff_t>(n);
  double* x = v.data() + history;
  filter.run(node, x, length);
  const auto [t0, t1, t2, t3] = taps;
  for (std::ptrdiff_t i = 0; i < length; ++i)
    output[i] += t0 * x[i] + t1 * x[i - 1] + t2 * x[i - 2] + t3 * x[i - 3];
  keep_history(v, history, n);
  if (!midpoint) return;
  double* y = w.data() + history;
  filter.run(midpoint, y, length);
  for (std::ptrdiff_t i = 0; i < length; ++i)
    output[i] += mid_taps[1] * y[i - 1] + mid_taps[2] * y[i - 2];
  keep_history(w, history, n);
}

ModalBank::ModalBank(const Bvrm& model, double sampling_rate_hz, Hold hold)
    : delay_(sampled_delay(model.delay_s, sampling_rate_hz)),
      hold_(hold),
      direct_term_(model.direct_term_kg_m) {
  check(model);
  const double fraction = hold == Hold::band_limited ? 0. : delay_.fraction;
  for (const ModalTerm& term : model.modes)
    modes_.emplace_back(term, ModeStep(term.a1, term.a0, sampling_rate_hz, hold, fraction));
  reset();
}

void ModalBank::reset(std::span<const ModalState> states) {
  assert(states.empty() || states.size() == modes_.size());
  first_states_.assign(modes_.size(), {});
  std::ranges::copy(states, first_states_.begin());
  started_ = false;
}

// Gives the output at the first sample.
double ModalBank::start(double first_node, double first_direct) {
  double output = direct_term_ * first_direct;
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    modes_[k].start(first_states_[k], first_node);
    output +=
        modes_[k].b0 * first_states_[k].position_m + modes_[k].b1 * first_states_[k].velocity_m_s;
  }
  last_node_ = first_node;
  started_ = true;
  return output;
}

void ModalBank::process(const double* node, const double* midpoint, const double* direct,
                        double* output, std::size_t n) {
  for (std::size_t first = 0; first < n; first += block)
    process_block(node + first, midpoint ? midpoint + first : nullptr, direct + first,
                  output + first, std::min(block, n - first));
}

void ModalBank::process_block(const double* node, const double* midpoint, const double* direct,
                              double* output, std::size_t n) {
  const bool first = !started_;
  const double first_output = first ? start(node[0], direct[0]) : 0.;
  start_with_direct(node, direct, n);
  for (Mode& mode : modes_) mode.add_output(node, midpoint, n, sum_.data());
  // Before the first sample nothing is known: an output that would lie there is taken as at the
  // first.
  if (first) sum_[0] = first_output;
  last_node_ = node[n - 1];
  std::copy_n(sum_.begin(), n, output);
}

void ModalBank::start_with_direct(const double* node, const double* direct, std::size_t n) {
  if (delay_.fraction == 0. || hold_ == Hold::band_limited) {
    for (std::size_t i = 0; i < n; ++i) sum_[i] = direct_term_ * direct[i];
    return;
  }
  const double older = hold_ == Hold::zero_order ? direct_term_ : direct_term_ * delay_.fraction;
  const double newer = direct_term_ - older;
  sum_[0] = newer * node[0] + older * last_node_;
  for (std::size_t i = 1; i < n; ++i) sum_[i] = newer * node[i] + older * node[i - 1];
}

}  // namespace vibrissa::separation
