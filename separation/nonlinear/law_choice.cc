#include "separation/nonlinear/law_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "separation/model/simulation.h"
#include "separation/numerics/significance.h"

namespace vibrissa::separation {

namespace {

// Speed at which the smooth friction has reached most of its force, as a share of the largest one.
constexpr double friction_bend = 0.02;

std::vector<LawTerm> named_laws(double largest_speed_m_s) {
  return {{.kind = LawKind::cubic_stiffness},
          {.kind = LawKind::quadratic_stiffness},
          {.kind = LawKind::quadratic_damping},
          {.kind = LawKind::friction, .speed_m_s = friction_bend * largest_speed_m_s}};
}

std::vector<LawTerm> monomials() {
  std::vector<LawTerm> terms;
  for (const auto& [i, j] :
       std::vector<std::pair<int, int>>{{1, 1}, {0, 2}, {2, 1}, {1, 2}, {0, 3}, {4, 0}, {5, 0}})
    terms.push_back({.kind = LawKind::monomial, .deflection_power = i, .velocity_power = j});
  return terms;
}

double rms(const std::vector<double>& squares) {
  double sum = 0.;
  for (const double square : squares) sum += square / static_cast<double>(squares.size());
  return std::sqrt(sum);
}

// Logarithms of the error in 40 parts of equal length: a ratio of errors counts alike in loud and
// in quiet parts.
std::vector<double> part_levels(const std::vector<double>& squares) {
  constexpr std::size_t n_parts = 40;
  const std::size_t length = squares.size() / n_parts;
  std::vector<double> levels;
  for (std::size_t k = 0; k < n_parts; ++k)
    levels.push_back(std::log(
        std::accumulate(squares.begin() + static_cast<std::ptrdiff_t>(k * length),
                        squares.begin() + static_cast<std::ptrdiff_t>((k + 1) * length), 1e-300)));
  return levels;
}

/// A fit and its squared errors on the data that it has not seen.
struct Evaluated {
  FittedNonlinearBvrm fit;
  std::vector<double> unseen;
};

class Growth {
 public:
  Growth(std::span<const Segment> segments, double rate_hz, const LawChoiceOptions& options)
      : segments_(segments), rate_hz_(rate_hz), options_(options) {
    for (const Segment& segment : segments)
      fitted_.push_back({segment.base_acceleration.first(n_fitted(segment)),
                         segment.base_moment.first(n_fitted(segment))});
  }

  LawChoice run(const NonlinearBvrm& linear) {
    Evaluated best = evaluate(linear, {});
    LawChoice choice;
    choice.unseen_rms_without_law_n_m = rms(best.unseen);
    while (best.fit.model.law.size() < options_.most_terms) {
      std::optional<Evaluated> next =
          best_of(best, named_laws(best.fit.model.largest_speed_m_s), choice);
      if (!next) next = best_of(best, monomials(), choice);
      if (!next) break;
      best = std::move(*next);
    }
    choice.model = best.fit.model;
    choice.unseen_rms_n_m = rms(best.unseen);
    return choice;
  }

 private:
  std::size_t n_fitted(const Segment& segment) const {
    return static_cast<std::size_t>((1. - options_.held_out_share) *
                                    static_cast<double>(segment.base_moment.size()));
  }

  // A friction or drag that adds energy is none.
  static bool is_unphysical(const LawTerm& term) {
    return (term.kind == LawKind::friction || term.kind == LawKind::quadratic_damping) &&
           term.coefficient < 0.;
  }

  FittedNonlinearBvrm refine(const NonlinearBvrm& start, const Eigen::VectorXd& unknowns) const {
    return refine_nonlinear(start, fitted_, rate_hz_, options_.fit, unknowns);
  }

