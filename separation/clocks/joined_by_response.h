#pragma once

#include <string>

#include "signals/files/joined_recording.h"

namespace vibrissa::separation {

/// Two devices, one with the base acceleration and one with the base moment, on one clock by what
/// both saw of the same motion (signals::relate_clocks of a response). The drift is that of the
/// phase between the channels over time. The phase itself belongs to the sensor and to the offset:
/// an elastic moment is assumed (elastic_delay), so a viscous part of the moment counts as offset.
/// `sensor_part_s` is how much of it may be the sensor's: the delay of its response at low
/// frequency, 2 zeta / w0 of one mode, which a viscous moment would take away. The offset's
/// deviation contains it. Throws UserError as relate_clocks does, and where no elastic response
/// fits. Proven by tests/separation/clocks/joined_by_response_test.cc.
struct ResponseClocks {
  signals::ClockRelation clocks;
  double sensor_part_s = 0.;
};
ResponseClocks clocks_by_response(const signals::Recording& one, const signals::Recording& other);

/// Whether one has the base acceleration and the other the base moment.
bool has_response_between(const signals::Recording& one, const signals::Recording& other);

/// signals::joined by clocks_by_response.
signals::Recording joined_by_response(const signals::Recording& one,
                                      const signals::Recording& other);

}  // namespace vibrissa::separation
