#pragma once

#include <vector>

#include "report/page/page.h"
#include "reproduction/paper_numbers.h"

namespace vibrissa::reproduction {

/// The paper's numbers beside ours, its figures, and what was tried. Proven by
/// tests/apps/reproduce_test.cc.
report::Page reproduction_page(const Reproduction& reproduction,
                               const std::vector<report::Figure>& figures);

}  // namespace vibrissa::reproduction