  // Of the terms that the fit makes unphysical, another term does the work. The simulation of the
  // fitted part runs on into the rest.
  Evaluated evaluate(const NonlinearBvrm& start, const Eigen::VectorXd& unknowns) const {
    Evaluated evaluated{.fit = refine(start, unknowns), .unseen = {}};
    NonlinearBvrm physical = evaluated.fit.model;
    if (std::erase_if(physical.law, is_unphysical) > 0)
      evaluated.fit = refine(physical, evaluated.fit.unknowns);
    const NonlinearProblem whole(evaluated.fit.model, segments_, rate_hz_, options_.fit);
    const auto errors = whole.errors(evaluated.fit.unknowns);
    for (std::size_t s = 0; s < segments_.size(); ++s)
      for (std::size_t n = n_fitted(segments_[s]); n < errors[s].size(); ++n)
        evaluated.unseen.push_back(errors[s][n] * errors[s][n]);
    return evaluated;
  }

  bool gains(const Evaluated& before, const Evaluated& after, double deviations) const {
    const double left = rms(after.unseen) / rms(before.unseen);
    return after.fit.end == FitEnd::converged &&
           std::ranges::none_of(after.fit.model.law, is_unphysical) &&
           deviations > options_.significant && left * left < 1. - options_.least_gain;
  }

  // The accepted candidate with the smallest error on unseen data.
  std::optional<Evaluated> best_of(const Evaluated& before, const std::vector<LawTerm>& candidates,
                                   LawChoice& choice) const {
    const NonlinearBvrm& model = before.fit.model;
    std::vector<LawReadout> readouts{model.readout};
    if (model.law.empty()) readouts = {LawReadout::moment, LawReadout::deflection};
    std::optional<Evaluated> best;
    std::size_t place = 0;
    for (const LawTerm& term : candidates) {
      if (std::ranges::count(model.law, term.name(), &LawTerm::name)) continue;
      for (const LawReadout readout : readouts) {
        NonlinearBvrm trial = model;
        trial.law.push_back(term);
        trial.readout = readout;
        Evaluated evaluated = evaluate(trial, before.fit.unknowns);
        const double deviations =
            mean_difference_significance(part_levels(before.unseen), part_levels(evaluated.unseen));
        choice.trials.push_back({.term = term.name(),
                                 .readout = to_string(readout),
                                 .unseen_rms_n_m = rms(evaluated.unseen),
                                 .gain_deviations = deviations});
        if (!gains(before, evaluated, deviations)) continue;
        if (best && !(rms(evaluated.unseen) < rms(best->unseen))) continue;
        best = std::move(evaluated);
        place = choice.trials.size() - 1;
      }
    }
    if (best) choice.trials[place].accepted = true;
    return best;
  }

  std::span<const Segment> segments_;
  double rate_hz_;
  const LawChoiceOptions& options_;
  std::vector<Segment> fitted_;
};

double power_of(const ModalTerm& mode, std::span<const Segment> segments, double rate_hz,
                Hold hold) {
  double power = 0.;
  for (const Segment& segment : segments)
    for (const double m : simulate(Bvrm{.modes = {mode}}, segment.base_acceleration, rate_hz, hold))
      power += m * m;
  return power;
}

}  // namespace

std::size_t strongest_mode(const Bvrm& model, std::span<const Segment> segments,
                           double sampling_rate_hz, Hold hold) {
  std::size_t strongest = 0;
  double most = -1.;
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    const double power = power_of(model.modes[k], segments, sampling_rate_hz, hold);
    if (!(power > most)) continue;
    most = power;
    strongest = k;
  }
  return strongest;
}

LawChoice choose_law(const Bvrm& start, std::span<const Segment> segments, double sampling_rate_hz,
                     const LawChoiceOptions& options) {
  const NonlinearBvrm linear{
      .linear = start,
      .mode = strongest_mode(start, segments, sampling_rate_hz, options.fit.hold),
      .law = {}};
  return Growth(segments, sampling_rate_hz, options).run(linear);
}

}  // namespace vibrissa::separation
