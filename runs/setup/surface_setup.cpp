// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/surface_setup.hpp"

namespace grouser::setup {

using base::Vec3d;

terrain::SurfacePose startingPose(const SurfaceSetup& surface) {
  const base::Pose& pose = surface.start;
  return {{pose.position, pose.orientation.matrix(), pose.position, {}, {}}, base::Mat3d::identity()};
}

double startingOverlap(const SurfaceSetup& surface, const Vec3d& position, double radius) {
  return overlapAt(surface, surface.start, position, radius);
}

double overlapAt(const SurfaceSetup& surface, const base::Pose& pose, const Vec3d& position, double radius) {
  const Vec3d p = pose.toBody(position);
  if (surface.mesh) return radius - surface.mesh->signedDistance(p);
  return radius - terrain::gapTo(surface.geometry, p).distance;
}

} // namespace grouser::setup
