#include "separation/identification/output_error_problem.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "separation/numerics/all_pole_filter.h"
#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;
using Signal = Eigen::Map<Eigen::ArrayXd>;
using ConstSignal = Eigen::Map<const Eigen::ArrayXd>;

constexpr std::size_t history = 3;
constexpr auto block = static_cast<std::size_t>(GramMatrix::block);
using Memory = std::array<double, history + block>;

// sum_j taps[j] x[n - j].
auto moving_sum(const std::array<double, 3>& taps, const double* x, Eigen::Index n) {
  return taps[0] * ConstSignal(x, n) + taps[1] * ConstSignal(x - 1, n) +
         taps[2] * ConstSignal(x - 2, n);
}

void keep_history(Memory& memory, Eigen::Index n) {
  for (std::size_t j = 0; j < history; ++j) memory[j] = memory[static_cast<std::size_t>(n) + j];
}

}  // namespace

// A mode on the grid: its numerators, their derivatives, and its running signals.
struct OutputErrorProblem::Mode {
  using Taps = std::array<double, 4>;
  using Rest = std::array<double, 3>;

  void set(const ModalTerm& term, const ModeStep& step) {
    filter = AllPoleFilter(step.pole1.value, step.pole2.value);
    b1 = term.b1;
    b0 = term.b0;
    pole1_by_a1 = step.pole1.by_a1;
    pole1_by_a0 = step.pole1.by_a0;
    pole2_by_a1 = step.pole2.by_a1;
    pole2_by_a0 = step.pole2.by_a0;
    const auto fill = [&](auto& by_b1, auto& by_b0, auto& by_a1, auto& by_a0, const auto& unit_b1,
                          const auto& unit_b0) {
      for (std::size_t j = 0; j < unit_b1.size(); ++j) {
        by_b1[j] = unit_b1[j].value;
        by_b0[j] = unit_b0[j].value;
        by_a1[j] = b1 * unit_b1[j].by_a1 + b0 * unit_b0[j].by_a1;
        by_a0[j] = b1 * unit_b1[j].by_a0 + b0 * unit_b0[j].by_a0;
      }
    };
    fill(taps[0], taps[1], taps[2], taps[3], step.b1_taps, step.b0_taps);
    fill(mid[0], mid[1], mid[2], mid[3], step.b1_mid, step.b0_mid);
    fill(rest[0], rest[1], rest[2], rest[3], step.b1_rest, step.b0_rest);
  }

  void start() {
    v.fill(0.);
    w.fill(0.);
    g.fill(0.);
    s.fill(0.);
    largest_g = 0.;
    free_active = true;
  }

  AllPoleFilter filter{0., 0.};
  double b1 = 0., b0 = 0.;
  double pole1_by_a1 = 0., pole1_by_a0 = 0., pole2_by_a1 = 0., pole2_by_a0 = 0.;
  std::array<Taps, 4> taps{};  // of the columns b1, b0, a1, a0
  std::array<Rest, 4> mid{};   // the same, from the filtered midpoints
  std::array<Rest, 4> rest{};  // the same of the free response, per first input sample
  Memory v{}, w{}, g{}, s{};   // filtered nodes, midpoints, impulse, and output of the mode
  std::array<double, block> output{};
  double largest_g = 0.;
  bool free_active = true;
};

OutputErrorProblem::OutputErrorProblem(std::size_t n_modes, double delay_s,
                                       std::span<const Segment> segments, double sampling_rate_hz,
                                       const OutputErrorOptions& options)
    : n_modes_(n_modes),
      sampling_rate_hz_(sampling_rate_hz),
      options_(options),
      delay_(sampled_delay(delay_s, sampling_rate_hz)),
      between_(lies_between(delay_, options.hold)),
      n_model_(n_parameters(n_modes, options.direct_term)),
      n_nuisance_((options.nuisance.offset ? 1 : 0) +
                  (options.nuisance.initial_state ? 2 * static_cast<Eigen::Index>(n_modes) : 0)),
      segments_(align_segments(segments, delay_, options.hold, "output-error fit")),
      modes_(n_modes),
      gram_(n_model_ + 1 + n_nuisance_) {
  for (const AlignedSegment& segment : segments_) {
    for (std::size_t n = segment.first; n < segment.output.size(); ++n)
      total_ += segment.output[n] * segment.output[n];
    n_samples_ += static_cast<double>(segment.output.size() - segment.first);
  }
  n_unknowns_ = n_model_ + n_nuisance_ * static_cast<Eigen::Index>(segments_.size());
  if (n_samples_ < 2. * static_cast<double>(n_unknowns_))
    throw UserError("output-error fit: " + std::to_string(static_cast<long>(n_samples_)) +
                    " samples are too few for " + std::to_string(n_unknowns_) +
                    " unknowns; take a longer record or a lower order");
}

