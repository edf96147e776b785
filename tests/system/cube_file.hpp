// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <string>
#include <unistd.h>

namespace grouser {

/// File of a cube with edges of 2, in the file's units, about its origin.
inline std::string cubeFile() {
  static const std::string path = [] {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("grouser_cube_{}.obj", ::getpid());
    std::ofstream out(file);
    for (const int k : {0, 1, 2, 3, 4, 5, 6, 7})
      out << "v " << (k & 1 ? 1 : -1) << " " << (k & 2 ? 1 : -1) << " " << (k & 4 ? 1 : -1) << "\n";
    out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    return file.string();
  }();
  return path;
}

} // namespace grouser
