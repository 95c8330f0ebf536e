#include "signals/system/interruption.h"

#include <csignal>

namespace vibrissa::signals {

namespace {

volatile std::sig_atomic_t requested = 0;

constexpr int polite[] = {SIGINT, SIGTERM};

void note(int) {
  requested = 1;
}

}  // namespace

Interruption::Interruption() {
  requested = 0;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (const int signal : polite) sigaction(signal, &action, nullptr);
}

Interruption::~Interruption() {
  for (const int signal : polite) std::signal(signal, SIG_DFL);
}

bool Interruption::is_requested() const {
  return requested != 0;
}

}  // namespace vibrissa::signals
