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

/// Surfaces of a vehicle's parts: meshes, and the spheres that these are cut into, once for each kind of part. Those
/// that touch something are the contact parts: all but the hull, and that behind them where it is asked for.
class VehicleParts {
public:
  /// Reads the meshes and cuts them; the ranks share the cutting. `kept`: where sets come from; null: all are cut.
  /// `smallestGrain`: radius of the smallest grain that touches them [m]; infinity without. `shapesAlone`: nothing
  /// touches the parts by spheres but the hull, so that no other is cut. Throws InputError where a mesh is of no use.
  VehicleParts(const vehicle::Assembly& assembly, const VehicleSetup& setup, const base::Comm& comm, SphereSets* kept,
               double smallestGrain, bool shapesAlone);

  /// Smallest feature at which a vehicle's parts, ground and obstacles meet each other [m]: a quarter of a pitch.
  static double contactSize(const vehicle::VehicleSpec& spec) { return 0.25 * spec.shoe.pitch; }

  const std::vector<base::TriangleMesh>& meshes() const { return meshes_; } ///< one a kind of part
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
  } ///< cuts of the meshes that touch

  std::size_t contactParts() const { return contactParts_.size(); }
  /// Its place among the assembly's parts.
  std::size_t partOf(std::size_t contactPart) const { return static_cast<std::size_t>(contactParts_[contactPart]); }
  /// Of a part of the assembly among the contact parts; -1 for a hull that touches nothing.
  int contactIndex(int part) const { return contactIndex_[static_cast<std::size_t>(part)]; }
  /// The contact parts of `assembly`, which refer to this object. `shoesAlone`: grains meet no other part.
  ContactParts touching(const vehicle::Assembly& assembly, bool shoesAlone) const;
  /// Returns true if gear contacts use part shapes instead of mesh samples.
  bool shapes() const { return shapes_; }

private:
  /// Surface points of a set for contact with rigid surfaces.
  contact::PointTree points(std::size_t set) const;
  void addContactPart(std::size_t part);
  /// `hull`: its mesh, of which contacts need the surface only.
  void cut(const std::vector<std::size_t>& meshes, std::size_t hull, const VehicleSetup& setup, double contactSize,
           SphereSets* kept, const base::Comm& comm);

  std::vector<base::TriangleMesh> meshes_;
  std::vector<std::size_t> meshOfPart_;
  std::vector<base::SphereSet> sets_; ///< parallel to meshes_; empty for what touches nothing by them
  std::vector<SetFigures> setFigures_;
  std::vector<spheredecomp::CutReport> cutReports_;
  std::vector<int> contactParts_, contactIndex_;
  std::vector<double> reach_;
  vehicle::VehicleSpec spec_;
  bool shapes_;
  double pointSpacing_; ///< between points of shapes [m]
};

} // namespace grouser::coupling
