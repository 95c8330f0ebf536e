#pragma once

#include <vector>

#include "report/figures/figure.h"
#include "reproduction/paper_sensors.h"
#include "reproduction/paper_trials.h"

namespace vibrissa::reproduction {

/// Figure 7: base moment after a step of base acceleration, 0.1 .. 1.5 g, analytical beam.
report::Figure step_responses(const signals::Beam& wire);
/// Figure 8: steady moment against wind speed and against base acceleration, flow and whisker.
report::Figure steady_responses(const PaperSensors& sensors);
/// Figure 9: base acceleration -> base moment of the three sensors.
report::Figure base_responses(const PaperSensors& sensors);
/// Figures 10 and 11: the recorded signals, and the true and the estimated wind moment.
report::Figure estimates(const PaperTrial& trial, const std::string& name,
                         const std::string& title);
/// Figure 12: power spectra of the experiment.
report::Figure experiment_spectra(const PaperTrial& trial);

/// Exponent p of |M| ~ u^p between two wind speeds. (The exponent in base acceleration is 1.)
double wind_exponent(const signals::ReducedModel& model, double low_m_s, double high_m_s);

}  // namespace vibrissa::reproduction
