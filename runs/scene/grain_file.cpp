// SPDX-License-Identifier: BSD-3-Clause
// Grains from a text file.
#include "base/error.hpp"
#include "runs/scene/scene.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace grouser::scene {

namespace {

constexpr double kFastest = 1e4, kFastestSpin = 1e6; // [m/s], [rad/s]: as of [[grain]]

} // namespace

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
    std::vector<double> values;
    bool allRead = true;
    for (std::string word; words >> word;) {
      const char *from = word.data() + (word[0] == '+'), *to = word.data() + word.size();
      double value = 0;
      const auto [end, error] = std::from_chars(from, to, value);
      allRead = allRead && error == std::errc() && end == to;
      values.push_back(value);
    }
    const bool finite = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    const std::size_t n = values.size();
    if (!allRead || !finite || (n != 4 && n != 7 && n != 10) || !(values[3] > 0))
      throw base::InputError(fmt::format("{}:{}: \"{}\" is not x, y, z, r [m] of a grain with r > 0, alone, with its "
                                         "velocity vx, vy, vz [m/s], or with that and its spin wx, wy, wz [rad/s]; "
                                         "correct the line",
                                         file, number, line));
    const auto vectorAt = [&](std::size_t at) { return base::Vec3d{values[at], values[at + 1], values[at + 2]}; };
    const base::Vec3d velocity = n >= 7 ? vectorAt(4) : fill.velocity, spin = n >= 10 ? vectorAt(7) : fill.spin;
    for (int a = 0; a < 3; ++a)
      if (std::fabs(velocity[a]) > kFastest || std::fabs(spin[a]) > kFastestSpin)
        throw base::InputError(fmt::format("{}:{}: \"{}\" moves a grain faster than {:g} m/s, or turns it faster than "
                                           "{:g} rad/s; correct the line",
                                           file, number, line, kFastest, kFastestSpin));
    grains.push_back({vectorAt(0), velocity, spin, values[3], fill.material, {}});
  }
  if (grains.empty()) throw base::InputError(fmt::format("{}: holds no grain; give lines of x, y, z, r [m]", file));
  return grains;
}

} // namespace grouser::scene
