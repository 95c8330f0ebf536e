#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "signals/formats/uff58_file.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::signals::formats {

/// A frequency response base acceleration -> base moment [N m s^2/m], one-sided, over frequencies
/// in Hz, with the sign of exp(+j w t): a moment that lags has a negative phase. Every file says
/// so.

/// What the second line of a function of type 0 says that holds standard deviations.
inline const std::string deviation_title = "standard deviation of the response";

/// For programs of modal analysis: a function of type 4 (frequency response), on even frequencies
/// when the response has them, whose exact start and step stand in the fourth line (others keep six
/// digits, as the format has it). Behind it, where they are known, functions between the same
/// degrees of freedom: one of type 6 (coherence) and one of type 0 (standard deviation).
std::vector<Uff58Function> uff58_of(const FrequencyResponse& response, const std::string& name);

/// Which values of a file are its response, and what they are in.
struct ResponseChoice {
  /// NAME[unit]*FACTOR[unit]..., as parse_scaled_name takes it, all of it optional: "H[mN mm/g]",
  /// "[uT/g]*0.18[N m/T]", "3" for the third function of a Universal File.
  std::string as{};
};

/// Reads a frequency response from what modal analysis and this program write. Universal Files: a
/// complex function of type 4, by its number or first line where there are several, in the units
/// that the file says, and what stands behind it as write_response() puts it. Every other format:
/// columns frequency_hz (or frequency, freq, f) and NAME with real and imaginary part as NAME_real
/// and NAME_imaginary (a complex array of a .mat is both) or, for one response, real and imaginary,
/// or magnitude... and phase_deg (or phase_rad); standard_deviation... and coherence where they
/// are. NAME is response, frf, H, or as given. Lines at zero frequency, or at that of the line
/// before, are left out. Throws UserError for what is missing (lists what there is), frequencies
/// that fall, units that are no moment per acceleration, and what opening the file throws. Proven
/// by tests/signals/formats/response_reader_test.cc and tests/apps/exchange.py.
FrequencyResponse read_response(const std::filesystem::path& file,
                                const ResponseChoice& choice = {});

/// Known by the end of its name: .uff, .unv, .uf58 as above; .mat as frequency_hz, response
/// (complex), convention and, where they are known, coherence and standard_deviation; .csv as
/// response_real and response_imaginary, behind a line that starts with # and states the
/// convention. Throws UserError for any other end, which lists these. Proven by
/// tests/signals/formats/response_file_test.cc and tests/apps/exchange.py.
void write_response(const std::filesystem::path& file, const FrequencyResponse& response,
                    const std::string& name);

}  // namespace vibrissa::signals::formats
