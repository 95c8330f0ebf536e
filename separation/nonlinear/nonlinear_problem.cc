#include "separation/nonlinear/nonlinear_problem.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "separation/model/fitted_bvrm.h"
#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

// A mode with more steps than this in a sampling interval acts like a direct term.
constexpr int most_steps = 200;

}  // namespace

// Each segment always has its nuisance unknowns; those not asked for are fixed at zero.
NonlinearProblem::NonlinearProblem(const NonlinearBvrm& model, std::span<const Segment> segments,
                                   double sampling_rate_hz, const OutputErrorOptions& options)
    : structure_(model),
      sampling_rate_hz_(sampling_rate_hz),
      options_(options),
      delay_(sampled_delay(model.linear.delay_s, sampling_rate_hz)),
      path_(options.hold, options.hold == Hold::band_limited ? 0. : delay_.fraction),
      n_modes_(static_cast<Eigen::Index>(model.linear.modes.size())),
      n_law_(static_cast<Eigen::Index>(model.law.size())),
      n_model_(n_parameters(model.linear.modes.size(), true) + n_law_),
      n_nuisance_(2 * n_modes_ + 1),
      segments_(align_segments(segments, delay_, options.hold, "nonlinear fit")),
      gram_(n_model_ + 1 + n_nuisance_) {
  for (const AlignedSegment& segment : segments_) {
    for (std::size_t n = segment.first; n < segment.output.size(); ++n)
      total_ += segment.output[n] * segment.output[n];
    n_samples_ += static_cast<double>(segment.output.size() - segment.first);
  }
  n_unknowns_ = n_model_ + n_nuisance_ * static_cast<Eigen::Index>(segments_.size());
  for (Eigen::Index k = 0; k < n_modes_ && !options.viscous_term; ++k)
    fixed_.push_back(parameters_per_mode * k);
  if (!options.direct_term) fixed_.push_back(parameters_per_mode * n_modes_);
  for (Eigen::Index first = n_model_; first < n_unknowns_; first += n_nuisance_) {
    for (Eigen::Index j = 0; j < n_nuisance_ - 1 && !options.nuisance.initial_state; ++j)
      fixed_.push_back(first + j);
    if (!options.nuisance.offset) fixed_.push_back(first + n_nuisance_ - 1);
  }
  if (n_samples_ < 2. * static_cast<double>(n_free()))
    throw signals::UserError("nonlinear fit: " + std::to_string(static_cast<long>(n_samples_)) +
                             " samples are too few for " + std::to_string(n_free()) +
                             " unknowns; take a longer record or a lower order");
}

Eigen::VectorXd NonlinearProblem::start_of(const NonlinearBvrm& model) const {
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(n_unknowns_);
  unknowns.head(n_model_ - n_law_) = to_parameters(model.linear, true);
  for (Eigen::Index k = 0; k < n_law_; ++k)
    unknowns[n_model_ - n_law_ + k] = model.law[static_cast<std::size_t>(k)].coefficient;
  for (const Eigen::Index i : fixed_)
    if (i < n_model_) unknowns[i] = 0.;
  return unknowns;
}

NonlinearBvrm NonlinearProblem::model_of(const Eigen::VectorXd& unknowns) const {
  NonlinearBvrm model = structure_;
  model.linear = with_parameters(unknowns.head(n_model_ - n_law_), true, structure_.linear.delay_s);
  for (Eigen::Index k = 0; k < n_law_; ++k)
    model.law[static_cast<std::size_t>(k)].coefficient = unknowns[n_model_ - n_law_ + k];
  return model;
}

void NonlinearProblem::fix_model() {
  std::erase_if(fixed_, [&](Eigen::Index i) { return i < n_model_; });
  for (Eigen::Index i = 0; i < n_model_; ++i) fixed_.push_back(i);
}

