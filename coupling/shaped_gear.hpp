// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/gear_surfaces.hpp"
#include "contact/host_patches.hpp"
#include "coupling/vehicle_parts.hpp"
#include "vehicle/assembly.hpp"

#include <array>
#include <vector>

namespace grouser::coupling {

/// Contacts within the running gear, computed from part shapes (vehicle::GearShapes): plates on wheel rims, horns
/// against disc sides, bosses in sprocket gaps. Runs on the host, without contact lists; each step finds the shoes near
/// a wheel from their positions.
class ShapedGear {
public:
  struct Model {
    contact::PatchLaw law;
    contact::PatchQuanta quanta;
    double timeStep{};
  };
  /// `assembly`: its spec must have shapes; must outlive this object.
  ShapedGear(const vehicle::Assembly& assembly, const VehicleParts& parts, const Model& model);

  /// Adds this step's loads; shoe and wheel receive opposite loads.
  void compute(const contact::PartMotion* motion, contact::PartLoad* loads);

  contact::PatchBuffers::Ledger ledger() const { return patches_.ledger(); }
  contact::SavedPatches save() const { return patches_.save(); }
  void restore(const contact::SavedPatches& saved) { patches_.restore(saved); }

private:
  /// Patch indices of one shoe with one wheel or sprocket.
  enum Patch { kPlates = 0, kHornSides = 2, kHornTip = 4, kBosses = 0, kPatches = 6 };
  struct Wheel {
    int part;      ///< contact part
    double radius; ///< [m]; for a sprocket, its tip radius
    bool isSprocket;
  };
  struct Track {
    std::vector<int> shoes;  ///< contact parts
    std::vector<Wheel> gear; ///< in the order of the assembly's parts
    std::size_t firstPair{}; ///< index of its first shoe-wheel pair
  };
  /// Shoe near a wheel, with the geometry of the current step.
  struct Near {
    const contact::PartMotion &shoe, &wheel;
    int shoePart;
    const Wheel& of;
    std::size_t patches;
    base::Vec3d x, y, z;      ///< axes of the shoe
    base::Vec3d origin, axle; ///< centres of shoe and wheel, relative to the shoe's centre of mass
    base::Vec3d axis;         ///< axis of the wheel
    contact::RelativeMotion<double> motion;
  };

  Near nearby(const contact::PartMotion* motion, int shoe, const Wheel& wheel, std::size_t patches) const;
  void collideWheel(const Near& near);
  void collidePlate(const Near& near, double level, double halfLength, double from, double to, int patch);
  void collideHorn(const Near& near, double side, int patch);
  void collideSprocket(const Near& near);
  void pressRims();

  contact::PatchLaw law_;
  vehicle::GearShapes shapes_;
  double halfLength_, plateTop_, hornHeight_, pin_;
  contact::GapProfile gap_;
  std::vector<Track> tracks_;
  contact::HostPatches patches_;

  // Scratch data of one step.
  const contact::PartMotion* motion_{nullptr};
  contact::PartLoad* loads_{nullptr};
  contact::RimsOnPlates rims_{};
  struct Rim {
    std::size_t patch;
    int shoe, wheel;
  };
  std::array<Rim, contact::kPointLanes> rimOf_{};
  std::size_t rimCount_{0};
};

} // namespace grouser::coupling
