#pragma once

#include <filesystem>
#include <string>

#include "separation/model/c_header.h"
#include "separation/nonlinear/nonlinear_bvrm.h"

namespace vibrissa::separation {

/// The nonlinear model as a header of standard C (C99) for a microcontroller: single precision, no
/// library, no allocation; NAME_state, NAME_reset() and NAME_step() as the linear c_header(), by
/// the Runge-Kutta steps of the ModeIntegrator. Deflection and speed are in units of the largest
/// ones of the fit, so that no power of them leaves the range of single precision. The hold
/// band_limited, whose filters need future samples, gives the moment of NAME_LAG = 32 samples ago,
/// as the NonlinearSeparator with its latency; else NAME_LAG is 0. Throws UserError as c_header()
/// does for all but this hold. Proven by tests/separation/nonlinear/nonlinear_c_header_test.cc,
/// which compiles the header with the C compiler.
std::string nonlinear_c_header(const NonlinearBvrm& model, const CHeaderOptions& options);
void write_nonlinear_c_header(const std::filesystem::path& file, const NonlinearBvrm& model,
                              const CHeaderOptions& options);

}  // namespace vibrissa::separation
