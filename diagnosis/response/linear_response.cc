#include "diagnosis/response/linear_response.h"

#include <algorithm>

#include "diagnosis/model/complex_lanes.h"

namespace vibrissa::diagnosis {
namespace {

Complex each(const Filter& filter, const Complex s) {
  return filter(s);
}

ComplexLanes each(const Filter& filter, const ComplexLanes& s) {
  ComplexLanes out;
  for (Eigen::Index lane = 0; lane < signals::n_lanes; ++lane) out.set(lane, filter(s[lane]));
  return out;
}

template <typename C>
C product(const std::vector<Filter>& filters, const C& s) {
  C value = 1.;
  for (const Filter& filter : filters) value *= each(filter, s);
  return value;
}

template <typename C>
C sum(const std::vector<Filter>& filters, const C& s) {
  C value = 0.;
  for (const Filter& filter : filters) value += each(filter, s);
  return value;
}

}  // namespace

LinearResponse::LinearResponse(const Chain& chain) : chain_(chain), joint_(joint_of(chain)) {
  if (chain.structure.has_base)
    per_static_response_ = 1. / chain.structure.base_response(0.).real();
}

template <typename C>
LinearParts<C> LinearResponse::parts(const C& s, const signals::Readout readout,
                                     const bool magnet) const {
  const C reference = product(chain_.reference, s), input = reference * product(chain_.mount, s),
          feedthrough = sum(chain_.feedthrough, s) * reference, sensor = product(chain_.sensor, s);
  if (!magnet)
    return {.base = feedthrough, .wind = 0., .elastic = 0., .cross = 0., .sensor = sensor};
  const auto [base, wind] = chain_.structure.responses(s);
  // From the simulation's readout to the base moment, and from there to this sensor's readout.
  C to_moment = 1., to_reading = 1., elastic = 1., change = 1.;
  if (joint_) {
    const JointModel& joint = *joint_;
    const C ratio = joint.stiffness_ratio(s);
    if (chain_.structure.readout == signals::Readout::rotation) to_moment = ratio;
    // The changed joint relative to its static spring, K(s) (1 + D(s)) / k.
    const C own = joint.changed_stiffness_ratio(s) + ratio * sum(chain_.relaxation, s),
            joined = own + ratio * sum(chain_.support, s);
    elastic = 1. / joined;
    if (readout == signals::Readout::rotation) to_reading = 1. / (chain_.joint_stiffness * own);
    // 1 - P of the joint model times K(s) / k. The modes above the first change H and 1 / (1 + K G)
    // in the same way, so B is that of the load.
    const C rest =
        ratio - joint.share * per_static_response_ * (joint.inertia(s) * base * to_moment);
    C above = joined * ratio, below = ratio * ratio + (joined - ratio) * rest;
    if (joint.change.any()) {
      const C flexibility = joint.share + (1. - joint.share) * joined;
      above *= joined + joint.inertia(s) * flexibility;
      below *= joined + joint.changed_inertia(s) * flexibility;
    }
    change = above / below;
  }
  const C whole = to_moment * to_reading;
  return {.base = (base * change + sum(chain_.parallel, s)) * whole * input + feedthrough,
          .wind = wind * change * whole,
          .elastic = elastic / to_reading,
          .cross = sum(chain_.cross, s) * whole,
          .sensor = sensor};
}

LinearPart LinearResponse::at(const Complex s, const signals::Readout readout,
                              const bool magnet) const {
  return parts(s, readout, magnet);
}

const std::vector<LinearPart>& LinearResponse::lines(const PreparedRecord& record) {
  std::vector<LinearPart>& lines =
      lines_[{record.n_samples, record.sampling_rate_hz, record.readout, record.magnet,
              record.is_response() ? record.number + 1 : 0}];
  if (!lines.empty()) return lines;
  const std::size_t n = record.n_samples / 2 + 1;
  constexpr auto n_lanes = static_cast<std::size_t>(signals::n_lanes);
  lines.reserve(n);
  // Filters may have poles at zero frequency; means are not evaluated.
  for (std::size_t first = 0; first < n; first += n_lanes) {
    ComplexLanes s;
    for (std::size_t i = 0; i < n_lanes; ++i)
      s.set(static_cast<Eigen::Index>(i), record.line_s(std::min(first + i, n - 1)));
    const LinearParts<ComplexLanes> part = parts(s, record.readout, record.magnet);
    for (Eigen::Index i = 0; i < signals::n_lanes && lines.size() < n; ++i)
      lines.push_back({.base = part.base[i],
                       .wind = part.wind[i],
                       .elastic = part.elastic[i],
                       .cross = part.cross[i],
                       .sensor = part.sensor[i]});
  }
  return lines;
}

}  // namespace vibrissa::diagnosis
