#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "signals/formats/uff58_file.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::signals::formats {

/// A frequency response base acceleration -> base moment [N m s^2/m], one-sided, over frequencies
/// in Hz, with the convention exp(+j w t): a moment that lags has a negative phase. Every file
/// states this convention.

inline const std::string moment_per_acceleration = "N m s^2/m";

/// Second line of a function of type 0 that contains standard deviations.
inline const std::string deviation_title = "standard deviation of the response";

/// Functions for programs of modal analysis. The first is a function of type 4 (frequency
/// response); when the frequencies are uniform, its fourth line contains their exact start and step
/// (the format itself keeps six digits). After it follow, when they are known, functions between
/// the same degrees of freedom: type 6 (coherence) and type 0 (standard deviation).
std::vector<Uff58Function> uff58_of(const FrequencyResponse& response, const std::string& name,
                                    const std::string& unit = moment_per_acceleration);

/// Which values of a file are the response, and their unit.
struct ResponseChoice {
  /// NAME[unit]*FACTOR[unit]..., in the form of parse_scaled_name; each part is optional: "H[mN
  /// mm/g]", "[uT/g]*0.18[N m/T]", "3" for the third function of a Universal File; or conj(...) for
  /// a response with the convention exp(-j w t).
  std::string as{};
  /// SI unit of what responds, where it is no moment, and whether the values are per acceleration
  /// (m/s^2) or the amplitude itself.
  std::string output_unit = "N m";
  bool per_acceleration = true;
  /// Columns of the magnitude and phase, NAME[unit]*FACTOR; empty: by their usual names.
  std::string magnitude{}, phase{};
  /// Lines may also stand in falling order, as a downward sweep writes them.
  bool may_fall = false;
  /// A response whose unit measures something else stays in this unit; otherwise it is refused.
  bool may_keep_unit = false;
};

/// A response of a file, the unit of its values and how this unit was found.
struct FileResponse : FrequencyResponse {
  std::string unit, words;
};

/// Reads a frequency response that a modal analysis program or this program wrote. Universal File:
/// a complex function of type 4 in the units of the file, selected by its number or first line when
/// there are several; coherence and standard deviation as write_response() stores them. Other
/// formats: columns frequency_hz (or frequency, freq, f) and NAME with real and imaginary part as
/// NAME_real and NAME_imaginary (a complex array of a .mat is both) or, for one response, real and
/// imaginary, or magnitude... (in dB where its name or a negative value says so) and phase in deg
/// or rad; and optionally standard_deviation... and coherence. NAME is response, frf, H, or the
/// given name. Lines at 0 Hz, or at the frequency of the previous line, are ignored. A phase may be
/// wrapped. The unit is that of the choice, else that which the file states for the values, else
/// the wanted one. Throws UserError for missing columns or functions (lists the available ones),
/// decreasing frequencies, units that are not a moment per acceleration (unless the choice keeps
/// them), and what opening the file throws. Proven by tests/signals/formats/response_reader_test.cc
/// and tests/apps/exchange.py.
FileResponse read_response(const std::filesystem::path& file, const ResponseChoice& choice = {});

/// Values of one real column, NAME[unit]*FACTOR in this unit, at the lines that read_response()
/// returns. Throws UserError as it does.
std::vector<double> read_response_column(const std::filesystem::path& file,
                                         const std::string& column, const std::string& unit,
                                         const ResponseChoice& choice);

/// Writes a frequency response in the format of the file's ending: .uff, .unv, .uf58 with
/// uff58_of(); .mat with frequency_hz, response (complex), convention and, when they are known,
/// coherence and standard_deviation; .csv with response_real and response_imaginary, after a
/// comment line that states the convention. The values are in this unit, which a .csv and a
/// Universal File state so that read_response() finds it; a .mat states it in convention only.
/// Throws UserError for any other ending (lists these).
/// Proven by tests/signals/formats/response_file_test.cc and tests/apps/exchange.py.
void write_response(const std::filesystem::path& file, const FrequencyResponse& response,
                    const std::string& name, const std::string& unit = moment_per_acceleration);

}  // namespace vibrissa::signals::formats
