#include "separation/identification/structure_choice.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "separation/identification/hold_check.h"
#include "separation/segments/whitener.h"

namespace vibrissa::separation {

namespace {

constexpr std::size_t whitening_taps = 30;

struct Candidate {
  ModelStructure structure;
  double criterion = std::numeric_limits<double>::infinity();
  double lead_s = 0.;
};

/// What the cost sum e^2 gains, in noise variances, by the unknowns at these places.
double wald(const FittedBvrm& fit, const Eigen::VectorXd& parameters,
            const std::vector<Eigen::Index>& places) {
  if (places.empty()) return 0.;
  const Eigen::VectorXd value = parameters(places);
  const Eigen::MatrixXd covariance = fit.covariance(places, places);
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd scaled = value.cwiseQuotient(scale);
  const Eigen::MatrixXd correlation =
      scale.cwiseInverse().asDiagonal() * covariance * scale.cwiseInverse().asDiagonal();
  return scaled.dot(correlation.ldlt().solve(scaled));
}

class Structures {
 public:
  Structures(std::span<const Segment> segments, double rate_hz, const OutputErrorOptions& allowed)
      : segments_(segments), rate_hz_(rate_hz), allowed_(allowed) {
    for (const Segment& segment : segments)
      for (const double m : segment.base_moment) {
        n_samples_ += 1.;
        power_ += m * m;
      }
  }

  /// The structures of one hold that the allowed unknowns permit.
  void add(const Bvrm& start, Hold hold) {
    OutputErrorOptions options = allowed_;
    options.hold = hold;
    const FittedBvrm fit = refine_output_error(start, segments_, rate_hz_, options);
    if (!fit.covariance.allFinite()) return;
    const Eigen::VectorXd parameters = to_parameters(fit.model, options.direct_term);
    for (const bool direct_term : {true, false})
      for (const bool viscous_term : {true, false})
        if ((allowed_.direct_term || !direct_term) && (allowed_.viscous_term || !viscous_term))
          candidates_.push_back(judge(fit, parameters, {hold, direct_term, viscous_term}));
  }

  std::optional<ModelStructure> best() const {
    if (candidates_.empty()) return std::nullopt;
    constexpr double told_apart = 2.;
    const double least = std::ranges::min(candidates_, {}, &Candidate::criterion).criterion;
    const Candidate* best = nullptr;
    for (const Candidate& candidate : candidates_)
      if (candidate.criterion <= least + told_apart &&
          (!best || std::abs(candidate.lead_s) < std::abs(best->lead_s)))
        best = &candidate;
    return best->structure;
  }

 private:
  Candidate judge(const FittedBvrm& fit, const Eigen::VectorXd& parameters,
                  const ModelStructure& structure) const {
    std::vector<Eigen::Index> left_out;
    const auto n_modes = static_cast<Eigen::Index>(fit.model.modes.size());
    for (Eigen::Index k = 0; k < n_modes && !structure.viscous_term && allowed_.viscous_term; ++k)
      left_out.push_back(parameters_per_mode * k);
    if (!structure.direct_term && allowed_.direct_term) left_out.push_back(parameters.size() - 1);
    // Errors below the rounding level count as equal.
    const double mean_square = std::max(fit.residual_variance, 1e-24 * power_ / n_samples_);
    const double cost_gain =
        wald(fit, parameters, left_out) * fit.residual_variance / mean_square / n_samples_;
    const auto n_unknowns =
        static_cast<double>(parameters.size() - static_cast<Eigen::Index>(left_out.size()));
    return {structure,
            n_samples_ * (std::log(mean_square) + std::log1p(cost_gain)) +
                n_unknowns * std::log(n_samples_),
            structure.viscous_term ? unphysical_lead(fit).value : 0.};
  }

  std::span<const Segment> segments_;
  double rate_hz_;
  OutputErrorOptions allowed_;
  double n_samples_ = 0., power_ = 0.;
  std::vector<Candidate> candidates_;
};

}  // namespace

ModelStructure choose_structure(const FittedBvrm& found, std::span<const Segment> segments,
                                double sampling_rate_hz, const std::vector<Hold>& holds,
                                const OutputErrorOptions& fit) {
  const std::vector<double> error = output_errors(found.model, segments, sampling_rate_hz, fit);
  std::optional<WhitenedSegments> white;
  if (std::ranges::all_of(segments, [](const Segment& segment) {
        return segment.base_moment.size() > 8 * whitening_taps;
      }))
    white.emplace(segments, Whitener(error, whitening_taps));
  Structures structures(white ? white->segments() : segments, sampling_rate_hz, fit);
  for (const Hold hold : holds)
    if (std::ranges::all_of(found.model.modes, [&](const ModalTerm& mode) {
          return is_stable_below(mode, highest_rad_s(hold, sampling_rate_hz));
        }))
      structures.add(found.model, hold);
  return structures.best().value_or(ModelStructure{fit.hold, fit.direct_term, fit.viscous_term});
}

}  // namespace vibrissa::separation
