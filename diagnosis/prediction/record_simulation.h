#pragma once

#include <vector>

#include "diagnosis/model/updated_model.h"
#include "signals/record/record.h"

namespace vibrissa::diagnosis {

/// Initial state of a simulated record.
enum class Start {
  settled,  // inputs were constant at their first values for a long time
  periodic  // the inputs are whole periods in steady state
};

/// Base moment reading [N m] (frame and sign of docs/records.md) of the model for a record's base
/// acceleration, cross acceleration and wind speed: free simulation without noise, one value per
/// sample. Missing channels are zero. Throws UserError when the record contains no input of the
/// model. Proven by tests/diagnosis/model/updated_model_test.cc.
std::vector<double> simulate_moment(const UpdatedModel& model, const signals::Record& inputs,
                                    Start start = Start::settled);

/// The same for base motion alone, without wind: the vibration that a separator subtracts.
std::vector<double> simulate_vibration(const UpdatedModel& model, const signals::Record& inputs);

/// The record's measured moment minus the simulated vibration [N m]: the wind's part. Throws as
/// simulate_moment. Proven by tests/diagnosis/validation/separation_quality_test.cc.
std::vector<double> subtract_vibration(const UpdatedModel& model, const signals::Record& record);

}  // namespace vibrissa::diagnosis