bool OutputErrorProblem::admissible(const ModalTerm& mode) const {
  return is_stable_below(mode, highest_rad_s(options_.hold, sampling_rate_hz_));
}

bool OutputErrorProblem::linearise(const Eigen::VectorXd& unknowns, NormalEquations& equations) {
  const Bvrm model = with_parameters(unknowns.head(n_model_), options_.direct_term, 0.);
  for (std::size_t k = 0; k < n_modes_; ++k) {
    const ModalTerm& term = model.modes[k];
    if (!admissible(term)) return false;
    modes_[k].set(term, ModeStep(term.a1, term.a0, sampling_rate_hz_, options_.hold,
                                 between_ ? delay_.fraction : 0.));
  }
  equations.matrix.setZero(n_unknowns_, n_unknowns_);
  equations.gradient.setZero(n_unknowns_);
  equations.cost = 0.;
  Eigen::Index first_nuisance = n_model_;
  for (const AlignedSegment& segment : segments_) {
    add_segment(segment, first_nuisance, unknowns);
    equations.add_segment(gram_.matrix(), n_model_, first_nuisance);
    first_nuisance += n_nuisance_;
  }
  fix_viscous_terms(equations);
  return true;
}

// Equations of their own, whose solution is no step.
void OutputErrorProblem::fix_viscous_terms(NormalEquations& equations) const {
  for (Eigen::Index k = 0; k < n_fixed(); ++k) {
    const Eigen::Index b1 = parameters_per_mode * k;
    equations.matrix.row(b1).setZero();
    equations.matrix.col(b1).setZero();
    equations.matrix(b1, b1) = 1.;
    equations.gradient[b1] = 0.;
  }
}

// Columns of the Gram matrix: model parameters, error, offset, free responses. The free responses
// decay and are then omitted.
void OutputErrorProblem::add_segment(const AlignedSegment& segment, Eigen::Index first_nuisance,
                                     const Eigen::VectorXd& unknowns) {
  gram_.clear();
  for (Mode& mode : modes_) mode.start();
  const double direct = options_.direct_term ? unknowns[n_model_ - 1] : 0.;
  const double offset = options_.nuisance.offset ? unknowns[first_nuisance] : 0.;
  const Eigen::Index n_offset = options_.nuisance.offset ? 1 : 0;
  const Eigen::Index n_free = n_nuisance_ - n_offset;
  const auto length = static_cast<Eigen::Index>(segment.output.size());
  for (Eigen::Index start = 0; start < length; start += GramMatrix::block) {
    const Eigen::Index n = std::min(GramMatrix::block, length - start);
    const ConstSignal direct_input(segment.direct.data() + start, n);
    Signal error(gram_.column(n_model_), n);
    error = ConstSignal(segment.output.data() + start, n) - direct * direct_input - offset;
    if (options_.direct_term) Signal(gram_.column(n_model_ - 1), n) = direct_input;
    if (n_offset) Signal(gram_.column(n_model_ + 1), n) = 1.;

    const bool free_active =
        std::ranges::any_of(modes_, [](const Mode& mode) { return mode.free_active; });
    for (std::size_t k = 0; k < n_modes_; ++k) {
      const Eigen::Index free =
          n_free == 0 ? 0 : first_nuisance + n_offset + 2 * static_cast<Eigen::Index>(k);
      advance(k, segment, start, n, n_free == 0 ? nullptr : &unknowns[free]);
      error -= ConstSignal(modes_[k].output.data(), n);
    }
    const Eigen::Index n_columns = n_model_ + 1 + n_offset + (free_active ? n_free : 0);
    const Eigen::Index n_unused =
        std::clamp<Eigen::Index>(static_cast<Eigen::Index>(segment.first) - start, 0, n);
    for (Eigen::Index j = 0; n_unused > 0 && j < n_columns; ++j)
      Signal(gram_.column(j), n_unused).setZero();
    gram_.add(n, n_columns);
  }
}

