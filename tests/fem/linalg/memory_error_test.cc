#include "fem/linalg/memory_error.h"

#include <deal.II/lac/exceptions.h>
#include <gtest/gtest.h>
#include <petscsys.h>

#include <new>
#include <stdexcept>

namespace vibrissa::fem {
namespace {

TEST(MemoryError, IsToldFromOtherErrors) {
  EXPECT_TRUE(is_out_of_memory(std::bad_alloc()));
  EXPECT_TRUE(is_out_of_memory(dealii::LACExceptions::ExcPETScError(PETSC_ERR_MEM)));
  const int line_of_a_call = 4865;
  EXPECT_TRUE(is_out_of_memory(dealii::LACExceptions::ExcPETScError(line_of_a_call)));
  EXPECT_FALSE(is_out_of_memory(dealii::LACExceptions::ExcPETScError(PETSC_ERR_ARG_SIZ)));
  EXPECT_FALSE(is_out_of_memory(std::runtime_error("not enough memory")));
}

}  // namespace
}  // namespace vibrissa::fem
