#pragma once

#include <span>

#include "diagnosis/model/nominal_model.h"
#include "separation/model/input_hold.h"
#include "separation/model/rational_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

using Holds = std::span<const separation::Hold>;

/// Identifies the base path of a model (modes and direct term) from a simulation's records: from
/// the excited lines of periodic records, if any, by frequency-domain fits of rising order;
/// otherwise, and where an input that is held or interpolated fits better, by output-error fits,
/// which start from Welch's response, under the given behaviours of the input between samples. The
/// order is the lowest whose misfit is not halved by more poles. A simulation without dynamics has
/// a direct term only. Returns how the simulation's input behaves between samples. Leaves the model
/// unchanged when no order can be fitted. Throws UserError for records that are too short. Proven
/// by tests/diagnosis/nominal/nominal_identification_test.cc.
separation::Hold identify_base_path(NominalModel& model,
                                    std::span<const signals::DatasetRecord* const> base,
                                    Holds holds);

/// The same from simulated responses, lowest level first. Throws UserError where the phase is known
/// but for an offset.
void identify_base_path(NominalModel& model,
                        std::span<const signals::DatasetResponse* const> responses);

/// A simulation that holds or interpolates its input has the same samples whether a mode is at
/// w_d or at a sum or difference of w_d and a multiple of the sampling frequency (aliases). A mode
/// above half the sampling rate, or one whose damping ratio is not between those of mass- and
/// stiffness-proportional damping, given the strongest mode (Rayleigh: z1 w1 / w to z1 w / w1; up
/// to a factor of 2 beyond), moves to the alias with such damping that leaves the least static gain
/// to the direct term, because modes above the band have little. The samples and the static gain
/// stay the same: with poles p -> q residues grow by (q / p)^n, n = 1 for a held, 2 for a linear
/// input (Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed., 1998, 6.3).
/// Proven by tests/diagnosis/nominal/mode_above_sampling_test.cc.
separation::Bvrm with_modes_above_sampling(const separation::Bvrm& model, separation::Hold hold,
                                           double sampling_rate_hz);

}  // namespace vibrissa::diagnosis
