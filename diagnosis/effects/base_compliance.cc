#include "diagnosis/model/effect.h"
#include "diagnosis/model/joint_model.h"

namespace vibrissa::diagnosis::effects {

Effect base_compliance() {
  return Effect{.id = "base_compliance",
                .about = "a spring under the silicone",
                .link = Link::mount,
                .source = "Grossi and Albarracin 2003, restrained beams; Den Hartog 1956, ch. 2",
                .model_form_error = 0.02,
                .log_prior = -1.5,
                .parameters = {relative("times the stiffness of the joint",
                                        log_uniform("stiffness_ratio", "1", 0.5, 1e4, 1e100))},
                .starts = {{10.}, {30.}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  const std::optional<JointModel> joint = joint_of(chain);
                  if (!joint) return;
                  // K ks / (K + ks) over K: the damper of the silicone keeps its share.
                  chain.support.push_back([ratio = v[0], joint = *joint](Complex s) {
                    const Complex nominal = joint.stiffness_ratio(s);
                    return -nominal / (nominal + ratio);
                  });
                }};
}

}  // namespace vibrissa::diagnosis::effects
