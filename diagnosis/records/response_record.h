#pragma once

#include <complex>

#include "diagnosis/records/experiment.h"
#include "signals/files/dataset_response.h"

namespace vibrissa::diagnosis {

/// What the reading of a response's quantity is: the moment, or a motion in proportion to the
/// joint's rotation.
signals::Readout readout_of(signals::ResponseQuantity quantity);

/// Values of a response as moment, rotation or deflection: a velocity divided by j w, an
/// acceleration by -w^2.
std::vector<Complex> as_deflection(const signals::DatasetResponse& entry);

/// A response as a prepared record (SineLines), with at most 256 of its lines. The noise share of
/// its bins is their variance
/// [(N m)^2] until share_noise() divides it.
PreparedRecord prepare_response(const signals::DatasetResponse& measured, std::size_t number);

/// Adds the comparable responses of the given split. Without records they give the moment's noise.
void add_responses(Experiment& experiment, const signals::Dataset& dataset, signals::Split split);

/// Divides the noise of the responses' bins by that of the experiment's moment.
void share_noise(Experiment& experiment);

}  // namespace vibrissa::diagnosis
