#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "case/case_file.h"
#include "case/inputs.h"
#include "fem/sensor/sensor.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::apps {

/// Repeats the start of the run with the whole solid: how far the reduced model's moment is from
/// it, how far the two routes to the moment are apart, and (when the case wants VTK files) the
/// displacement and stress at every fifth sample, as transient.pvd in the folder.
nlohmann::json check_full_order(const fem::Sensor& sensor, const signals::ReducedModel& model,
                                const sensor_case::Case& parameters,
                                const sensor_case::Inputs& inputs,
                                const std::filesystem::path& folder, bool show_progress);

}  // namespace vibrissa::apps
