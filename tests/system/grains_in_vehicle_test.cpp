// SPDX-License-Identifier: BSD-3-Clause
// Grains that start inside parts of a vehicle.
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/message_of.hpp"
#include "tests/runs/shared_cache.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>

namespace grouser::coupling {
namespace {

using base::Vec3d;

constexpr double kRadius = 0.02; // [m]

/// A hanging vehicle, and a grain.
std::unique_ptr<Simulation> withGrain(const Vec3d& place) {
  const std::string text = fmt::format(
      "version = 1\n[run]\nduration = 0.1\n[material.soil]\nstiffness = 1e5\n[vehicle]\n"
      "spec = \"vehicles/light_tracked.toml\"\nsphere_radius = 0.02\nchassis = \"fixed\"\nsoil_contact = "
      "\"all\"\nhull_touches = true\n"
      "[driver]\nsprocket_speed = 0\n[[grain]]\nradius = {}\nmaterial = \"soil\"\nposition = [{}, {}, {}]\n",
      kRadius, place.x, place.y, place.z);
  return std::make_unique<Simulation>(
      setup::simulationSetup(setup::parseScene(text, "grain.toml")), base::cpuExec(1), [](double, double) {},
      base::Comm{}, nullptr, sharedSpheres());
}

/// Vertex of a part of the vehicle that is farthest along `direction`, in the world [m].
Vec3d farthest(const VehicleRig& rig, std::size_t part, const Vec3d& direction) {
  const vehicle::Part& p = rig.assembly().parts[part];
  const base::Pose X = multibody::compose(rig.model().bodies()[static_cast<std::size_t>(p.body)].pose, p.pose_B);
  Vec3d best = X.position;
  double most = -1e300;
  for (const Vec3d& v : rig.parts().meshes()[rig.parts().meshOfPart(part)].vertices)
    if (const Vec3d place = X.toWorld(v); dot(place, direction) > most) most = dot(place, direction), best = place;
  return best;
}

TEST(GrainsInVehicle, AreRefusedInEveryPart) {
  const auto free = withGrain({0, 0, 9});
  const VehicleRig& rig = *free->vehicle();
  std::set<vehicle::PartKind> tried;
  const Vec3d out{0, 0, -1};
  std::string shoe;
  double lowest = 1e300;
  Vec3d ground{};
  for (std::size_t p = 0; p < rig.assembly().parts.size(); ++p) {
    const Vec3d vertex = farthest(rig, p, out);
    if (vertex.z < lowest) lowest = vertex.z, ground = vertex, shoe = rig.assembly().parts[p].name;
    if (!tried.insert(rig.assembly().parts[p].kind).second) continue;
    const std::string message = test::messageOf([&] { withGrain(vertex); });
    EXPECT_NE(message.find("of the vehicle, more than"), std::string::npos)
        << rig.assembly().parts[p].name << ": " << message;
  }
  EXPECT_GE(tried.size(), 5u);
  // Below the lowest vertex of the vehicle, this vertex is the nearest point: the overlap is R - h.
  const std::string message = test::messageOf([&] { withGrain(ground + out * (0.5 * kRadius)); });
  EXPECT_NE(message.find(fmt::format("would penetrate {:.3g} m into the {} of the vehicle", 0.5 * kRadius, shoe)),
            std::string::npos)
      << message;
  withGrain(ground + out * (1.001 * kRadius));
}

} // namespace
} // namespace grouser::coupling
