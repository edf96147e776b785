// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_space.hpp"

#include "base/position.hpp"
#include "base/rounded.hpp"
#include "runs/scene/bed_radii.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/complementarity_setup.hpp"
#include "runs/setup/periodic_boundaries.hpp"
#include "terrain/feet_search.hpp"
#include "terrain/grain_constants.hpp"
#include "terrain/grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::setup {

namespace {

using base::Vec3d;

/// Checks radii and positions of the sections.
class SpaceCheck {
public:
  SpaceCheck(const scene::Scene& scene, const GrainKinds& kinds)
      : scene_(scene), kinds_(kinds), limit_(base::positionScale(2 * kinds_.largest).limit()) {}

  void grains() const {
    for (std::size_t k = 0; k < scene_.grains.size(); ++k) {
      radius("grain", k, "radius", scene_.grains[k].radius);
      place("grain", k, "position", scene_.grains[k].position);
    }
    for (std::size_t k = 0; k < scene_.fills.size(); ++k) {
      const scene::GrainFill& b = scene_.fills[k];
      radius("grains", k, b.form == scene::FillForm::file ? "file" : "radius", b.smallestRadius());
      if (b.low) place("grains", k, "low", *b.low), place("grains", k, "high", *b.high);
      for (const scene::Grain& g : b.fromFile) place("grains", k, "file", g.position);
    }
    for (std::size_t k = 0; k < scene_.sources.size(); ++k) {
      const scene::Source& s = scene_.sources[k];
      radius("source", k, "radius", s.radius);
      place("source", k, "low", s.low), place("source", k, "high", s.high);
    }
    if (!scene_.terrain || !scene_.terrain->granular()) return;
    const auto [x, y] = scene_.terrain->size;
    if (!(x < limit_ && 0.5 * y < limit_))
      scene_.fail("terrain", "size",
                  fmt::format("[m] extends beyond {:.6g} m from the origin, the maximum distance for grains of {}; use "
                              "larger grains or a smaller terrain",
                              limit_, scene::radiiText(*scene_.terrain)));
  }

  /// A grain must not touch two images of another grain: three cells of the neighbour search must fit between periodic
  /// boundaries. `margin`: gap at which complementarity contacts include a pair [m]; 0 without them.
  void sides(double margin = 0) const {
    const terrain::PeriodicBoundaries sides = periodicBoundaries(scene_);
    const double least = 3 * (2 * kinds_.largest + scene_.run.skin * kinds_.smallest + margin);
    for (std::size_t a = 0; a < 2; ++a) {
      if (!sides[a]) continue;
      const auto [from, to] = *sides[a];
      const auto fail = [&](const std::string& message) {
        if (scene_.terrain) scene_.fail("terrain", "size", "[m]" + message);
        scene_.fail("run", std::string("domain_") + "xy"[a], "[m]" + message);
      };
      if (!(std::fabs(from) < limit_ && std::fabs(to) < limit_)) fail(tooFar());
      if (to - from < least)
        fail(fmt::format(" makes the periodic boundaries along {} too close: a grain could touch two images of another "
                         "grain; set them at least {} m apart (three diameters plus run.skin{}), or use smaller grains",
                         "xy"[a], base::roundedUp(least, 6),
                         margin > 0 ? " and the gaps of complementarity contacts" : ""));
    }
  }

  void boundaries() const {
    constexpr std::size_t kMax = 32; // bits of a mask
    std::size_t walls = 0;
    if (scene_.terrain && scene_.terrain->granular() && scene_.terrain->walls)
      walls = (scene_.run.periodic[0] ? 0u : 2u) + (scene_.run.periodic[1] ? 0u : 2u);
    const std::size_t floor = floorPlaces(kMax - std::min(kMax, walls + surfaces()));
    std::string others;
    if (floor > 0) others = ", including floor and walls of the terrain";
    if (floor > 1)
      others += fmt::format(" (the floor counts as {}, since it has hollows narrower than a grain)", floor);
    std::size_t count = floor + walls;
    const auto add = [&](const char* list, std::size_t sections) {
      count += sections;
      if (count > kMax)
        scene_.fail(list, sections - 1, "",
                    fmt::format("is one of {} or more planes, boxes and cylinders{}; grains support at most {}; remove "
                                "some, or combine several in one [[mesh]]{}",
                                count, others, kMax,
                                floor > 1 && scene_.terrain->granular() ? ", or set terrain.floor = \"flat\"" : ""));
    };
    add("plane", scene_.planes.size()), add("box", scene_.boxes.size()), add("cylinder", scene_.cylinders.size());
  }

