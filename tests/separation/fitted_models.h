#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "separation/model/fitted_bvrm.h"

namespace vibrissa::separation::test {

// A start that is off by a few per cent, as a rough frequency response gives it.
inline Bvrm disturbed(Bvrm model) {
  double sign = 1.;
  for (ModalTerm& mode : model.modes) {
    mode = make_modal_term(mode.frequency_hz() * (1. + 0.01 * sign),
                           mode.damping_ratio() * (1. + 0.3 * sign), 0.7 * mode.b0 / mode.a0);
    sign = -sign;
  }
  model.direct_term_kg_m = 0.;
  return model;
}

inline void expect_equal_models(const FittedBvrm& fit, Bvrm truth, double tolerance) {
  std::ranges::sort(truth.modes, {}, &ModalTerm::a0);
  ASSERT_EQ(fit.model.modes.size(), truth.modes.size());
  for (std::size_t k = 0; k < truth.modes.size(); ++k) {
    const ModalTerm &found = fit.model.modes[k], &mode = truth.modes[k];
    EXPECT_NEAR(found.a0 / mode.a0, 1., tolerance);
    EXPECT_NEAR(found.a1 / mode.a1, 1., tolerance);
    EXPECT_NEAR(found.b0 / mode.b0, 1., tolerance);
    EXPECT_NEAR(found.b1, mode.b1, tolerance * std::abs(mode.b0) / std::sqrt(mode.a0));
  }
  EXPECT_NEAR(fit.model.direct_term_kg_m, truth.direct_term_kg_m, tolerance * 1e-6);
}

}  // namespace vibrissa::separation::test
