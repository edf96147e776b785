// SPDX-License-Identifier: BSD-3-Clause
#include "runs/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace grouser::runs {

namespace {
const std::vector<std::string> kAxes = {"x", "y", "z"};
const std::vector<std::string> kSides = {"left", "right"};
} // namespace

std::vector<std::string> shoeLabels(int shoesPerTrack) {
  std::vector<std::string> labels;
  for (const std::string& side : kSides)
    for (int i = 0; i < shoesPerTrack; ++i) labels.push_back(fmt::format("{} {}", side, i));
  return labels;
}

std::vector<Channel> vehicleChannels(int shoesPerTrack) {
  const int shoes = 2 * shoesPerTrack;
  return {
      {kShoeSinkage, "m", "settled bed surface minus lowest point of the pad; NaN off the ground run", shoes, {}},
      {kShoeHeight, "m", "lowest point of the pad", shoes, {}},
      {kShoePosition, "m", "middle between the pins: x, y, z of each shoe in turn", 3 * shoes, {}},
      {kShoeLoad, "N", "upward force of the ground", shoes, {}},
      {kShoeTension, "N", "force in the joint to the next shoe", shoes, {}},
      {"vehicle/body/position", "m", "chassis frame", 3, kAxes},
      {"vehicle/body/velocity", "m/s", "chassis frame", 3, kAxes},
      {"vehicle/body/pitch", "rad", "nose down is positive", 1, {}},
      {"vehicle/body/roll", "rad", "right side down is positive", 1, {}},
      {"vehicle/sprocket/angle", "rad", "turned since the start", 2, kSides},
      {"vehicle/sprocket/speed", "rad/s", "angular speed", 2, kSides},
      {"vehicle/sprocket/torque", "N m", "of the drive", 2, kSides},
      {"vehicle/ground_force", "N", "of the ground on the vehicle", 3, kAxes},
      {"vehicle/idler/slide", "m", "of the tensioner, forward", 2, kSides},
      {"vehicle/track_tension", "N", "mean over the track's joints", 2, kSides},
      {"vehicle/slip", "-", "1 - v / (omega pitch radius); NaN while the sprockets stand", 1, {}},
  };
}

std::vector<Channel> terrainChannels() {
  return {
      {"terrain/contacts", "-", "pairs of grains in touch", 1, {}},
      {"terrain/max_overlap", "-", "largest overlap in grain radii", 1, {}},
      {"terrain/max_speed", "m/s", "fastest grain", 1, {}},
      {"terrain/rebuilds", "-", "neighbour lists built so far", 1, {}},
  };
}

std::vector<Channel> ledgerChannels() {
  return {
      {"ledger/drive_work", "J", "done by the sprockets' drives", 1, {}},
      {"ledger/kinetic", "J", "of grains and vehicle", 1, {}},
      {"ledger/potential", "J", "in the field of gravity", 1, {}},
      {"ledger/elastic", "J", "in contacts and springs", 1, {}},
      {"ledger/dissipated", "J", "by friction and damping", 1, {}},
      {"ledger/residual", "J", "what does not balance", 1, {}},
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

} // namespace grouser::runs
