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

/// Throws UserError for what c_header() refuses, other than the hold.
void check(const Bvrm& model, const CHeaderOptions& options);

/// The begin of a header's comment, open: what it holds, rate, hold, delay and modes.
std::string begin_of_comment(const std::string& what, const Bvrm& model,
                             const CHeaderOptions& options);

/// The sampled model as a header of standard C (C99) for a microcontroller: single precision, no
/// library, no allocation; NAME_state, NAME_reset(), and NAME_step(), which takes one sample of the
/// base acceleration and returns the moment of the vibration, as simulate() does from rest. There
/// is one second-order section for each mode, in parallel, in a state form that computes the change
/// of the state: the usual direct form loses precision in single precision when the sampling rate
/// is high compared with the mode. Throws UserError for a model that check() refuses, an invalid
/// sampling rate, a name that is not a C identifier, the band_limited hold (its shaping filter
/// needs future samples) and a moment that leads (negative delay). Proven by
/// tests/separation/model/c_header_test.cc, which compiles the header with the C compiler.
std::string c_header(const Bvrm& model, const CHeaderOptions& options);
void write_c_header(const std::filesystem::path& file, const Bvrm& model,
                    const CHeaderOptions& options);

}  // namespace vibrissa::separation
