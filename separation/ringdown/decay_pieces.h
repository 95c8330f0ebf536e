#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vibrissa::separation {

/// A free decay in a record, [first, end): it begins one period behind the largest moment after a
/// hit or a release, and ends where the motion vanishes in the noise or the next hit comes.
struct DecayPiece {
  std::size_t first = 0, end = 0;
};

/// The decays of a record, and what is needed to find them.
struct Decays {
  std::vector<DecayPiece> pieces;
  double frequency_hz = 0.;  // of the strongest line
  double noise_rms = 0.;     // of the quietest part of the record, in the band of the mode [N m]
};

/// Decays of the strongest mode in a base moment [N m]. Throws UserError, with what to record
/// instead, where no motion falls to a third of its beginning over at least five periods. Proven by
/// tests/separation/ringdown/decay_pieces_test.cc.
Decays find_decays(std::span<const double> moment, double sampling_rate_hz);

}  // namespace vibrissa::separation
