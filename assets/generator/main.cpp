// SPDX-License-Identifier: BSD-3-Clause
#include "assets/generator/parts.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace {

constexpr const char* kUsage =
    "usage: grouser_assets FOLDER\n"
    "       grouser_assets --wheel FILE RADIUS WIDTH GROUSERS HEIGHT THICKNESS\n"
    "Writes the meshes of the vehicles and of rigs to FOLDER as OBJ [m]; or writes a wheel to FILE, with GROUSERS [-]\n"
    "straight blades of HEIGHT and THICKNESS on a drum of RADIUS and WIDTH, all in [m].\n";

/// Returns true if the file was written.
bool write(const std::filesystem::path& path, const grouser::assets::NamedMesh& part) {
  std::ofstream file(path, std::ios::binary);
  const std::string text = grouser::assets::toObj(part);
  file << text;
  file.close();
  if (!file) {
    std::fprintf(stderr, "%s: cannot be written; check that the folder exists and is writable\n", path.c_str());
    return false;
  }
  std::printf("%s: %zu triangles, %zu bytes\n", path.c_str(), part.mesh.indices.size() / 3, text.size());
  return true;
}

/// FILE RADIUS WIDTH GROUSERS HEIGHT THICKNESS
int writeWheel(char** words) {
  std::array<double, 5> value{};
  for (std::size_t k = 0; k < value.size(); ++k) {
    const char *text = words[k + 1], *end = text + std::strlen(text);
    const auto [rest, error] = std::from_chars(text, end, value[k]);
    if (error != std::errc() || rest != end || !(value[k] > 0) || !(value[k] < 1000)) {
      std::fprintf(stderr, "grouser_assets --wheel: %s is not a number in (0, 1000)\n%s", text, kUsage);
      return 2;
    }
  }
  try {
    const grouser::assets::GrouserWheelDims dims{value[0], value[1], static_cast<int>(value[2]), value[3], value[4], 6};
    const std::filesystem::path path = words[0];
    return write(path, {path.stem().string(), grouser::assets::grouserWheel(dims)}) ? 0 : 2;
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "grouser_assets --wheel: %s\n", fault.what());
    return 2;
  }
}

} // namespace

/// Returns exit code 2 for wrong arguments, and if a file cannot be written.
int main(int argc, char** argv) {
  if (argc == 8 && std::string_view(argv[1]) == "--wheel") return writeWheel(argv + 2);
  if (argc != 2 || argv[1][0] == '-') {
    std::printf("%s", kUsage);
    return argc == 2 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h") ? 0 : 2;
  }
  const std::filesystem::path folder(argv[1]);
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  std::filesystem::create_directories(folder / "m113", ignored);
  std::filesystem::create_directories(folder / "robot", ignored);
  for (const auto& parts : {grouser::assets::vehicleParts(), grouser::assets::m113Parts(),
                            grouser::assets::robotParts(), grouser::assets::rigParts()})
    for (const auto& part : parts)
      if (!write(folder / (part.name + ".obj"), part)) return 2;
  return 0;
}
