#pragma once

#include <vector>

#include "apps/paper_numbers.h"
#include "report/page.h"

namespace vibrissa::apps {

/// The paper's numbers beside ours, its figures, and what was tried. Proven by
/// tests/apps/reproduce_test.cc.
report::Page reproduction_page(const Reproduction& reproduction,
                               const std::vector<report::Figure>& figures);

}  // namespace vibrissa::apps
