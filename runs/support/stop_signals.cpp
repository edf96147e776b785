// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/stop_signals.hpp"

#include <csignal>
#include <utility>

namespace grouser::support {

namespace {

volatile std::sig_atomic_t signalReceived = 0;
/// SIGHUP: the terminal was closed. SIGUSR1: a batch system ends the job soon; mpirun forwards it without killing
/// ranks.
constexpr std::pair<int, const char*> kKept[] = {
    {SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}, {SIGUSR1, "SIGUSR1"}};
struct sigaction former[std::size(kKept)];
int watchers = 0;

extern "C" void keepSignal(int signal) { signalReceived = signal; }

} // namespace

StopSignals::StopSignals() {
  if (watchers++ > 0) return; // nested: does not reset the signal that the outer object received
  signalReceived = 0;
  struct sigaction action {};
  action.sa_handler = keepSignal;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  for (std::size_t i = 0; i < std::size(kKept); ++i) {
    sigaction(kKept[i].first, &action, &former[i]);
    // A signal that is ignored at the start (background, nohup) stays ignored.
    if (former[i].sa_handler == SIG_IGN) sigaction(kKept[i].first, &former[i], nullptr);
  }
}

StopSignals::~StopSignals() {
  if (--watchers > 0) return;
  for (std::size_t i = 0; i < std::size(kKept); ++i) sigaction(kKept[i].first, &former[i], nullptr);
}

int StopSignals::received() { return signalReceived; }

const char* StopSignals::name(int signal) {
  for (const auto& [number, name] : kKept)
    if (number == signal) return name;
  return "a signal";
}

} // namespace grouser::support
