#pragma once

#include <vector>

#include "diagnosis/model/updated_model.h"
#include "signals/record/record.h"

namespace vibrissa::diagnosis {

/// How a simulated record begins.
enum class Start {
  settled,  // under inputs that were at their first values for long
  periodic  // the inputs are whole periods in steady state
};

/// Base moment [N m] (frame and sign of docs/records.md) that the model reads under a record's base
/// acceleration, cross acceleration and wind speed, in free simulation without noise, one value a
/// sample. Channels that are absent are zero. Throws UserError when the record holds no input that
/// the model knows. Proven by tests/diagnosis/model/updated_model_test.cc.
std::vector<double> simulate_moment(const UpdatedModel& model, const signals::Record& inputs,
                                    Start start = Start::settled);

/// The same under the base's motion alone, as if no wind blew: what a separator subtracts.
std::vector<double> simulate_vibration(const UpdatedModel& model, const signals::Record& inputs);

}  // namespace vibrissa::diagnosis