  /// Ids are 32-bit numbers.
  void ids() const {
    constexpr double kMaxGrains = 4e9;
    for (std::size_t k = 0; k < scene_.fills.size(); ++k) {
      const scene::GrainFill& b = scene_.fills[k];
      if (b.form != scene::FillForm::lattice) continue;
      double grains = 1; // may exceed an integer
      for (int a = 0; a < 3; ++a) grains *= ((*b.high)[a] - (*b.low)[a]) / (b.spacing * b.largestRadius()) + 1;
      if (grains > kMaxGrains)
        scene_.fail("grains", k, "radius",
                    fmt::format("[m] results in a lattice of about {:.3g} grains, more than the maximum {:g}; use "
                                "larger grains or a smaller box",
                                grains, kMaxGrains));
    }
  }

private:
  std::size_t surfaces() const { return scene_.planes.size() + scene_.boxes.size() + scene_.cylinders.size(); }
  /// Maximum number of contacts of a grain with the floor. Reads the height-map only if `room` is below the general
  /// maximum.
  std::size_t floorPlaces(std::size_t room) const {
    if (!scene_.terrain || room >= terrain::Feet::kMax) return scene_.terrain ? 1 : 0;
    terrain::Boundaries around;
    around.floor = floorShape(scene_);
    return static_cast<std::size_t>(around.floorPlaces(kinds_.largest));
  }
  void radius(const char* list, std::size_t k, const char* key, double smallest) const {
    constexpr double kSmallest = 1e-12; // [m]; for much smaller radii, no unit of positions resolves 1e-8 radii
    if (smallest < kSmallest)
      scene_.fail(
          list, k, key,
          fmt::format("[m] results in a grain radius of {:g} m, below the minimum {:g} m; check the unit (metres)",
                      smallest, kSmallest));
    constexpr double kMin = 1e-3; // radius / largest radius [-]; see terrain::Grains
    if (smallest < kMin * kinds_.largest)
      scene_.fail(list, k, key,
                  fmt::format("[m] results in a grain radius of {:g} m, less than 0.001 of the largest, {:g} m; raise "
                              "it, or lower the largest",
                              smallest, kinds_.largest));
  }
  void place(const char* list, std::size_t k, const char* key, const Vec3d& p) const {
    if (!(std::fabs(p.x) < limit_ && std::fabs(p.y) < limit_ && std::fabs(p.z) < limit_))
      scene_.fail(list, k, key, "[m]" + tooFar());
  }
  std::string tooFar() const {
    return fmt::format(" is farther than {:.6g} m from the origin, the maximum distance for grains of radius {:g} m; "
                       "move the scene closer to the origin, or use larger grains",
                       limit_, kinds_.largest);
  }

  const scene::Scene& scene_;
  const GrainKinds& kinds_;
  double limit_;
};

} // namespace

void checkGrainSpace(const scene::Scene& scene, const GrainKinds& kinds) {
  if (!kinds.any()) return;
  const SpaceCheck check(scene, kinds);
  check.grains(), check.sides(), check.boundaries(), check.ids();
}

void checkPeriodicSides(const scene::Scene& scene, const GrainKinds& kinds, double timeStep) {
  if (!kinds.any() || !hasComplementarity(scene)) return;
  const contact::ComplementarityOptions options = *complementarityOptions(scene, timeStep);
  SpaceCheck(scene, kinds).sides(terrain::GrainConstants::margin(kinds.smallest, options.reach));
}

} // namespace grouser::setup
