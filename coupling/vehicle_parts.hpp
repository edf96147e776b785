// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/sphere_set.hpp"
#include "coupling/contact_parts.hpp"
#include "coupling/sphere_sets.hpp"
#include "coupling/vehicle_setup.hpp"
#include "vehicle/assembly.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Surfaces of a vehicle's parts: meshes and their sphere sets, one per kind of part. Contact parts are all parts
/// except the hull, which is last if requested.
class VehicleParts {
public:
  /// Reads the meshes and cuts them into spheres; the ranks share the work. `kept`: source of sphere sets; null: all
  /// are cut. `smallestGrain`: radius of the smallest grain in contact [m]; infinity without grains. `shapesAlone`:
  /// contacts use spheres of the hull only, so no other part is cut. Throws InputError for unusable meshes.
  VehicleParts(const vehicle::Assembly& assembly, const VehicleSetup& setup, const base::Comm& comm, SphereSets* kept,
               double smallestGrain, bool shapesAlone);

  /// Minimum contact feature of a vehicle's parts, ground and obstacles [m]: a quarter of a pitch.
  static double contactSize(const vehicle::VehicleSpec& spec) { return 0.25 * spec.shoe.pitch; }

  const std::vector<base::TriangleMesh>& meshes() const { return meshes_; } ///< one per kind of part
  std::size_t meshOfPart(std::size_t part) const { return meshOfPart_[part]; }

  struct SetFigures {
    std::string mesh;
    std::size_t spheres{};
    int instances{};
  };
  const std::vector<SetFigures>& setFigures() const { return setFigures_; }
  std::size_t totalSpheres() const;
  const std::vector<spheredecomp::CutReport>& cutReports() const {
    return cutReports_;
  } ///< cuts of the meshes with contacts

  std::size_t contactParts() const { return contactParts_.size(); }
  /// Index of a contact part among the assembly's parts.
  std::size_t partOf(std::size_t contactPart) const { return static_cast<std::size_t>(contactParts_[contactPart]); }
  /// Index of an assembly part among the contact parts; -1 for a hull without contacts.
  int contactIndex(int part) const { return contactIndex_[static_cast<std::size_t>(part)]; }
  /// Contact parts of `assembly`, which refer to this object. `shoesAlone`: only shoes are in contact with grains.
  ContactParts touching(const vehicle::Assembly& assembly, bool shoesAlone) const;
  /// True if gear contacts use part shapes instead of mesh samples.
  bool shapes() const { return shapes_; }

private:
  /// Surface points of a set for contact with rigid surfaces.
  contact::PointTree points(std::size_t set) const;
  void addContactPart(std::size_t part);
  /// `hull`: index of its mesh; contacts use only its surface.
  void cut(const std::vector<std::size_t>& meshes, std::size_t hull, const VehicleSetup& setup, double contactSize,
           SphereSets* kept, const base::Comm& comm);

  std::vector<base::TriangleMesh> meshes_;
  std::vector<std::size_t> meshOfPart_;
  std::vector<base::SphereSet> sets_; ///< parallel to meshes_; empty for meshes without contacts
  std::vector<SetFigures> setFigures_;
  std::vector<spheredecomp::CutReport> cutReports_;
  std::vector<int> contactParts_, contactIndex_;
  std::vector<double> reach_;
  vehicle::VehicleSpec spec_;
  bool shapes_;
  double pointSpacing_; ///< point spacing on shapes [m]
};

} // namespace grouser::coupling
