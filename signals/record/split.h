#pragma once

namespace vibrissa::signals {

/// fit: used to fit and to select. held_out: only used to score.
enum class Split { fit, held_out };

}  // namespace vibrissa::signals