bool NonlinearProblem::admissible(const NonlinearBvrm& model) const {
  const double highest = highest_rad_s(options_.hold, sampling_rate_hz_);
  return std::ranges::all_of(model.linear.modes, [&](const ModalTerm& mode) {
    if (!is_stable_below(mode, highest)) return false;
    return std::ranges::all_of(ModeIntegrator::steps_of(mode, sampling_rate_hz_, path_),
                               [](const auto& piece) { return piece.n_steps <= most_steps; });
  });
}

std::vector<ModeIntegrator> NonlinearProblem::integrators(const NonlinearBvrm& model,
                                                          bool sensitivities) const {
  std::vector<ModeIntegrator> modes;
  for (std::size_t k = 0; k < model.linear.modes.size(); ++k)
    modes.emplace_back(model.linear.modes[k], k == model.mode ? model.law : std::vector<LawTerm>(),
                       sampling_rate_hz_, path_, sensitivities);
  return modes;
}

InputPath::Knots NonlinearProblem::knots(const AlignedSegment& segment, std::size_t n) const {
  if (options_.hold == Hold::band_limited)
    return {segment.node[n - 1], segment.midpoint[n - 1], segment.node[n]};
  return {segment.node[n < 2 ? 0 : n - 2], segment.node[n - 1], segment.node[n]};
}

void NonlinearProblem::start(std::vector<ModeIntegrator>& modes, const Eigen::VectorXd& unknowns,
                             Eigen::Index first_nuisance) const {
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const Eigen::Index i = first_nuisance + 2 * static_cast<Eigen::Index>(k);
    modes[k].start(unknowns[i], unknowns[i + 1]);
  }
}

double NonlinearProblem::moment(const NonlinearBvrm& model,
                                const std::vector<ModeIntegrator>& modes) const {
  double sum = 0.;
  for (std::size_t k = 0; k < modes.size(); ++k)
    sum += model.linear.modes[k].b0 * modes[k].position_m() +
           model.linear.modes[k].b1 * modes[k].velocity_m_s();
  return sum + model.law_gain_kg_m() * modes[model.mode].law_force();
}

// take(segment, first nuisance, sample, modes, error) for each sample of each segment; it may stop
// the simulation by returning false.
template <typename Take>
void NonlinearProblem::simulate(const Eigen::VectorXd& unknowns, bool sensitivities,
                                const Take& take) const {
  const NonlinearBvrm model = model_of(unknowns);
  std::vector<ModeIntegrator> modes = integrators(model, sensitivities);
  Eigen::Index first_nuisance = n_model_;
  for (std::size_t s = 0; s < segments_.size(); ++s, first_nuisance += n_nuisance_) {
    const AlignedSegment& segment = segments_[s];
    const double offset = unknowns[first_nuisance + n_nuisance_ - 1];
    start(modes, unknowns, first_nuisance);
    for (std::size_t n = 0; n < segment.output.size(); ++n) {
      if (n > 0)
        for (ModeIntegrator& mode : modes) mode.advance(knots(segment, n));
      const double error = segment.output[n] - offset -
                           model.linear.direct_term_kg_m * segment.direct[n] - moment(model, modes);
      if (!take(s, n, modes, error)) return;
    }
  }
}

