#include "diagnosis/linear_response.h"

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
  if (chain.structure.has_base) static_response_ = chain.structure.base_response(0.);
}

LinearPart LinearResponse::at(const Complex s) const {
  const Complex reference = product(chain_.reference, s);
  const Complex input = reference * product(chain_.mount, s);
  const auto [base, wind] = chain_.structure.responses(s);
  LinearPart part{.base = base,
                  .wind = wind,
                  .elastic = 1.,
                  .cross = sum(chain_.cross, s),
                  .sensor = product(chain_.sensor, s)};
  if (joint_) {
    const Complex d = sum(chain_.relaxation, s) + joint_->stiffness_change(s);
    part.elastic = 1. / (joint_->stiffness_ratio(s) * (1. + d));
    // P of the joint model; what the modes above the first do to H they do to 1 / (1 + K G), too: B
    // is that of the load.
    const Complex rest = joint_->compliance(s) * joint_->inertia(s) * base / static_response_;
    Complex change = (1. + d) / (1. + d * (1. - rest));
    if (chain_.joint_change.any()) {
      const Complex compliance = joint_->total_compliance(s, d);
      change *=
          (1. + joint_->inertia(s) * compliance) / (1. + joint_->changed_inertia(s) * compliance);
    }
    part.base *= change;
    part.wind *= change;
  }
  part.base += sum(chain_.parallel, s);
  part.base = part.base * input + sum(chain_.feedthrough, s) * reference;
  return part;
}

const std::vector<LinearPart>& LinearResponse::lines(const PreparedRecord& record) {
  std::vector<LinearPart>& lines = lines_[{record.n_samples, record.sampling_rate_hz}];
  if (!lines.empty()) return lines;
  const std::size_t n = record.n_samples / 2 + 1;
  lines.reserve(n);
  // At zero frequency filters may have poles; means are not judged.
  for (std::size_t k = 0; k < n; ++k) lines.push_back(at(record.line_s(k)));
  return lines;
}

}  // namespace vibrissa::diagnosis
