#pragma once

#include <vector>

#include "report/page/page.h"
#include "reproduction/paper_numbers.h"

namespace vibrissa::reproduction {

/// Report page: numbers of the paper and of this program, the paper's figures, settings of the
/// adaptive filter. Proven by tests/apps/reproduce_test.cc.
report::Page reproduction_page(const Reproduction& reproduction,
                               const std::vector<report::Figure>& figures);

}  // namespace vibrissa::reproduction
