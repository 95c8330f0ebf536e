#pragma once

#include <string>

#include "separation/nonlinear/identify_nonlinear.h"

namespace vibrissa::views {

/// The sentence on the law, tables of the modes and of the law's coefficients, the errors on unseen
/// data with and without the law, and what was tried.
std::string nonlinear_text(const separation::NonlinearIdentification& found);

}  // namespace vibrissa::views
