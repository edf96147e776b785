// SPDX-License-Identifier: BSD-3-Clause
// Grains from a text file.
#include "base/error.hpp"
#include "runs/scene/scene.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <locale>
#include <sstream>

namespace grouser::scene {

std::vector<Grain> readGrainFile(const std::string& file, const GrainFill& fill) {
  std::ifstream in(file);
  if (!in) throw base::InputError(fmt::format("{}: cannot be read; check the path and its permissions", file));
  std::vector<Grain> grains;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line = line.substr(0, line.find('#'));
    for (char& c : line)
      if (c == ',' || c == ';' || c == '\t' || c == '\r') c = ' ';
    if (line.find_first_not_of(' ') == std::string::npos) continue;
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    base::Vec3d p;
    double radius = 0;
    std::string rest;
    const bool complete = static_cast<bool>(words >> p.x >> p.y >> p.z >> radius);
    if (!complete || (words >> rest) || !(radius > 0 && std::isfinite(radius)))
      throw base::InputError(fmt::format("{}:{}: \"{}\" is not x, y, z, r [m] of a grain with r > 0; correct the line",
                                         file, number, line));
    grains.push_back({p, fill.velocity, fill.spin, radius, fill.material});
  }
  if (grains.empty()) throw base::InputError(fmt::format("{}: holds no grain; give lines of x, y, z, r [m]", file));
  return grains;
}

} // namespace grouser::scene
