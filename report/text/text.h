#pragma once

#include <cstddef>
#include <string>

namespace vibrissa::report {

/// The value rounded to n_digits significant digits, without trailing zeros ("27", "0.05"); in
/// plain form between 1e-4 and 1e6 and in the form 1.23e-05 outside. Digits before the point are
/// never replaced by zeros: 12345 with three digits stays 12345. NaN gives "-". Proven, as what
/// follows, by tests/report/text/text_test.cc.
std::string significant(double value, int n_digits);

/// A CSV field by RFC 4180: quoted when it contains a comma or a quote. Line breaks become spaces,
/// because many programs read one row per line.
std::string csv_field(const std::string& text);

/// Number of characters (code points) of a UTF-8 text, for aligned columns.
std::size_t n_characters(const std::string& text);

}  // namespace vibrissa::report
