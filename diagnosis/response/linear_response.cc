#include "diagnosis/response/linear_response.h"

namespace vibrissa::diagnosis {
namespace {

Complex product(const std::vector<Filter>& filters, Complex s) {
  Complex value = 1.;
  for (const Filter& filter : filters) value *= filter(s);
  return value;
}

Complex sum(const std::vector<Filter>& filters, Complex s) {
  Complex value = 0.;
  for (const Filter& filter : filters) value += filter(s);
  return value;
}

}  // namespace

LinearResponse::LinearResponse(const Chain& chain) : chain_(chain), joint_(joint_of(chain)) {
  if (chain.structure.has_base) per_static_response_ = 1. / chain.structure.base_response(0.);
}

LinearPart LinearResponse::at(const Complex s, const signals::Readout readout,
                              const bool magnet) const {
  const Complex reference = product(chain_.reference, s),
                input = reference * product(chain_.mount, s),
                feedthrough = sum(chain_.feedthrough, s) * reference,
                sensor = product(chain_.sensor, s);
  if (!magnet)
    return {.base = feedthrough, .wind = 0., .elastic = 0., .cross = 0., .sensor = sensor};
  const auto [base, wind] = chain_.structure.responses(s);
  // From the simulation's readout to the base moment, and from there to this sensor's readout.
  Complex to_moment = 1., to_reading = 1., elastic = 1., change = 1.;
  if (joint_) {
    const JointModel& joint = *joint_;
    const Complex ratio = joint.stiffness_ratio(s);
    if (chain_.structure.readout == signals::Readout::rotation) to_moment = ratio;
    // The changed joint relative to its static spring, K(s) (1 + D(s)) / k. Divisions dominate the
    // cost here.
    const Complex own = joint.changed_stiffness_ratio(s) + ratio * sum(chain_.relaxation, s),
                  joined = own + ratio * sum(chain_.support, s);
    elastic = 1. / joined;
    if (readout == signals::Readout::rotation) to_reading = 1. / (chain_.joint_stiffness * own);
    // 1 - P of the joint model times K(s) / k. The modes above the first change H and 1 / (1 + K G)
    // in the same way, so B is that of the load.
    const Complex rest =
        ratio - joint.share * joint.inertia(s) * base * to_moment * per_static_response_;
    Complex above = joined * ratio, below = ratio * ratio + (joined - ratio) * rest;
    if (joint.change.any()) {
      const Complex flexibility = joint.share + (1. - joint.share) * joined;
      above *= joined + joint.inertia(s) * flexibility;
      below *= joined + joint.changed_inertia(s) * flexibility;
    }
    change = above / below;
  }
  const Complex whole = to_moment * to_reading;
  return {.base = (base * change + sum(chain_.parallel, s)) * whole * input + feedthrough,
          .wind = wind * change * whole,
          .elastic = elastic / to_reading,
          .cross = sum(chain_.cross, s) * whole,
          .sensor = sensor};
}

const std::vector<LinearPart>& LinearResponse::lines(const PreparedRecord& record) {
  std::vector<LinearPart>& lines =
      lines_[{record.n_samples, record.sampling_rate_hz, record.readout, record.magnet,
              record.is_response() ? record.number + 1 : 0}];
  if (!lines.empty()) return lines;
  const std::size_t n = record.n_samples / 2 + 1;
  lines.reserve(n);
  // Filters may have poles at zero frequency; means are not evaluated.
  for (std::size_t k = 0; k < n; ++k)
    lines.push_back(at(record.line_s(k), record.readout, record.magnet));
  return lines;
}

}  // namespace vibrissa::diagnosis
