// SPDX-License-Identifier: BSD-3-Clause
// Each column contains the quantity that its name states.
#include "runs/output/channels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace grouser::output {
namespace {

using base::Vec3d;

/// Values of all columns by their paths.
template <class Source>
std::map<std::string, std::vector<double>> valuesOf(const Columns<Source>& columns, const Source& source) {
  std::vector<double> values;
  columns.append(source, values);
  std::map<std::string, std::vector<double>> byPath;
  std::size_t at = 0;
  for (const Channel& c : columns.channels())
    for (int k = 0; k < c.width; ++k) byPath[c.path].push_back(values.at(at++));
  EXPECT_EQ(at, values.size());
  return byPath;
}

using Numbers = std::vector<double>;

TEST(Channels, OfTheLedgerReadEachItsOwnField) {
  coupling::Ledger l;
  l.driveWork = 1, l.kinetic = 2, l.potential = 3, l.elastic = 4;
  l.dissipated = {10, 20, 30, 40, 50, 60, 70, 80};
  l.integrationError = 5, l.residual = 6, l.turnover = 7;
  l.momentum = {1, 2, 3}, l.angularMomentum = {4, 5, 6};
  l.momentumResidual = {7, 8, 9}, l.angularResidual = {10, 11, 12}, l.impulseResidual = {13, 14, 15};
  const std::map<std::string, Numbers> expected = {{"ledger/drive_work", {1}},
                                                   {"ledger/kinetic", {2}},
                                                   {"ledger/potential", {3}},
                                                   {"ledger/elastic", {4}},
                                                   {"ledger/dissipated", {360}},
                                                   {"ledger/dissipated_damping", {10}},
                                                   {"ledger/dissipated_friction", {20}},
                                                   {"ledger/dissipated_micro_slip", {30}},
                                                   {"ledger/dissipated_rolling", {40}},
                                                   {"ledger/dissipated_yielding", {50}},
                                                   {"ledger/dissipated_crushing", {60}},
                                                   {"ledger/dissipated_parts", {70}},
                                                   {"ledger/dissipated_joints", {80}},
                                                   {"ledger/integration_error", {5}},
                                                   {"ledger/residual", {6}},
                                                   {"ledger/turnover", {7}},
                                                   {"ledger/momentum", {1, 2, 3}},
                                                   {"ledger/angular_momentum", {4, 5, 6}},
                                                   {"ledger/momentum_residual", {7, 8, 9}},
                                                   {"ledger/angular_residual", {10, 11, 12}},
                                                   {"ledger/impulse_residual", {13, 14, 15}}};
  EXPECT_EQ(valuesOf(ledgerColumns(), l), expected);
  EXPECT_FALSE(valuesOf(ledgerColumns({.touching = false}), l).contains("ledger/impulse_residual")) << "of a mechanism";
}

TEST(Channels, SoilEnergiesFollowThoseOfAllLedgers) {
  coupling::Ledger l;
  l.soil = {1, 2, 3, 4, 8, 5, 6, 7};
  l.dissipated.soil = l.soil.lost();
  std::map<std::string, Numbers> found = valuesOf(ledgerColumns({.deforms = true}), l);
  const std::map<std::string, Numbers> expected = {
      {"ledger/soil_elastic_pressure", {1}}, {"ledger/soil_elastic_shear", {2}},
      {"ledger/soil_compaction", {3}},       {"ledger/soil_shear", {4}},
      {"ledger/soil_damping", {5}},          {"ledger/soil_edges", {6}},
      {"ledger/soil_coupling", {7}},         {"ledger/soil_slip_sinkage", {8}},
      {"ledger/dissipated_soil", {33}}};
  for (const auto& [path, numbers] : expected) EXPECT_EQ(found[path], numbers) << path;
  EXPECT_EQ(found["ledger/dissipated"], Numbers{33}) << "part of the sum";
  EXPECT_EQ(found.size(), valuesOf(ledgerColumns(), l).size() + expected.size());
}

TEST(Channels, OfTheBedReadLedgerAndWhatHasPressedAGrainMost) {
  TerrainReading bed;
  coupling::Ledger& l = bed.ledger;
  l.grainContacts = 1, l.boundaryContacts = 2, l.partContacts = 3, l.deepestOverlap = 0.5;
  l.deepPairs = 4, l.deepAtBoundaries = 5, l.deepByParts = 6;
  l.cappedNow = 7, l.cutImpulse = 8, l.fastestGrain = 9;
  bed.radius = 0.25, bed.crushed = 10, bed.rebuilds = 11;
  const auto alone = valuesOf(terrainColumns(), bed);
  EXPECT_TRUE(std::isnan(alone.at("terrain/part_overlap").front())) << "no part touches grains";
  EXPECT_TRUE(std::isnan(alone.at("terrain/part_overlap_by").front()));
  bed.deepestPartOverlap = coupling::DeepestPartOverlap{12, 0, 0.125};
  const std::map<std::string, Numbers> expected = {
      {"terrain/contacts", {1}},          {"terrain/boundary_contacts", {2}},
      {"terrain/part_contacts", {3}},     {"terrain/max_overlap", {2}},
      {"terrain/squeezed", {4}},          {"terrain/squeezed_at_boundaries", {5}},
      {"terrain/squeezed_by_parts", {6}}, {"terrain/part_overlap", {0.125}},
      {"terrain/part_overlap_by", {12}},  {"terrain/capped", {7}},
      {"terrain/crushed", {10}},          {"terrain/cut_impulse", {8}},
      {"terrain/max_speed", {9}},         {"terrain/rebuilds", {11}}};
  EXPECT_EQ(valuesOf(terrainColumns(), bed), expected);
}

TEST(Channels, OfSurfacesHitchAndGearReadEachItsOwnField) {
  const coupling::Surfaces::Observation seen{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, 10, {11, 12, 13}};
  const std::map<std::string, Numbers> drum = {{"surfaces/drum/force", {1, 2, 3}},
                                               {"surfaces/drum/torque", {4, 5, 6}},
                                               {"surfaces/drum/pivot_torque", {7, 8, 9}},
                                               {"surfaces/drum/power", {10}},
                                               {"surfaces/drum/position", {11, 12, 13}}};
  EXPECT_EQ(valuesOf(surfaceColumns("drum", true), seen), drum);
  EXPECT_FALSE(valuesOf(surfaceColumns("drum"), seen).contains("surfaces/drum/pivot_torque"));
  EXPECT_EQ(valuesOf(obstacleColumns("log"), Vec3d{1, 2, 3}).at("obstacles/log/force"), (Numbers{1, 2, 3}));

  const HitchReading hitch{{{1, 2, 3}, 4, 5, 6, 7, 8, 9}, 10};
  const std::map<std::string, Numbers> pulled = {
      {"hitch/force", {1, 2, 3}}, {"hitch/pull", {10}},     {"hitch/speed", {5}},      {"hitch/power", {6}},
      {"hitch/work", {7}},        {"hitch/towed_way", {8}}, {"hitch/towed_speed", {9}}};
  EXPECT_EQ(valuesOf(hitchColumns(), hitch), pulled);

  const coupling::GearContacts touched{1, 2, 3, 4, 5, 6, 7, 8};
  const std::map<std::string, Numbers> gear = {{"gear/grains_on_shoes", {1}},
                                               {"gear/grains_on_sprockets", {2}},
                                               {"gear/grains_on_road_wheels", {3}},
                                               {"gear/grains_on_rollers", {4}},
                                               {"gear/grains_on_idlers", {5}},
                                               {"gear/grains_on_hull", {6}},
                                               {"gear/stones", {7}},
                                               {"gear/pinched_stones", {8}}};
  EXPECT_EQ(valuesOf(gearColumns(), touched), gear);
}

} // namespace
} // namespace grouser::output
