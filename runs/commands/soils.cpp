// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/soils.hpp"

#include "base/error.hpp"
#include "base/table.hpp"
#include "runs/commands/commands.hpp"
#include "runs/scene/soil_constants.hpp"
#include "runs/support/locations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace grouser::commands {

namespace fs = std::filesystem;

using scene::Soil;
using scene::SoilQuantity;

namespace {

/// Path of a scene in the folder; the scene need not exist.
fs::path sceneIn(const fs::path& folder) { return folder / "scene.toml"; }

/// "1.1", "20 to 25": a constant in units of `unit` SI units, or its range in the literature.
std::string published(const Soil& soil, SoilQuantity quantity, double unit) {
  const auto found = std::find_if(soil.published.begin(), soil.published.end(),
                                  [&](const scene::PublishedConstant& c) { return c.quantity == quantity; });
  if (found == soil.published.end()) return "";
  const double low = found->low.value_or(found->value), high = found->high.value_or(found->value);
  return low < high ? fmt::format("{:.5g} to {:.5g}", low / unit, high / unit)
                    : fmt::format("{:.5g}", found->value / unit);
}

/// "7", "7 to 20": grain radii at which a soil was calibrated, or its default radius [mm].
std::string radii(const Soil& soil) {
  const auto [least, greatest] = soil.grains.calibratedRadii;
  return least < greatest ? fmt::format("{:g} to {:g}", 1000 * least, 1000 * greatest)
                          : fmt::format("{:g}", 1000 * soil.grains.radius);
}

std::string state(const Soil& soil) { return soil.head.calibrated ? "calibrated" : "uncalibrated"; }

/// " +- 0.078 - (assumed)" for constants of the soil contact model; only the unit for other constants.
std::string intervalAndUnit(const std::vector<scene::ContactConstant>& constants, SoilQuantity quantity) {
  for (const scene::ContactConstant& c : constants)
    if (c.quantity == quantity && c.halfWidth() > 0)
      return fmt::format(" +- {:.2g} {}{}", c.halfWidth(), unitOf(quantity), c.isAssumed ? " (assumed)" : "");
  return " " + unitOf(quantity);
}

std::string reachedRows(const std::vector<Soil>& soils) {
  std::string rows;
  for (const Soil& soil : soils)
    for (const scene::ReachedConstant& c : soil.reached)
      rows += fmt::format("| {} | {} | {:.5g} +- {:.2g} | {} | {:g} | `{}` |\n", soil.name, base::wordOf(c.quantity),
                          c.value, c.halfWidth, c.unit, 1000 * c.grainRadius, c.command);
  return rows;
}

} // namespace

std::string soilsTable() {
  std::vector<Soil> soils;
  const fs::path own = fs::weakly_canonical(support::shareFolder() / "assets" / "soils");
  for (const auto& [name, file] : scene::knownSoils(sceneIn(own.parent_path())))
    if (file.parent_path() == own) soils.push_back(scene::readSoil(file));
  std::string text = "| soil | | n [-] | k_c [kN/m^(n+1)] | k_phi [kN/m^(n+2)] | c [kPa] | phi [deg] | K [mm] | grain "
                     "radius [mm] | |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Soil& soil : soils)
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", soil.name, soil.head.title,
                        published(soil, SoilQuantity::exponent, 1), published(soil, SoilQuantity::cohesiveModulus, 1e3),
                        published(soil, SoilQuantity::frictionalModulus, 1e3),
                        published(soil, SoilQuantity::cohesion, 1e3), published(soil, SoilQuantity::frictionAngle, 1),
                        published(soil, SoilQuantity::shearModulus, 1e-3), radii(soil), state(soil));
  const std::string reached = reachedRows(soils);
  if (!reached.empty())
    text += "\n| soil | reached | | unit | grain radius [mm] | measured by |\n|---|---|---|---|---|---|\n" + reached;
  return text;
}

std::string soilsList(const fs::path& folder) {
  const auto known = scene::knownSoils(sceneIn(folder));
  std::string text;
  std::size_t width = 0, titles = 0;
  std::vector<Soil> soils;
  for (const auto& [name, file] : known) {
    soils.push_back(scene::readSoil(file));
    width = std::max(width, name.size()), titles = std::max(titles, soils.back().head.title.size());
  }
  for (const Soil& soil : soils) {
    std::string constants;
    for (const scene::PublishedConstant& c : soil.published)
      constants += (constants.empty() ? "" : ", ") + std::string(base::wordOf(c.quantity));
    text += fmt::format("{:<{}}  {:<{}}  {:<12}  grains {} mm; published: {}\n", soil.name, width, soil.head.title,
                        titles, state(soil), radii(soil), constants.empty() ? "nothing" : constants);
  }
  return text.empty() ? fmt::format("{}\n", scene::soilHint("", sceneIn(folder))) : text;
}

std::string soilText(const std::string& word, const fs::path& folder) {
  std::vector<fs::path> tried;
  const fs::path file = scene::findSoil(word, sceneIn(folder), tried);
  if (file.empty())
    throw base::InputError(fmt::format("soils {}: no such soil; {}", word, scene::soilHint(word, sceneIn(folder))));
  const Soil soil = scene::readSoil(file);
  std::string text = fmt::format("{}: {}, {}\n{}\n  {} ({})\n\n", soil.name, soil.head.title, state(soil),
                                 soil.head.description, soil.file.string(), soil.hash);
  text +=
      fmt::format("grains: radius {:g} mm +- {:g} %, {}\n", 1000 * soil.grains.radius, 100 * soil.grains.radiusSpread,
                  soil.grains.porosity ? fmt::format("porosity {:g}", *soil.grains.porosity) : "as poured");
  text += "\npublished, with 95 % intervals of the constants of the soil contact model\n";
  const std::vector<scene::ContactConstant> constants =
      scene::contactConstants(soil, scene::SoilConstantsFrom::published);
  for (const scene::PublishedConstant& c : soil.published) {
    const std::string span =
        c.low || c.high ? fmt::format(" ({:g} to {:g})", c.low.value_or(c.value), c.high.value_or(c.value)) : "";
    text += fmt::format("  {:<13} {:g}{}{}: {}\n", base::wordOf(c.quantity), c.value, span,
                        intervalAndUnit(constants, c.quantity), c.source);
  }
  if (constants.size() == scene::kContactQuantities.size())
    text += "  " + scene::jointDistributionText(constants) + "\n";
  if (soil.published.empty()) text += "  nothing\n";
  text += "\nmeasured with its contact parameters\n";
  for (const scene::ReachedConstant& c : soil.reached)
    text += fmt::format("  {:<13} {:g} +- {:.2g} {} with grains of {:g} mm: {}\n", base::wordOf(c.quantity), c.value,
                        c.halfWidth, c.unit, 1000 * c.grainRadius, c.command);
  if (soil.reached.empty()) text += "  no measurements yet\n";
  return text;
}

void soilsCommand(const SoilsCommand& command) {
  const fs::path here = fs::current_path();
  fmt::print("{}", command.markdown       ? soilsTable()
                   : command.soil.empty() ? soilsList(here)
                                          : soilText(command.soil, here));
}

} // namespace grouser::commands
