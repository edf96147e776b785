// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace grouser::support {

/// A new folder for temporary files that other users can neither read nor prepare with links; removed with its contents
/// when this object is destroyed.
class PrivateFolder {
public:
  /// Creates NAME.XXXXXX in `place`, with six random characters; an empty `place`: in the folder for temporary files.
  /// Throws base::InputError if the folder cannot be created.
  explicit PrivateFolder(const std::string& name, const std::filesystem::path& place = {});
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

} // namespace grouser::support
