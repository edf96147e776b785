// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/sealed_file.hpp"

#include "base/error.hpp"
#include "base/hash.hpp"
#include "base/input_file.hpp"
#include "runs/support/descriptor.hpp"
#include "runs/support/not_written.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

namespace grouser::support {

namespace fs = std::filesystem;

namespace {

/// A file with error messages that contain its path.
class NamedFile : public Descriptor {
public:
  NamedFile(const fs::path& path, int flags) : Descriptor(path, flags), path_(path) {}
  void require(bool done, const char* what) const {
    if (!done) throw notWritten(path_, fmt::format("could not {} ({})", what, std::strerror(errno)));
  }

private:
  fs::path path_;
};

std::string sealText(const char* kind, int version, std::uint64_t bytes, const std::string& checksum) {
  std::string text = fmt::format("grouser {}\nversion {}\nbytes {}\nchecksum {}\n", kind, version, bytes, checksum);
  text.resize(kSealBytes);
  return text;
}

struct Measure {
  std::uint64_t bytes = 0;
  std::string checksum;
};

/// Length and checksum of everything after the seal; `contents`, if given, receives these bytes. Words of eight bytes;
/// zeros complete the last word.
Measure measure(const NamedFile& file, std::string* contents = nullptr) {
  Measure m;
  base::StateHash hash;
  std::vector<char> chunk(1 << 20);
  for (std::uint64_t at = kSealBytes;;) {
    std::size_t filled = 0;
    while (filled < chunk.size()) {
      const ssize_t got = ::pread(file, chunk.data() + filled, chunk.size() - filled, static_cast<off_t>(at + filled));
      if (got < 0 && errno == EINTR) continue;
      file.require(got >= 0, "be read");
      if (got == 0) break;
      filled += static_cast<std::size_t>(got);
    }
    for (std::size_t i = 0; i < filled; i += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, chunk.data() + i, std::min(sizeof word, filled - i));
      hash.add(word);
    }
    if (contents) contents->append(chunk.data(), filled);
    at += filled, m.bytes = at;
    if (filled < chunk.size()) break;
  }
  hash.add(m.bytes);
  m.checksum = hash.hex();
  return m;
}

void seal(const fs::path& path, const char* kind, int version) {
  const NamedFile file(path, O_RDWR);
  file.require(file.good(), "be opened");
  const Measure m = measure(file);
  const std::string text = sealText(kind, version, m.bytes, m.checksum);
  file.require(::pwrite(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()), "be written");
  file.require(::fsync(file) == 0, "be flushed to the disk");
}

/// See checkSeal(); `contents` as in measure().
void check(const fs::path& path, const char* kind, int version, std::string* contents) {
  base::requireInput(path, fmt::format("specify the {} of a run, or start a new run without it", kind));
  const NamedFile file(path, O_RDONLY);
  if (!file.good()) throw base::InputError(fmt::format("{}: cannot be read ({})", path.string(), std::strerror(errno)));
  std::string text(kSealBytes, '\0');
  const bool isSealed = ::pread(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
  const std::string head = fmt::format("grouser {}\nversion ", kind);
  if (!isSealed || text.compare(0, head.size(), head) != 0)
    throw base::InputError(fmt::format("{}: is not a {} of grouser, or is damaged", path.string(), kind));
  const std::size_t end = text.find('\n', head.size());
  const std::string found = text.substr(head.size(), end == std::string::npos ? 0 : end - head.size());
  if (found != std::to_string(version))
    throw base::InputError(fmt::format("{}: is a {} of version {}, but this program reads version {}; use the program "
                                       "that wrote it, or start a new run",
                                       path.string(), kind, found, version));
  const Measure m = measure(file, contents);
  if (text != sealText(kind, version, m.bytes, m.checksum))
    throw base::InputError(fmt::format("{}: the {} is damaged: wrong length or checksum; start a new run without it",
                                       path.string(), kind));
}

} // namespace

void syncFile(const fs::path& path) {
  const NamedFile file(path, O_RDONLY);
  file.require(file.good() && ::fsync(file) == 0, "be flushed to the disk");
}

void writeSealed(const fs::path& path, const char* kind, int version,
                 const std::function<void(const fs::path& part)>& write, const base::Comm& comm) {
  const fs::path part = path.string() + ".part";
  try {
    write(part);
    comm.wait();
    if (!comm.first()) {
      comm.wait();
      return;
    }
    seal(part, kind, version);
    putInPlace(part, path);
  } catch (...) {
    std::error_code error;
    fs::remove(part, error);
    throw;
  }
  syncFile(fs::absolute(path).parent_path()); // makes the new name durable
  comm.wait();
}

void checkSeal(const fs::path& path, const char* kind, int version) { check(path, kind, version, nullptr); }

std::string readSealed(const fs::path& path, const char* kind, int version) {
  std::string contents;
  check(path, kind, version, &contents);
  return contents;
}

} // namespace grouser::support
