#include "signals/student.h"

#include <cmath>

namespace vibrissa::signals {

double student_quantile_975(const double degrees_of_freedom) {
  constexpr double z = normal_quantile_975;
  const double nu = degrees_of_freedom;
  return z + (std::pow(z, 3) + z) / (4. * nu) +
         (5. * std::pow(z, 5) + 16. * std::pow(z, 3) + 3. * z) / (96. * nu * nu);
}

}  // namespace vibrissa::signals