// Columns of the Gram matrix: model parameters, error, nuisances.
void NonlinearProblem::fill_row(const NonlinearBvrm& model,
                                const std::vector<ModeIntegrator>& modes, double direct,
                                Eigen::Index row) {
  const auto at = [&](Eigen::Index column) -> double& { return gram_.column(column)[row]; };
  const Eigen::Index first_nuisance = n_model_ + 1;
  for (Eigen::Index k = 0; k < n_modes_; ++k) {
    const ModeIntegrator& mode = modes[static_cast<std::size_t>(k)];
    const ModalTerm& term = model.linear.modes[static_cast<std::size_t>(k)];
    ModeIntegrator::Sensitivities by =
        term.b0 * mode.position_sensitivity() + term.b1 * mode.velocity_sensitivity();
    double by_b0 = mode.position_m();
    if (static_cast<std::size_t>(k) == model.mode) {
      if (model.readout == LawReadout::moment) {
        const double force = mode.law_force();
        by += model.law_gain_kg_m() * mode.law_force_sensitivity();
        by[1] -= model.law_gain_kg_m() / term.a0 * force;
        by_b0 += force / term.a0;
      }
      for (Eigen::Index j = 0; j < n_law_; ++j) at(n_model_ - n_law_ + j) = by[2 + j];
    }
    const Eigen::Index i = parameters_per_mode * k;
    at(i) = mode.velocity_m_s();
    at(i + 1) = by_b0;
    at(i + 2) = by[0];
    at(i + 3) = by[1];
    at(first_nuisance + 2 * k) = by[by.size() - 2];
    at(first_nuisance + 2 * k + 1) = by[by.size() - 1];
  }
  at(parameters_per_mode * n_modes_) = direct;
  at(n_model_ + n_nuisance_) = 1.;
}

bool NonlinearProblem::linearise(const Eigen::VectorXd& unknowns, NormalEquations& equations) {
  const NonlinearBvrm model = model_of(unknowns);
  if (!admissible(model)) return false;
  equations.matrix.setZero(n_unknowns_, n_unknowns_);
  equations.gradient.setZero(n_unknowns_);
  equations.cost = 0.;
  const Eigen::Index n_columns = n_model_ + 1 + n_nuisance_;
  Eigen::Index row = 0;
  bool bounded = true;
  gram_.clear();
  simulate(
      unknowns, true,
      [&](std::size_t s, std::size_t n, const std::vector<ModeIntegrator>& modes, double error) {
        const AlignedSegment& segment = segments_[s];
        bounded = std::isfinite(error);
        if (!bounded) return false;
        if (n >= segment.first) {
          fill_row(model, modes, segment.direct[n], row);
          gram_.column(n_model_)[row++] = error;
        }
        const bool last = n + 1 == segment.output.size();
        if (row == GramMatrix::block || (last && row > 0)) {
          gram_.add(row, n_columns);
          row = 0;
        }
        if (last) {
          equations.add_segment(gram_.matrix(), n_model_,
                                n_model_ + static_cast<Eigen::Index>(s) * n_nuisance_);
          gram_.clear();
        }
        return true;
      });
  fix(equations);
  return bounded && equations.matrix.allFinite();
}

// Equations of their own, whose solution is no step.
void NonlinearProblem::fix(NormalEquations& equations) const {
  for (const Eigen::Index i : fixed_) {
    equations.matrix.row(i).setZero();
    equations.matrix.col(i).setZero();
    equations.matrix(i, i) = 1.;
    equations.gradient[i] = 0.;
  }
}

std::vector<std::vector<double>> NonlinearProblem::errors(const Eigen::VectorXd& unknowns) const {
  std::vector<std::vector<double>> errors;
  for (const AlignedSegment& segment : segments_) errors.emplace_back(segment.output.size(), 0.);
  simulate(unknowns, false,
           [&](std::size_t s, std::size_t n, const std::vector<ModeIntegrator>&, double error) {
             if (n >= segments_[s].first) errors[s][n] = error;
             return true;
           });
  return errors;
}

NonlinearProblem::Reach NonlinearProblem::reach(const Eigen::VectorXd& unknowns) const {
  Reach reach;
  simulate(unknowns, false,
           [&](std::size_t, std::size_t, const std::vector<ModeIntegrator>& modes, double) {
             const ModeIntegrator& mode = modes[structure_.mode];
             reach.deflection_m = std::max(reach.deflection_m, std::abs(mode.position_m()));
             reach.speed_m_s = std::max(reach.speed_m_s, std::abs(mode.velocity_m_s()));
             return true;
           });
  return reach;
}

}  // namespace vibrissa::separation
