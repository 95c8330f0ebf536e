#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis {
namespace {

TEST(Prior, OfAFixedParameterIsFinite) {
  for (Parameter parameter :
       {uniform("share", "1", 0., 1., 0.), normal("share", "1", 0., 1., -1., 1., 0.)}) {
    parameter.prior.low = parameter.prior.high = parameter.prior.centre;
    EXPECT_TRUE(std::isfinite(parameter.prior.log_density(parameter.prior.centre)));
    EXPECT_TRUE(std::isfinite(parameter.prior.curvature(parameter.prior.centre)));
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
