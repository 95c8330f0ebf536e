#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "separation/numerics/levenberg_marquardt.h"
#include "separation/ringdown/decay_law.h"

namespace vibrissa::separation {

/// Parts of a law beside frequency and viscous damping.
struct LawParts {
  bool cubic = false, drag = false, friction = false;

  bool operator==(const LawParts&) const = default;
  Eigen::Index n_parameters() const { return 2 + cubic + drag + 2 * friction; }
  /// All parameters are logarithms but that of the cubic part, which may have either sign.
  bool is_logarithm(Eigen::Index parameter) const { return !(cubic && parameter == 2); }
};

/// A law fitted to decays. The parameters of the law are, in turn: ln frequency, ln damping ratio,
/// and, where it has them, cubic, ln drag, ln slip, ln stick ratio.
struct FittedDecay {
  DecayLaw law;
  LawParts parts;
  std::vector<DecayStart> starts{};  // of each piece
  Eigen::VectorXd parameters{};      // of the law
  Eigen::MatrixXd covariance{};      // of the parameters; empty where the decays do not tell them
  std::vector<std::vector<double>> errors{};  // measured minus fitted moment of each piece
  double squares = 0.;  // sum over all pieces; infinite where the law cannot be a start
  std::size_t n_unknowns = 0;

  double n_samples() const;  // of all pieces
};

/// The law with other parameters.
DecayLaw with_parameters(DecayLaw law, const LawParts& parts, const Eigen::VectorXd& parameters);

/// Least squares over all samples of the pieces, each with a start, an offset and its drift of its
/// own, by Levenberg and Marquardt from `law`. Deviations are for white noise, multiplied where the
/// errors of the fit are larger near the mode's frequency than over the whole band. Proven by
/// tests/separation/ringdown/ring_down_test.cc.
FittedDecay fit_decay(const DecayLaw& law, const LawParts& parts,
                      std::span<const std::span<const double>> pieces, double sampling_rate_hz);

}  // namespace vibrissa::separation
