// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/stop_signals.hpp"

#include <csignal>

namespace grouser::support {

namespace {

volatile std::sig_atomic_t signalReceived = 0;
struct sigaction formerInterrupt, formerTerminate;

extern "C" void keepSignal(int signal) { signalReceived = signal; }

} // namespace

StopSignals::StopSignals() {
  signalReceived = 0;
  struct sigaction action {};
  action.sa_handler = keepSignal;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, &formerInterrupt);
  sigaction(SIGTERM, &action, &formerTerminate);
  // Whoever started us in the background may have switched interrupts off: leave them off.
  if (formerInterrupt.sa_handler == SIG_IGN) sigaction(SIGINT, &formerInterrupt, nullptr);
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &formerInterrupt, nullptr);
  sigaction(SIGTERM, &formerTerminate, nullptr);
}

int StopSignals::received() { return signalReceived; }

const char* StopSignals::name(int signal) { return signal == SIGTERM ? "SIGTERM" : "SIGINT"; }

} // namespace grouser::support
