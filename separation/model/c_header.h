#pragma once

#include <filesystem>
#include <string>

#include "separation/model/input_hold.h"
#include "separation/model/rational_model.h"

namespace vibrissa::separation {

struct CHeaderOptions {
  double sampling_rate_hz = 0.;
  Hold hold = Hold::first_order;
  std::string name = "vibrissa_bvrm";  // prefix of every name in the header
};

/// The sampled model as a header of standard C (C99) for a microcontroller: single precision, no
/// library, no allocation; NAME_state, NAME_reset(), and NAME_step(), which takes one sample of the
/// base acceleration and gives the moment of the vibration that goes with it, as simulate() does
/// from rest. One second-order section a mode, in parallel, as changes of a state that turns and
/// shrinks (complex poles) or decays (real ones): the usual direct form loses what single precision
/// has when the sampling is fast against the mode. Throws UserError for a model
/// that check() refuses, a bad rate, a name that is no C identifier, the band_limited hold (whose
/// shaping filter looks ahead) and a model whose moment leads (negative delay). Proven by
/// tests/separation/model/c_header_test.cc, which compiles the header with the C compiler.
std::string c_header(const Bvrm& model, const CHeaderOptions& options);
void write_c_header(const std::filesystem::path& file, const Bvrm& model,
                    const CHeaderOptions& options);

}  // namespace vibrissa::separation
