#pragma once

#include <string>

namespace vibrissa::separation {

/// Assumed course of the base acceleration between its samples.
enum class Hold {
  first_order,  // straight lines from sample to sample
  zero_order,   // constant until the next sample
  band_limited  // no power above half the sampling rate (an anti-alias filter, or a sum of lines)
};

std::string to_string(Hold hold);
/// Throws UserError that lists the known names.
Hold parse_hold(const std::string& name);

/// Highest angular frequency at which a free oscillation can be distinguished from its aliases
/// under the hold: half the sampling rate; for band_limited the sampling rate (see InputShaper).
double highest_rad_s(Hold hold, double sampling_rate_hz);

}  // namespace vibrissa::separation
