// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/random_scenes.hpp"

#include "base/math.hpp"
#include "base/sphere.hpp"
#include "base/vec.hpp"
#include "runs/validation/studies/random_draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace grouser::studies {

using base::Vec3d;

namespace {

constexpr std::uint64_t kScenesPurpose = base::purpose("study.random_scenes");

/// Scales that all materials of a scene have in common.
struct Scales {
  double radius, density, stiffness, young, poisson; ///< values of the smallest grains
  bool hertz;
  double mass() const { return base::sphereMass(density, radius); }
  /// Impact speed [m/s] that causes a maximum overlap of about `share` radii.
  double speedFor(double share) const {
    if (!hertz) return share * radius * std::sqrt(stiffness / mass());
    // Impact of a grain on a plane (Johnson): overlap = (15 m v^2 / (16 E_eff sqrt(R)))^(2/5).
    const double modulus = 0.5 * young / (1 - poisson * poisson);
    const double v2 = share * share * std::sqrt(share) * radius * radius * radius * 16 * modulus / (15 * mass());
    return std::sqrt(v2);
  }
};

struct Lossy {
  double restitution, friction, rolling;
};

std::string material(Draw& draw, const std::string& name, const Scales& s, double times, const Lossy& l) {
  std::string text = fmt::format("[material.{}]\ndensity = {:.6g}\nrestitution = {:.4g}\nfriction = {:.4g}\n", name,
                                 s.density, l.restitution, l.friction);
  if (s.hertz)
    text += fmt::format("law = \"hertz\"\nyoung = {:.6g}\npoisson = {:.4g}\n", times * s.young, s.poisson);
  else
    text += fmt::format("stiffness = {:.6g}\n", times * s.stiffness);
  if (!s.hertz && draw.once(0.5)) text += fmt::format("tangential_stiffness_ratio = {:.4g}\n", draw.in(0.1, 1));
  if (draw.once(0.5)) text += fmt::format("tangential_damping_ratio = {:.4g}\n", draw.in(0, 1));
  if (l.rolling > 0)
    text += fmt::format("rolling_friction = {:.4g}\nrolling_damping_ratio = {:.4g}\n", l.rolling, draw.in(0, 1));
  return text;
}

struct Room {
  double halfWidth, height; ///< [m]; a height of 0 means no lid
};

std::string planes(const Room& room, bool sides, bool floor, bool lid) {
  std::string text;
  const auto plane = [&](const Vec3d& point, const Vec3d& n) {
    text += fmt::format("[[plane]]\npoint = [{:.8g}, {:.8g}, {:.8g}]\nnormal = [{:g}, {:g}, {:g}]\nmaterial = \"a\"\n",
                        point.x, point.y, point.z, n.x, n.y, n.z);
  };
  const double w = room.halfWidth;
  if (floor) plane({}, {0, 0, 1});
  if (sides) plane({-w, 0, 0}, {1, 0, 0}), plane({w, 0, 0}, {-1, 0, 0});
  if (sides) plane({0, -w, 0}, {0, 1, 0}), plane({0, w, 0}, {0, -1, 0});
  if (lid) plane({0, 0, room.height}, {0, 0, -1});
  return text;
}

/// Parameters of each kind of scene.
struct Form {
  int side, layers;    ///< number of grains along x and along y, and number of layers
  double spacing;      ///< lattice spacing [largest radii]
  double widest;       ///< largest radius / smallest radius
  double gravity;      ///< overlap of the largest grain under its own weight [radii]
  double push;         ///< overlap in initial impacts [radii]
  bool random, closed; ///< velocities have random directions; the box has a lid
};

Form formOf(const std::string& kind, Draw& draw) {
  const double hit = draw.over(2e-3, 2e-2);
  if (kind == "heap")
    return {draw.of(3, 5), draw.of(3, 5), draw.in(2.05, 2.3), 1, draw.over(1e-5, 3e-4), hit, false, false};
  if (kind == "mixture")
    return {draw.of(3, 4), draw.of(3, 5), 2.05, draw.over(1.2, 4), draw.over(1e-5, 3e-4), hit, true, false};
  if (kind == "pressed") return {draw.of(3, 5), draw.of(4, 6), 2.01, 1, draw.over(1e-3, 4e-3), 1e-3, true, false};
  if (kind == "gas") return {draw.of(3, 4), 4, draw.in(2.3, 3), draw.over(1, 2), 0, draw.over(1e-2, 4e-2), true, true};
  if (kind == "few") return {2, 1, draw.in(2.1, 3), 1, 0, draw.over(5e-3, 4e-2), true, true};
  return {draw.of(1, 4),         draw.of(1, 2), draw.in(2.5, 4), draw.over(1, 3),
          draw.over(3e-5, 3e-4), hit,           draw.once(0.5),  false};
}

/// Gravity at which the largest grain has the overlap Form::gravity under its own weight [m/s2].
double gravityOf(const Form& form, const Scales& s) {
  if (form.gravity <= 0) return 0;
  const double largest = form.widest * s.radius, mass = form.widest * form.widest * form.widest * s.mass();
  double gravity = form.gravity * s.stiffness * largest / mass;
  if (s.hertz) {
    const double modulus = 0.5 * s.young / (1 - s.poisson * s.poisson);
    gravity = 4.0 / 3 * modulus * form.gravity * std::sqrt(form.gravity) * largest * largest / mass;
  }
  return std::min(gravity, 1000.0);
}

/// Scene sections of the boundaries.
std::string aroundOf(const std::string& kind, const Room& room, double largest, bool closed, Draw& draw) {
  if (kind == "box")
    return planes(room, true, true, false) +
           fmt::format("[[box]]\nposition = [0, 0, {:.9g}]\nsize = [{:.9g}, {:.9g}, {:.9g}]\naxis = [1, 0, "
                       "0]\nangle = {:.3g}\nmaterial = \"a\"\n",
                       0.5 * largest, 2 * largest, 4 * room.halfWidth, 2 * largest, draw.in(0, 10));
  if (kind == "pipe")
    return planes(room, false, true, false) +
           fmt::format("[[cylinder]]\nposition = [0, 0, {:.9g}]\nradius = {:.9g}\nlength = {:.9g}\nhollow = "
                       "true\nmaterial = \"a\"\n",
                       2 * room.height, 1.6 * room.halfWidth, 6 * room.height);
  return planes(room, kind != "plane", true, closed);
}

/// Random cohesion that is weak enough for grains to separate [J/m2].
double cohesionOf(const Scales& s, Draw& draw) {
  return s.hertz ? draw.over(1e-8, 1e-6) * s.young * s.radius : draw.over(1e-6, 1e-4) * s.stiffness / base::kPi;
}

} // namespace

