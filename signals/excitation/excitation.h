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
  random,     // uniform and independent, as the theory of the best linear approximation requires
  optimised   // low crest factor: starts from Schroeder phases, further realisations from random
              // phases
};

/// Design of the drive signal of a coil.
struct ExcitationDesign {
  ExcitationKind kind = ExcitationKind::multisine;
  double low_hz = 1., high_hz = 200.;
  double sampling_rate_hz = 500.;
  std::size_t period_samples = 2048;  // for a sweep or noise: its length
  LineGrid grid = LineGrid::random_odd;
  std::size_t group_size = 4;  // for the random-odd grid
  PhaseRule phase = PhaseRule::optimised;
  SweepLaw sweep_law = SweepLaw::logarithmic;
  double fade_s = 0.;                 // for sweeps
  double peak = 1.;                   // at level 1, in the unit
  std::string unit = "m/s^2";         // of the drive
  std::vector<double> levels = {1.};  // multiples of the peak, one drive for each
  std::size_t n_realisations = 1;
  std::size_t n_periods = 4;          // periods to evaluate
  std::size_t n_lead_in_periods = 1;  // first periods, not evaluated: the transients decay
  std::uint64_t seed = 1;
};

/// One line of a multisine.
struct DescribedLine {
  std::size_t order = 0;
  double frequency_hz = 0.;
  LineRole role = LineRole::excited;
  double amplitude = 0.;  // at level 1, realisation 1; 0 at detection lines
};

/// The drive signal of one file.
struct Drive {
  double level = 1.;
  std::size_t realisation = 1;
  double crest_factor = 0.;    // of the sampled period; for a multisine with 16 times oversampling
  std::vector<double> period;  // one period at this level
  std::vector<double> phase_rad;  // of the excited lines; empty for sweep and noise
};

/// A designed excitation, with its drives and its lines.
struct DesignedExcitation {
  ExcitationDesign design;
  std::vector<DescribedLine> lines;  // of a multisine
  std::vector<Drive> drives;         // [level][realisation], realisation fastest

  double resolution_hz() const;
  /// Peak of the largest level, also between the samples: the value of 1.0 of a sound card.
  double full_scale() const;
  /// Samples of all periods of one drive, the lead-in first.
  std::vector<double> samples(const Drive& drive) const;
};

/// Makes the drives. Every realisation of a multisine has the same lines; its amplitude gives the
/// required peak. The levels are exact multiples of each other. Throws UserError for a design that
/// is not possible (with the entry and what to do), and what grid_lines and the signal functions
/// throw. Proven by tests/signals/excitation/excitation_test.cc.
DesignedExcitation design_excitation(const ExcitationDesign& design);

/// "multisine", "sweep", "noise"; "schroeder", "random", "optimised"; "linear", "logarithmic".
std::string name_of(ExcitationKind kind);
std::string name_of(PhaseRule rule);
std::string name_of(SweepLaw law);

/// Schema "vibrissa-excitation-1": the design, the crest factors, the lines with a text of what
/// each line shows, and the phases, so that another program can make the same drive.
nlohmann::json to_json(const DesignedExcitation& excitation);

/// Writes one drive as a record (docs/records.md) with the drive as the given channel, in its SI
/// unit, or as WAV scaled to the full scale of all drives, so that the ratios of the levels are
/// kept. Throws UnitError when the unit of the drive cannot be converted to the unit of the
/// channel.
void write_drive_record(const std::filesystem::path& file, const DesignedExcitation& excitation,
                        const Drive& drive, const std::string& channel);
void write_drive_wav(const std::filesystem::path& file, const DesignedExcitation& excitation,
                     const Drive& drive, WavFormat format);

}  // namespace vibrissa::signals
