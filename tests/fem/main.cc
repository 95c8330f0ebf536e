#include <gmock/gmock.h>

#include "fem/linalg/solver_session.h"

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  const vibrissa::fem::SolverSession session;
  return RUN_ALL_TESTS();
}
