// SPDX-License-Identifier: BSD-3-Clause
#include "assets/generator/parts.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>

/// grouser_assets FOLDER: writes the vehicle's meshes there as OBJ. Exit code 2 when a file cannot be written.
int main(int argc, char** argv) {
  if (argc != 2 || argv[1][0] == '-') {
    std::printf("usage: grouser_assets FOLDER\nWrites the vehicle's meshes into FOLDER as OBJ [m].\n");
    return argc == 2 ? 0 : 2;
  }
  const std::filesystem::path folder(argv[1]);
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  for (const auto& part : grouser::assets::vehicleParts()) {
    const auto path = folder / (part.name + ".obj");
    std::ofstream file(path, std::ios::binary);
    const std::string text = grouser::assets::toObj(part);
    file << text;
    file.close();
    if (!file) {
      std::fprintf(stderr, "%s: cannot write; check that the folder exists and is writable\n", path.c_str());
      return 2;
    }
    std::printf("%s: %zu triangles, %zu bytes\n", path.c_str(), part.mesh.indices.size() / 3, text.size());
  }
  return 0;
}
