// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/bench/bullet.hpp"

#include "base/error.hpp"

#if defined(GROUSER_BULLET)

#include <btBulletCollisionCommon.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace grouser::bench {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Counts the pairs that have a contact point without a gap (Bullet also keeps pairs with small gaps).
std::int64_t touching(btDispatcher& dispatcher) {
  std::int64_t count = 0;
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& pair = *dispatcher.getManifoldByIndexInternal(i);
    bool touches = false;
    for (int k = 0; k < pair.getNumContacts(); ++k) touches = touches || pair.getContactPoint(k).getDistance() < 0;
    count += touches;
  }
  return count;
}

} // namespace

std::string bulletVersion() { return fmt::format("{}.{:02}", btGetVersion() / 100, btGetVersion() % 100); }

BulletFigures benchBullet(const std::vector<base::Vec3f>& positions, float diameter, int repeats) {
  BulletFigures figures;
  Clock::time_point start = Clock::now();
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btCollisionWorld world(&dispatcher, &broadphase, &configuration);
  btSphereShape sphere(0.5f * diameter);
  std::vector<btCollisionObject> objects(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    objects[i].setCollisionShape(&sphere);
    objects[i].setCollisionFlags(0); // not static, because static objects do not collide with each other
    objects[i].setWorldTransform(
        btTransform(btQuaternion::getIdentity(), btVector3(positions[i].x, positions[i].y, positions[i].z)));
    world.addCollisionObject(&objects[i]);
  }
  figures.setUpSeconds = secondsSince(start);

  start = Clock::now();
  world.performDiscreteCollisionDetection();
  figures.coldSeconds = secondsSince(start);
  std::vector<double> warm;
  for (int k = 0; k < std::max(1, repeats); ++k) {
    start = Clock::now();
    world.performDiscreteCollisionDetection();
    warm.push_back(secondsSince(start));
  }
  std::sort(warm.begin(), warm.end());
  figures.warmSeconds = warm[warm.size() / 2];
  figures.contacts = touching(dispatcher);
  // Remove the pairs first, because the removal of an object visits all remaining pairs.
  btOverlappingPairCache& pairs = *broadphase.getOverlappingPairCache();
  while (const int left = pairs.getNumOverlappingPairs()) {
    const btBroadphasePair pair = pairs.getOverlappingPairArray()[left - 1];
    pairs.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, &dispatcher);
  }
  for (btCollisionObject& object : objects) world.removeCollisionObject(&object);
  return figures;
}

} // namespace grouser::bench

#else

namespace grouser::bench {

std::string bulletVersion() { return ""; }

BulletFigures benchBullet(const std::vector<base::Vec3f>&, float, int) {
  throw base::InputError("this grouser was built without Bullet; install libbullet-dev and build it again");
}

} // namespace grouser::bench

#endif
