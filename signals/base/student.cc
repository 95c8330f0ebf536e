#include "signals/base/student.h"

#include <boost/math/distributions/students_t.hpp>

namespace vibrissa::signals {

double student_quantile_975(const double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t_distribution<>(degrees_of_freedom), 0.975);
}

}  // namespace vibrissa::signals
