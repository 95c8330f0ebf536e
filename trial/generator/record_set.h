#pragma once

#include <vector>

#include "trial/classes/circumstances.h"
#include "trial/generator/session.h"

namespace vibrissa::trial {

/// Takes of the bench for a set, held-out takes included: a choice of usual_takes() and
/// transfer_takes(), at one level where the set has one; 20 s of random vibration for two files.
std::vector<Take> takes_of(RecordSet set);

/// Is the channel of the wind speed in the records? Proven by
/// tests/trial/generator/record_set_test.cc.
bool has_wind_channel(RecordSet set);

/// Further experiments that the bench of a set can do: without a fan only those without wind.
std::vector<FurtherExperiment> further_experiments(RecordSet set);

/// Factor of the moment sensor's noise. The accelerometer keeps its noise: ten times as much of it
/// is the effect reference_noise.
double noise_factor(RecordSet set);

}  // namespace vibrissa::trial
