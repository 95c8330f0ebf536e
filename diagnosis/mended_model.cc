#include "diagnosis/mended_model.h"

namespace vibrissa::diagnosis {

Chain MendedModel::chain() const {
  Chain chain{.structure = nominal,
              .joint_share = nominal.joint_share,
              .joint_loss_factor = nominal.joint_loss_factor};
  for (const KnownEffect& known : effects)
    find_effect(known.id).extend(chain, known.values, known.scales);
  return chain;
}

}  // namespace vibrissa::diagnosis
