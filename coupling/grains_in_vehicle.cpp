// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/grains_in_vehicle.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "spheredecomp/mesh_query.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace grouser::coupling {

using base::Vec3d;

namespace {

/// Parts of a vehicle that grains can touch, with the distances to their meshes.
class PartsInSpace {
public:
  PartsInSpace(const VehicleRig& vehicle, bool shoesAlone) : parts_(vehicle.parts()) {
    const multibody::Model& model = vehicle.model();
    const std::vector<ContactPart> parts = parts_.touching(vehicle.assembly(), shoesAlone).parts;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (!parts[p].canTouchGrains) continue;
      const base::Pose& body = model.bodies()[parts[p].body].pose;
      placed_.push_back({parts[p].name, parts_.meshOfPart(parts_.partOf(p)), body.position,
                         multibody::compose(body, parts[p].pose_B), parts[p].reach});
      const Vec3d reach{parts[p].reach, parts[p].reach, parts[p].reach};
      low_ = base::min(low_, body.position - reach), high_ = base::max(high_, body.position + reach);
    }
  }
  /// Deepest overlap of a ball with a part [m], and the name of the part; 0 without overlap.
  std::pair<double, std::string> overlap(const Vec3d& centre, double radius) {
    std::pair<double, std::string> deepest{0, ""};
    for (int a = 0; a < 3; ++a)
      if (centre[a] + radius < low_[a] || centre[a] - radius > high_[a]) return deepest;
    for (const Placed& part : placed_) {
      if (norm(centre - part.centre) > part.reach + radius) continue;
      const spheredecomp::MeshQuery& query = queries_.try_emplace(part.mesh, parts_.meshes()[part.mesh]).first->second;
      const double depth = radius - query.signedDistance(part.X_P.toBody(centre));
      if (depth > deepest.first) deepest = {depth, part.name};
    }
    return deepest;
  }

private:
  struct Placed {
    std::string name;
    std::size_t mesh;
    Vec3d centre; ///< centre of mass of its body [m]
    base::Pose X_P;
    double reach; ///< [m]
  };
  const VehicleParts& parts_;
  std::vector<Placed> placed_;
  std::map<std::size_t, spheredecomp::MeshQuery> queries_; ///< by mesh
  Vec3d low_{base::kInfinity, base::kInfinity, base::kInfinity}, high_ = -low_;
};

} // namespace

void requireApartFromVehicle(const GrainsSetup& grains, const VehicleRig& vehicle, bool shoesAlone) {
  PartsInSpace parts(vehicle, shoesAlone);
  const double most = grains.model.maxEntryOverlap;
  const auto check = [&](const std::string& place, const std::vector<terrain::GrainSpec>& specs) {
    for (const terrain::GrainSpec& g : specs)
      if (const auto [depth, part] = parts.overlap(g.position, g.radius); depth > most * g.radius)
        throw base::InputError(fmt::format(
            "{}a grain of radius {:g} m at ({:.6g}, {:.6g}, {:.6g}) m would penetrate {:.3g} m into the {} of the "
            "vehicle, more than {:g} of its radius (run.max_overlap); move the grain or vehicle.position",
            place, g.radius, g.position.x, g.position.y, g.position.z, depth, part, most));
  };
  check("", grains.start);
  for (const PlacedGrains& section : grains.onBed) check(section.place + ": ", section.grains);
}

} // namespace grouser::coupling
