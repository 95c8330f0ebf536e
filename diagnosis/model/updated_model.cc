#include "diagnosis/model/updated_model.h"

#include <cassert>

namespace vibrissa::diagnosis {

Chain UpdatedModel::chain() const {
  Chain chain{.structure = nominal,
              .joint_share = nominal.joint_share,
              .joint_loss_factor = nominal.joint_loss_factor};
  for (const KnownEffect& known : effects) {
    const Effect& effect = find_effect(known.id);
    assert(known.values.size() == effect.parameters.size());
    effect.extend(chain, known.values, known.scales);
  }
  return chain;
}

}  // namespace vibrissa::diagnosis
