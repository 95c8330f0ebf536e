#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "signals/excitation/swept_sine.h"
#include "signals/formats/wav_file.h"
#include "signals/spectra/line_grid.h"

namespace vibrissa::signals {

enum class ExcitationKind { multisine, sweep, noise };

/// How the phases of a multisine are chosen; realisations differ by the seed.
enum class PhaseRule {
  schroeder,  // the same in every realisation
  random,     // uniform and independent: what the theory of the best linear approximation supposes
  optimised   // lowered crest factor: begun from Schroeder's, further realisations from random ones
};

/// What a coil drive shall be.
struct ExcitationDesign {
  ExcitationKind kind = ExcitationKind::multisine;
  double low_hz = 1., high_hz = 200.;
  double sampling_rate_hz = 500.;
  std::size_t period_samples = 2048;  // of sweep and noise: one pass
  LineGrid grid = LineGrid::random_odd;
  std::size_t group_size = 4;  // of the random-odd grid
  PhaseRule phase = PhaseRule::optimised;
  SweepLaw sweep_law = SweepLaw::logarithmic;
  double fade_s = 0.;                 // of sweeps
  double peak = 1.;                   // at level 1, in the unit
  std::string unit = "m/s^2";         // of the drive
  std::vector<double> levels = {1.};  // multiples of the peak, each a drive of its own
  std::size_t n_realisations = 1;
  std::size_t n_periods = 4;          // to be kept
  std::size_t n_lead_in_periods = 1;  // sent first, not to be kept: transients die in them
  std::uint64_t seed = 1;
};

/// One line of a multisine's table.
struct DescribedLine {
  std::size_t order = 0;
  double frequency_hz = 0.;
  LineRole role = LineRole::excited;
  double amplitude = 0.;  // at level 1, of every realisation's first; 0 at detection lines
};

/// One file's worth of drive.
struct Drive {
  double level = 1.;
  std::size_t realisation = 1;
  double crest_factor = 0.;       // of the sampled period; of a multisine on 16 times denser time
  std::vector<double> period;     // one period at this level
  std::vector<double> phase_rad;  // of the excited lines; empty for sweep and noise
};

/// A designed excitation: its drives and what may be learned from them.
struct DesignedExcitation {
  ExcitationDesign design;
  std::vector<DescribedLine> lines;  // of a multisine
  std::vector<Drive> drives;         // [level][realisation], realisation fastest

  double resolution_hz() const;
  /// Peak of the largest level, also between the samples: what a sound card's 1.0 must reach.
  double full_scale() const;
  /// All periods of one drive, the lead-in first.
  std::vector<double> samples(const Drive& drive) const;
};

/// Every realisation of a multisine has the same lines and, peak being given, its own amplitude;
/// the levels are exact multiples of each other. Throws UserError when the design contradicts
/// itself (which entry and what to do) and what grid_lines and the drives' makers throw. Proven by
/// tests/signals/excitation/excitation_test.cc.
DesignedExcitation design_excitation(const ExcitationDesign& design);

/// "multisine", "sweep", "noise"; "schroeder", "random", "optimised"; "linear", "logarithmic".
std::string name_of(ExcitationKind kind);
std::string name_of(PhaseRule rule);
std::string name_of(SweepLaw law);

/// Schema "vibrissa-excitation-1": the design, crest factors, the table of lines with what each
/// reveals in words, and phases, so that the drive can be made again elsewhere.
nlohmann::json to_json(const DesignedExcitation& excitation);

/// Writes one drive as a record (docs/records.md) with the drive as the given channel, in its SI
/// unit, or as WAV scaled to the full scale of all drives, so that their levels stay in proportion.
/// Throws UnitError where the drive's unit measures something else than the channel.
void write_drive_record(const std::filesystem::path& file, const DesignedExcitation& excitation,
                        const Drive& drive, const std::string& channel);
void write_drive_wav(const std::filesystem::path& file, const DesignedExcitation& excitation,
                     const Drive& drive, WavFormat format);

}  // namespace vibrissa::signals
