// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/progress.hpp"

#include "runs/support/print_stderr.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace grouser::support {

namespace {

using namespace std::chrono_literals;
constexpr auto kTerminalPause = 200ms;
constexpr auto kPlainPause = 5s;

} // namespace

Progress::Progress(std::string what, bool shown, double from, End end)
    : what_(std::move(what)), shown_(shown), terminal_(isatty(STDERR_FILENO) == 1), end_(end), left_(from),
      start_(Clock::now()),
      next_(start_ + (terminal_ ? Clock::duration(kTerminalPause) : Clock::duration(kPlainPause))) {}

Progress::~Progress() {
  if (open_) printStderr("\n");
}

bool Progress::due() const { return shown_ && Clock::now() >= next_; }

void Progress::update(double fraction, const std::string& detail) {
  if (!shown_) return;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  left_.add(elapsed, fraction);
  if (due()) update(fraction, detail, left_.at(elapsed));
}

void Progress::update(double fraction, const std::string& detail, std::optional<double> left) {
  const Clock::time_point now = Clock::now();
  if (!shown_ || now < next_) return;
  next_ = now + (terminal_ ? Clock::duration(kTerminalPause) : Clock::duration(kPlainPause));
  const std::string text = line(what_, fraction, left, detail, end_);
  if (terminal_) {
    clearLine();
    printStderr("{}", text);
    open_ = true;
  } else {
    printStderr("{}\n", text);
  }
  std::fflush(stderr);
}

void Progress::restart(std::string what) { what_ = std::move(what), left_ = TimeLeft(), start_ = Clock::now(); }

void Progress::note(const std::string& line) {
  if (!shown_) return;
  clearLine();
  std::fflush(stderr);
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

void Progress::finish(const std::string& detail) {
  if (!shown_) return;
  clearLine();
  const double elapsed = std::chrono::duration<double>(Clock::now() - begun_).count();
  printStderr("{}: {}, took {}\n", what_, detail, duration(elapsed));
}

void Progress::clearLine() {
  if (open_) std::fputs("\r\033[K", stderr);
  open_ = false;
}

std::string Progress::duration(double seconds) {
  const long s = std::lround(seconds);
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

std::string Progress::line(const std::string& what, double fraction, std::optional<double> left,
                           const std::string& detail, End end) {
  const std::string text =
      left ? fmt::format("{} {} left", end == End::limit ? "at most" : "about", duration(*left)) : "time left unknown";
  return fmt::format("{}: {:5.1f} %, {}, {}", what, 100 * fraction, detail, text);
}

} // namespace grouser::support
