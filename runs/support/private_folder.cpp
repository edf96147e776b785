// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/private_folder.hpp"

#include "base/error.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>

namespace grouser::support {

namespace fs = std::filesystem;

PrivateFolder::PrivateFolder(const std::string& name, const fs::path& place) {
  std::error_code error;
  const fs::path parent = place.empty() ? fs::temp_directory_path(error) : place;
  if (error) throw base::InputError("TMPDIR is not a folder; set it to an existing folder for temporary files");
  std::string pattern = (parent / (name + ".XXXXXX")).string();
  if (!mkdtemp(pattern.data()))
    throw base::InputError(fmt::format(
        "{}: cannot create a temporary folder here ({}); {}", parent.string(), std::strerror(errno),
        place.empty() ? "set TMPDIR to another folder" : "choose another folder, or change its permissions"));
  path_ = pattern;
}

PrivateFolder::~PrivateFolder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

} // namespace grouser::support
