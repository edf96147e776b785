// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace grouser::support {

/// A file could not be written, for example on a full disk. The run can resume from its last checkpoint.
class NotWritten : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// "out/drive/picture.png: could not be written; is the disk full?", or the cause that the folder indicates. `what`:
/// the failed operation, such as "could not be written (No space left on device)".
NotWritten notWritten(const std::filesystem::path& file, const std::string& what = "could not be written");

/// Renames a completely written file to its final path. Throws NotWritten on failure.
void putInPlace(const std::filesystem::path& whole, const std::filesystem::path& path);

} // namespace grouser::support
