#pragma once

#include <filesystem>
#include <string>

#include "signals/formats/uff58_file.h"
#include "signals/frequency_response.h"

namespace vibrissa::signals::formats {

/// A frequency response base acceleration -> base moment [N m s^2/m], one-sided, over frequencies
/// in Hz, with the sign of exp(+j w t): a moment that lags has a negative phase. Every file says
/// so.

/// For programs of modal analysis: a function of type 4 (frequency response), on even frequencies
/// when the response has them (others keep six digits, as the format has it).
Uff58Function uff58_of(const FrequencyResponse& response, const std::string& name);

/// Known by the end of its name: .uff, .unv, .uf58 as above; .mat as frequency_hz, response
/// (complex), convention and, where they are known, coherence and standard_deviation. Throws
/// UserError for any other end, which lists these. Proven by
/// tests/signals/formats/response_file_test.cc and tests/apps/exchange.py.
void write_response(const std::filesystem::path& file, const FrequencyResponse& response,
                    const std::string& name);

}  // namespace vibrissa::signals::formats