RandomScene randomScene(std::uint64_t seed, int number) {
  Draw draw(seed, kScenesPurpose, number);
  RandomScene scene;
  scene.number = number;
  scene.kind = kRandomKinds[static_cast<std::size_t>(number) % kRandomKinds.size()];
  Scales s{draw.over(1e-3, 1e-1), draw.over(250, 25e3), draw.over(1e3, 1e9),
           draw.over(1e5, 1e11),  draw.in(0, 0.45),     draw.once(0.4)};
  const Form form = formOf(scene.kind, draw);
  const bool two = scene.kind == "mixture" || draw.once(0.2), pulls = draw.once(0.15);
  const auto lossy = [&] {
    const double e = draw.once(0.1) ? 1 : draw.once(0.15) ? 0.05 : draw.in(0.05, 1);
    return Lossy{e, draw.once(0.25) ? 0 : draw.in(0.05, 1), draw.once(0.3) ? draw.in(0.02, 0.5) : 0};
  };
  const Lossy first = lossy(), second = two ? lossy() : first;
  scene.hertz = s.hertz, scene.single = draw.once(0.5);
  scene.restitution = std::min(first.restitution, second.restitution);
  scene.friction = std::max(first.friction, second.friction);
  scene.rolls = first.rolling > 0 || second.rolling > 0;

  const double largest = form.widest * s.radius;
  const double push = std::min(1e4 * 0.5, s.speedFor(form.push));
  const double gravity = gravityOf(form, s);
  const double cohesion = draw.once(0.2) ? cohesionOf(s, draw) : 0;
  scene.sticks = cohesion > 0;

  const double spacing = form.spacing * largest;
  const bool few = scene.kind == "few";
  const int count = few ? draw.of(2, 4) : form.side * form.side * form.layers;
  // The box is either so narrow that all grains collide, or wide.
  Room room{0.5 * form.side * spacing + 0.05 * largest, form.layers * spacing + 0.1 * largest};
  std::string grains;
  double lightest = 0, heaviest = 0;
  for (int i = 0; i < count; ++i) {
    // Half of the grains have the smallest radius, so that the highest frequencies occur.
    const double radius = form.widest > 1 && i > 0 && draw.once(0.5) ? draw.in(s.radius, largest) : s.radius;
    const double free = few ? 0.9 * (0.5 * spacing - radius) : 0.9 * std::max(0.0, 0.5 * spacing - largest);
    const int x = i % form.side, y = i / form.side % form.side, z = i / (form.side * form.side);
    Vec3d p{(x + 0.5 - 0.5 * form.side) * spacing, (y + 0.5 - 0.5 * form.side) * spacing, (z + 0.5) * spacing};
    if (scene.kind == "box" || scene.kind == "pipe") p.z += 2 * largest;
    Vec3d v{0, 0, -push}, spin;
    for (int a = 0; a < 3; ++a) {
      p[a] += free * draw.in(-1, 1);
      if (form.random) v[a] = push * draw.in(-1, 1);
      if (a == 2 && !form.closed) v[a] = -std::fabs(v[a]);
      spin[a] = 0.5 * push / radius * draw.in(-1, 1);
    }
    const bool other = two && draw.once(0.5);
    const double mass = base::sphereMass(s.density, radius);
    lightest = i == 0 ? mass : std::min(lightest, mass), heaviest = std::max(heaviest, mass);
    scene.speed = std::max(scene.speed, std::sqrt(dot(v, v) + 2 * gravity * p.z));
    scene.energy += mass * (0.5 * dot(v, v) + 0.2 * radius * radius * dot(spin, spin) + gravity * p.z);
    grains += fmt::format("[[grain]]\nposition = [{:.9g}, {:.9g}, {:.9g}]\nvelocity = [{:.6g}, {:.6g}, {:.6g}]\nspin = "
                          "[{:.6g}, {:.6g}, {:.6g}]\nradius = {:.9g}\nmaterial = \"{}\"\n",
                          p.x, p.y, p.z, v.x, v.y, v.z, spin.x, spin.y, spin.z, radius, other ? "b" : "a");
  }
  const double impact = std::max(scene.speed, 1e-6);
  scene.speed *= std::sqrt(heaviest / lightest), scene.grains = count;
  // Few grains collide less often, so that they need a longer run.
  scene.contacts = count > 32 ? 500 : 1500;
  std::string materials = material(draw, "a", s, 1, first);
  if (two) materials += material(draw, "b", s, draw.over(0.1, 1), second);
  const auto add = [&materials](const std::string& line) {
    for (std::size_t at = 0; (at = materials.find("density", at)) != std::string::npos; at += line.size() + 7)
      materials.insert(at, line);
  };
  if (cohesion > 0) add(fmt::format("cohesion = {:.6g}\n", cohesion));
  if (pulls) add("attraction = true\n");

  const std::string around = aroundOf(scene.kind, room, largest, form.closed, draw);
  // The intervals allow a single output, because scene checks require intervals above the step.
  scene.toml =
      fmt::format("version = 1\n[run]\nduration = 1e4\noutput_interval = 1e4\nframe_interval = 1e4\ngravity = [0, 0, "
                  "{:.6g}]\nimpact_speed = {:.6g}\nprecision = \"{}\"\nthreads = 1\n",
                  -gravity, impact, scene.single ? "single" : "double");
  scene.toml += materials + around + grains;
  return scene;
}

} // namespace grouser::studies
