// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <utility>

namespace grouser::support {

/// Owns an open file or an end of a pipe. No program that is started inherits it.
class Descriptor {
public:
  explicit Descriptor(int number = -1) : number_(number) {}
  /// Opens a file, with the flags of open(); good() tells success, errno the error.
  Descriptor(const std::filesystem::path& path, int flags);
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor() { close(); }

  bool good() const { return number_ >= 0; }
  operator int() const { return number_; } ///< for functions of the system; -1: closed
  void close();
  /// Waits for bytes and appends them. False at the end.
  bool read(std::string& text) const;
  /// Writes all bytes. False if the reader is gone, without SIGPIPE.
  bool write(const std::string& bytes) const;

private:
  int number_;
};

} // namespace grouser::support
