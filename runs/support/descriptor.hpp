// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <utility>

namespace grouser::support {

/// Owns an open file or one end of a pipe. Started programs do not inherit it.
class Descriptor {
public:
  explicit Descriptor(int number = -1) : number_(number) {}
  /// Opens a file with the flags of open(). On failure, good() returns false, and errno is set.
  Descriptor(const std::filesystem::path& path, int flags);
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor() { close(); }

  bool good() const { return number_ >= 0; }
  operator int() const { return number_; } ///< for system calls; -1: closed
  void close();
  /// Waits for bytes and appends them. Returns false at the end.
  bool read(std::string& text) const;
  /// Writes all bytes. Returns false, without SIGPIPE, if the other end is closed.
  bool write(const std::string& bytes) const;

private:
  int number_;
};

} // namespace grouser::support
