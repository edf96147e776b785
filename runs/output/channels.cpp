// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace grouser::output {

namespace {} // namespace

std::vector<Channel> terrainChannels() {
  return {
      {"terrain/contacts", "-", "pairs of grains in touch", 1, {}},
      {"terrain/boundary_contacts", "-", "contacts of grains with planes, floor and surfaces", 1, {}},
      {"terrain/part_contacts", "-", "contacts of grains with parts of a vehicle and meshes", 1, {}},
      {"terrain/max_overlap", "-", "largest overlap in grain radii", 1, {}},
      {"terrain/squeezed", "-", "pairs of grains that overlap by more than 0.2 of the smaller radius", 1, {}},
      {"terrain/squeezed_at_boundaries", "-", "contacts of grains with planes, floor and surfaces, as deep", 1, {}},
      {"terrain/squeezed_by_parts", "-", "contacts of grains with parts and meshes, as deep", 1, {}},
      {"terrain/part_overlap",
       "-",
       "greatest overlap with a part or mesh since the last row, in radii of its grain",
       1,
       {}},
      {"terrain/part_overlap_by",
       "-",
       "that part's place among the names of the attribute parts of /; -1: none",
       1,
       {}},
      {"terrain/capped", "-", "contacts of grains with parts at the force at which they crush", 1, {}},
      {"terrain/crushed", "-", "grains crushed to their middle by parts and taken out, since the start", 1, {}},
      {"terrain/cut_impulse",
       "N s",
       "that springs of these would have given more without crushing, since the start",
       1,
       {}},
      {"terrain/max_speed", "m/s", "fastest grain", 1, {}},
      {"terrain/rebuilds", "-", "neighbour lists built so far", 1, {}},
  };
}

std::vector<Channel> surfaceChannels(const std::string& name, bool hasPivot) {
  const std::string group = "surfaces/" + name + "/";
  std::vector<Channel> channels{
      {group + "force", "N", "of the grains on it, mean since the last row", 3, kAxes},
      {group + "torque", "N m", "of the grains on it about its centre, mean since the last row", 3, kAxes},
      {group + "power", "W", "of what moves it, mean since the last row", 1, {}},
      {group + "position", "m", "of its centre", 3, kAxes},
  };
  if (hasPivot)
    channels.push_back(
        {group + "pivot_torque", "N m", "of the grains on it about its pivot, mean since the last row", 3, kAxes});
  return channels;
}

std::vector<Channel> obstacleChannels(const std::string& name) {
  return {{"obstacles/" + name + "/force", "N", "of the vehicle on it, mean since the last row", 3, kAxes}};
}

std::vector<Channel> hitchChannels() {
  return {
      {"hitch/force", "N", "of the hitch on the vehicle, mean since the last row", 3, {"forward", "left", "up"}},
      {"hitch/pull",
       "N",
       "drawbar pull: of the vehicle on the hitch in the direction of motion, mean since the last row",
       1,
       {}},
      {"hitch/speed", "m/s", "of the hitch point along the heading, mean since the last row", 1, {}},
      {"hitch/power", "W", "that the hitch takes from the vehicle, mean since the last row", 1, {}},
      {"hitch/work", "J", "by the hitch on the vehicle since the start, part of ledger/drive_work", 1, {}},
      {"hitch/towed_way", "m", "of sled or carriage since the hitch took hold", 1, {}},
      {"hitch/towed_speed", "m/s", "of sled or carriage", 1, {}},
  };
}

std::vector<Channel> gearChannels() {
  return {
      {"gear/grains_on_shoes", "-", "pairs of grain and shoe in touch", 1, {}},
      {"gear/grains_on_sprockets", "-", "the same of sprockets", 1, {}},
      {"gear/grains_on_road_wheels", "-", "the same of road wheels", 1, {}},
      {"gear/grains_on_rollers", "-", "the same of rollers", 1, {}},
      {"gear/grains_on_idlers", "-", "the same of idlers", 1, {}},
      {"gear/grains_on_hull", "-", "the same of the hull", 1, {}},
      {"gear/stones", "-", "grains that touch a sprocket, road wheel, roller or idler", 1, {}},
      {"gear/pinched_stones", "-", "those of them that touch a shoe too", 1, {}},
  };
}

