// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/descriptor.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

namespace grouser::support {

Descriptor::Descriptor(const std::filesystem::path& path, int flags)
    : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

void Descriptor::close() {
  if (good()) ::close(number_);
  number_ = -1;
}

bool Descriptor::read(std::string& text) const {
  std::array<char, 4096> buffer;
  ssize_t n = 0;
  while ((n = ::read(number_, buffer.data(), buffer.size())) < 0 && errno == EINTR) continue;
  if (n > 0) text.append(buffer.data(), static_cast<std::size_t>(n));
  return n > 0;
}

bool Descriptor::write(const std::string& bytes) const {
  const auto former = std::signal(SIGPIPE, SIG_IGN);
  std::size_t sent = 0;
  for (ssize_t n = 0; sent < bytes.size() && (n >= 0 || errno == EINTR);) {
    n = ::write(number_, bytes.data() + sent, bytes.size() - sent);
    if (n > 0) sent += static_cast<std::size_t>(n);
  }
  std::signal(SIGPIPE, former);
  return sent == bytes.size();
}

} // namespace grouser::support