void OutputErrorProblem::advance(std::size_t k, const AlignedSegment& segment, Eigen::Index start,
                                 Eigen::Index n, const double* free) {
  Mode& mode = modes_[k];
  fill_forced_columns(k, segment, start, n);
  if (mode.free_active) run_impulse(mode, start, n);
  if (!free && mode.free_active) add_start_at_rest(k, segment.node[0], n);
  Signal output(mode.output.data(), n);
  output = mode.b1 * column(k, 0, n) + mode.b0 * column(k, 1, n);
  if (free) fill_free_columns(k, free, n);

  double* s = mode.s.data() + history;
  mode.filter.run(mode.output.data(), s, n);
  const ConstSignal last(s - 1, n), older(s - 2, n);
  column(k, 2, n) -= mode.pole1_by_a1 * last + mode.pole2_by_a1 * older;
  column(k, 3, n) -= mode.pole1_by_a0 * last + mode.pole2_by_a0 * older;
  keep_history(mode.s, n);
  if (mode.free_active) finish_impulse(mode, n);
}

Eigen::Map<Eigen::ArrayXd> OutputErrorProblem::column(std::size_t mode, Eigen::Index parameter,
                                                      Eigen::Index n) {
  return {gram_.column(parameters_per_mode * static_cast<Eigen::Index>(mode) + parameter), n};
}

// What the input does through the numerators; the poles' own share follows once the output is
// known.
void OutputErrorProblem::fill_forced_columns(std::size_t k, const AlignedSegment& segment,
                                             Eigen::Index start, Eigen::Index n) {
  Mode& mode = modes_[k];
  const bool midpoints = !segment.midpoint.empty();
  double *v = mode.v.data() + history, *w = mode.w.data() + history;
  mode.filter.run(segment.node.data() + start, v, n);
  if (midpoints) mode.filter.run(segment.midpoint.data() + start, w, n);
  for (Eigen::Index j = 0; j < parameters_per_mode; ++j) {
    Signal target = column(k, j, n);
    const auto& [t0, t1, t2, t3] = mode.taps[static_cast<std::size_t>(j)];
    target = moving_sum({t0, t1, t2}, v, n);
    if (between_) target += t3 * ConstSignal(v - 3, n);
    if (midpoints) target += moving_sum(mode.mid[static_cast<std::size_t>(j)], w, n);
  }
  keep_history(mode.v, n);
  if (midpoints) keep_history(mode.w, n);
}

void OutputErrorProblem::add_start_at_rest(std::size_t k, double first_node, Eigen::Index n) {
  const Mode& mode = modes_[k];
  for (Eigen::Index j = 0; j < parameters_per_mode; ++j)
    column(k, j, n) +=
        first_node * moving_sum(mode.rest[static_cast<std::size_t>(j)], mode.g.data() + history, n);
}

void OutputErrorProblem::fill_free_columns(std::size_t k, const double* free, Eigen::Index n) {
  Mode& mode = modes_[k];
  const Eigen::Index first =
      n_model_ + 1 + (options_.nuisance.offset ? 1 : 0) + 2 * static_cast<Eigen::Index>(k);
  for (Eigen::Index j = 0; j < 2; ++j) {
    Signal response(gram_.column(first + j), n);
    if (!mode.free_active) {
      response.setZero();
      continue;
    }
    response = ConstSignal(mode.g.data() + history - j - (between_ ? 1 : 0), n);
    Signal(mode.output.data(), n) += free[j] * response;
  }
}

void OutputErrorProblem::run_impulse(Mode& mode, Eigen::Index start, Eigen::Index n) {
  static constexpr std::array<double, block> silence{};
  static constexpr std::array<double, block> impulse{1.};
  mode.filter.run(start == 0 ? impulse.data() : silence.data(), mode.g.data() + history, n);
}

void OutputErrorProblem::finish_impulse(Mode& mode, Eigen::Index n) {
  const Eigen::Map<const Eigen::ArrayXd> g(mode.g.data() + history, n);
  mode.largest_g = std::max(mode.largest_g, g.abs().maxCoeff());
  keep_history(mode.g, n);
  const double now = std::abs(mode.g[2]) + std::abs(mode.g[1]);
  if (now < 1e-17 * mode.largest_g) mode.free_active = false;
}

OutputErrorProblem::~OutputErrorProblem() = default;

}  // namespace vibrissa::separation