std::vector<Channel> ledgerChannels() {
  return {
      {"ledger/drive_work", "J", "done by drives, moving surfaces and the hitch", 1, {}},
      {"ledger/kinetic", "J", "of grains, vehicle and bodies", 1, {}},
      {"ledger/potential", "J", "in the field of gravity", 1, {}},
      {"ledger/elastic", "J", "in contacts and springs", 1, {}},
      {"ledger/dissipated", "J", "sum of the eight below", 1, {}},
      {"ledger/dissipated_damping", "J", "by dashpots of grains' contacts", 1, {}},
      {"ledger/dissipated_friction", "J", "by sliding of grains", 1, {}},
      {"ledger/dissipated_micro_slip",
       "J",
       "by tangential springs of Hertz' law as their stiffness follows the load",
       1,
       {}},
      {"ledger/dissipated_rolling", "J", "by rolling resistance of grains", 1, {}},
      {"ledger/dissipated_yielding", "J", "by plastic work of grains' contacts", 1, {}},
      {"ledger/dissipated_crushing", "J", "by grains that crush against parts", 1, {}},
      {"ledger/dissipated_parts",
       "J",
       "by contacts of rigid parts with each other, with rigid ground and surfaces",
       1,
       {}},
      {"ledger/dissipated_joints", "J", "by dampers and end stops of joints and springs", 1, {}},
      {"ledger/integration_error",
       "J",
       "lost (or, where negative, made) by steps of finite length: drive work less kinetic, potential, elastic and "
       "dissipated",
       1,
       {}},
      {"ledger/residual", "J", "kinetic energy less the work of all forces on the bodies: rounding", 1, {}},
      {"ledger/turnover", "J", "sum of the absolute work on each body in each step", 1, {}},
      {"ledger/momentum", "N s", "of grains, vehicle and bodies", 3, kAxes},
      {"ledger/angular_momentum", "N m s", "the same about the world's origin", 3, kAxes},
      {"ledger/momentum_residual", "N s", "momentum less the impulses of gravity, ground and surfaces: rounding", 3,
       kAxes},
      {"ledger/angular_residual", "N m s",
       "angular momentum less the same impulses' moments: rounding; none with periodic boundaries", 3, kAxes},
      {"ledger/impulse_residual", "N s", "impulse on vehicle plus impulse on bed", 3, kAxes},
  };
}

RowBuilder::RowBuilder(const std::vector<Channel>& channels) {
  std::size_t first = 0;
  for (const Channel& c : channels) {
    slots_[c.path] = {first, static_cast<std::size_t>(c.width)};
    first += static_cast<std::size_t>(c.width);
  }
  row_.values.resize(first);
}

void RowBuilder::begin(std::int64_t step, double time) {
  row_.step = step, row_.time = time;
  std::fill(row_.values.begin(), row_.values.end(), std::numeric_limits<double>::quiet_NaN());
}

void RowBuilder::set(const std::string& path, const double* values, std::size_t count) {
  const auto slot = slots_.find(path);
  if (slot == slots_.end()) throw std::logic_error("no channel " + path);
  if (slot->second.width != count)
    throw std::logic_error(fmt::format("channel {} takes {} numbers, not {}", path, slot->second.width, count));
  std::copy(values, values + count, row_.values.begin() + static_cast<std::ptrdiff_t>(slot->second.first));
}

void RowBuilder::setFrom(const std::string& first, const std::vector<double>& values) {
  const auto slot = slots_.find(first);
  if (slot == slots_.end()) throw std::logic_error("no channel " + first);
  if (slot->second.first + values.size() > row_.values.size())
    throw std::logic_error("more numbers than channels from " + first);
  std::copy(values.begin(), values.end(), row_.values.begin() + static_cast<std::ptrdiff_t>(slot->second.first));
}

} // namespace grouser::output
