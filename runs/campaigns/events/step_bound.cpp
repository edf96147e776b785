// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/step_bound.hpp"

#include "base/math.hpp"
#include "spheredecomp/mesh.hpp"
#include "vehicle/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace grouser::events {

using base::Vec3d;

namespace {

constexpr int kCorners = 96;                        // corners of a disc
constexpr double kDegree = base::kPi / 180;         // rad
constexpr int kMinPitch = 2, kMaxPitch = 80;        // degrees, range of pitch angles
constexpr int kPitchStep = 2;                       // degrees; coarse, because the maximum is flat
constexpr double kDepthStep = 5e-3, kDeepest = 0.6; // m, depth of the edge below the hull
constexpr int kHalvings = 16;

double cross(const SidePoint& o, const SidePoint& a, const SidePoint& b) {
  return (a.x - o.x) * (b.z - o.z) - (a.z - o.z) * (b.x - o.x);
}
double distance(const SidePoint& a, const SidePoint& b) { return std::hypot(b.x - a.x, b.z - a.z); }

/// Convex hull, counter-clockwise (Andrew's monotone chain, 1979).
std::vector<SidePoint> hullOf(std::vector<SidePoint> points) {
  std::sort(points.begin(), points.end(),
            [](const SidePoint& a, const SidePoint& b) { return a.x < b.x || (a.x == b.x && a.z < b.z); });
  std::vector<SidePoint> hull(2 * points.size());
  std::size_t n = 0;
  const auto add = [&](const SidePoint& p, std::size_t least) {
    while (n >= least && cross(hull[n - 2], hull[n - 1], p) <= 0) --n;
    hull[n++] = p;
  };
  for (const SidePoint& p : points) add(p, 2);
  const std::size_t lower = n + 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.resize(n - 1);
  return hull;
}

double perimeter(const std::vector<SidePoint>& hull) {
  double sum = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) sum += distance(hull[i], hull[(i + 1) % hull.size()]);
  return sum;
}

void addCorners(const SideDisc& disc, std::vector<SidePoint>& points) {
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * base::kPi * i / kCorners;
    points.push_back({disc.middle.x + disc.radius * base::cos(angle), disc.middle.z + disc.radius * base::sin(angle)});
  }
}

bool isInside(const SidePoint& p, const std::vector<SidePoint>& hull) {
  for (std::size_t i = 0; i < hull.size(); ++i)
    if (cross(hull[i], hull[(i + 1) % hull.size()], p) <= 0) return false;
  return true;
}

/// Height of the upper side of a hull at x.
double topAt(const std::vector<SidePoint>& hull, double x) {
  double top = -1e300;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const SidePoint &a = hull[i], &b = hull[(i + 1) % hull.size()];
    if (std::min(a.x, b.x) <= x && x <= std::max(a.x, b.x) && a.x != b.x)
      top = std::max(top, a.z + (b.z - a.z) * (x - a.x) / (b.x - a.x));
  }
  return top;
}

/// Running gear in the frame of the hull.
struct Frame {
  SideDisc sprocket, idler;           ///< enclosed by the loop of pins, the idler at its inner stop
  std::vector<SidePoint> pivots;      ///< pivots of the road-wheel arms
  double wheel = 0, arm = 0;          ///< radius of the loop about a road wheel; length of an arm [m]
  double drawn = 0;                   ///< angle of the arms below the horizontal, backwards [rad]
  bool rigid = false;                 ///< whether the arms are rigid
  double outward = 0, halfLength = 0; ///< from pins to grouser tips; half length of a shoe [m]
  double hanging = 0;                 ///< lowest arm angle: torsion bar loaded by the weight of the wheel only [rad]
  double highestEdge = 0;             ///< maximum z of an edge under the contact length [m]
  double first = 0, last = 0;         ///< x of the ends of the contact length [m]
  double inward = 0;                  ///< minimum distance from an edge at a pad to the pins [m]
  double loop = 0;                    ///< length of the loop of pins [m]

  SideDisc wheelAt(std::size_t k, double angle) const {
    return {{pivots[k].x - arm * base::cos(angle), pivots[k].z - arm * base::sin(angle)}, wheel};
  }
  /// Distance of the grouser tips from the centre of a disc.
  double reach(const SideDisc& disc) const { return std::hypot(disc.radius + outward, halfLength); }
};

Frame frameOf(const vehicle::VehicleSpec& s, const vehicle::Wrap& wrap, double gravity) {
  Frame f;
  f.sprocket = {{0, 0}, s.sprocketPinRadius() * base::cos(base::kPi / s.sprocket.teeth)};
  f.idler = {{wrap.idlerX + s.outward() * s.idler.slideMin, s.idler.z}, s.idler.radius + s.shoe.plateTop};
  f.wheel = s.roadWheel.radius + s.shoe.plateTop;
  f.arm = s.arm.length, f.drawn = s.arm.pivotAngle, f.rigid = s.arm.suspension == vehicle::Suspension::rigid;
  for (int k = 0; k < s.roadWheel.count; ++k)
    f.pivots.push_back({s.roadWheel.firstX + k * s.roadWheel.spacing + f.arm * base::cos(f.drawn),
                        s.roadWheel.z + f.arm * base::sin(f.drawn)});
  f.outward = s.shoe.grouserHeight - s.shoe.padBottom, f.halfLength = s.shoe.halfLength;
  // A right-angled edge enters the gap between two pads by half the gap width.
  f.inward = std::max(0.0, -s.shoe.padBottom - 0.5 * (s.shoe.pitch - 2 * s.shoe.halfLength));
  f.loop = s.shoe.count * s.shoe.pitch;
  f.first = s.roadWheel.firstX - f.wheel;
  f.last = s.lastWheelX() + f.wheel;
  // Between two wheels the pins rise by the maximum fold, below a wheel not at all.
  const double between = s.shoe.pitch * base::sin(s.shoe.maximumFold), half = 0.5 * s.totalMass() * gravity;
  f.hanging = f.drawn;
  double pressed = between;
  if (!f.rigid) {
    const double bar = s.arm.preload * f.arm * base::cos(f.drawn);
    f.hanging += (bar + (s.roadWheel.mass + 0.5 * s.arm.mass) * gravity * f.arm) / s.arm.stiffness;
    const auto rise = [&](double load) {
      const double turn = std::max(0.0, (load * f.arm - bar) / s.arm.stiffness);
      return f.arm * (base::sin(f.drawn) - base::sin(std::max(f.drawn - turn, -0.5 * base::kPi)));
    };
    pressed = std::max(rise(half), rise(0.5 * half) + between);
  }
  f.highestEdge = s.groundPinHeight() + pressed - f.inward;
  return f;
}

/// Rotation by a pitch angle, nose up.
struct Pitch {
  double s, c;
  explicit Pitch(double angle) : s(base::sin(angle)), c(base::cos(angle)) {}
  SidePoint operator()(const SidePoint& p) const { return {c * p.x - s * p.z, s * p.x + c * p.z}; }
  SideDisc operator()(const SideDisc& d) const { return {(*this)(d.middle), d.radius}; }
};

/// Largest angle up to `most` at which wheel k fits into the loop and is behind the step; -1 if there is none. `notch`:
/// position of the pins above the edge, pitched; null: no step.
double lowestArm(const Frame& f, std::size_t k, double most, const Pitch& pitched, const SidePoint* notch) {
  const auto fits = [&](double angle) {
    const SideDisc wheel = pitched(f.wheelAt(k, angle));
    const std::vector<SideDisc> discs{pitched(f.sprocket), pitched(f.idler), wheel};
    if (!notch) return shortestLoop(discs) <= f.loop;
    return wheel.middle.x + wheel.radius <= notch->x && shortestLoop(discs, *notch) <= f.loop;
  };
  double low = f.drawn, high = std::max(most, f.drawn);
  if (fits(high)) return high;
  if (!fits(low)) low = 0;
  if (f.rigid || !fits(low)) return -1;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  return high;
}

/// Foremost and lowest centre of mass by motion of the arms and the lower half of the tracks.
SidePoint foremostCentre(const vehicle::VehicleSpec& s, const vehicle::Assembly& drawn, const Frame& f) {
  SidePoint c;
  double mass = 0;
  for (const multibody::Body& body : drawn.model.bodies()) {
    mass += body.mass;
    c.x += body.mass * body.pose.position.x, c.z += body.mass * body.pose.position.z;
  }
  c.x /= mass, c.z /= mass;
  if (f.rigid) return c;
  double farthest = 0;
  for (std::size_t k = 0; k < f.pivots.size(); ++k) {
    const double angle = std::max(f.drawn, lowestArm(f, k, f.hanging, Pitch(0), nullptr));
    const SidePoint from = f.wheelAt(k, f.drawn).middle, to = f.wheelAt(k, angle).middle;
    const double share = 2 * (s.roadWheel.mass + 0.5 * s.arm.mass) / mass;
    c.x += share * std::max(0.0, to.x - from.x), c.z += share * (to.z - from.z);
    farthest = std::max(farthest, distance(from, to));
  }
  const double shoes = s.shoe.mass * s.shoe.count / mass; // half of the mass of both tracks
  return {c.x + shoes * farthest, c.z - shoes * farthest};
}

/// Distance from the centre of mass to the bottom of the hull along the pitched vertical [m]; 0 if outside the hull.
double hullBelow(const base::TriangleMesh& mesh, const SidePoint& centre, double pitch) {
  const double s = base::sin(pitch), c = base::cos(pitch), y = 1.37e-3; // avoids mesh edges in the middle plane
  const Vec3d from{centre.x, y, centre.z}, along{-s, 0, -c};
  std::vector<std::pair<double, int>> crossings; // distance, and 1 at exits, -1 at entries
  int within = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3d a = mesh.vertices[mesh.indices[i]], p = mesh.vertices[mesh.indices[i + 1]] - a,
                q = mesh.vertices[mesh.indices[i + 2]] - a;
    const Vec3d n = base::cross(p, q), r = from - a;
    const double down = dot(n, along);
    if (down == 0) continue;
    const double way = -dot(n, r) / down;
    const Vec3d at = r + way * along;
    const double nn = dot(n, n), u = dot(base::cross(at, q), n) / nn, v = dot(base::cross(p, at), n) / nn;
    if (way <= 0 || u < 0 || v < 0 || u + v > 1) continue;
    crossings.emplace_back(way, down > 0 ? 1 : -1), within += down > 0 ? 1 : -1;
  }
  std::sort(crossings.begin(), crossings.end());
  for (const auto& [way, out] : crossings) {
    if (within <= 0) return 0;
    within -= out;
    if (within == 0) return way;
  }
  return 0;
}

/// Maximum height of an edge above the lowest point at one pitch, at least `least`.
double highestAt(const Frame& f, const SidePoint& centre, double hull, double angle, double least) {
  const Pitch pitched(angle);
  const SidePoint middle = pitched(centre);
  double highest = least;
  for (double below = hull; below < hull + kDeepest; below += kDepthStep) {
    const double edge = middle.z - below;
    const SidePoint inHull{centre.x - below * pitched.s, centre.z - below * pitched.c};
    if (inHull.x > f.first && inHull.x < f.last && inHull.z > f.highestEdge + kDepthStep) continue;
    // The loop is tested at the lower end of this depth step, the height is that of the upper end: an upper bound.
    const SidePoint notch{middle.x, edge - kDepthStep + f.inward};
    const auto keepsOut = [&](std::size_t k) {
      const SidePoint wheel = pitched(f.wheelAt(k, f.drawn)).middle;
      return f.rigid && distance(notch, wheel) < f.wheel - kDepthStep;
    };
    bool out = false;
    for (std::size_t k = 0; k < f.pivots.size(); ++k) out = out || keepsOut(k);
    if (out) continue;
    const auto take = [&](const SideDisc& disc) {
      highest = std::max(highest, edge - pitched(disc).middle.z + f.reach(disc));
    };
    if (shortestLoop({pitched(f.sprocket), pitched(f.idler)}, notch) <= f.loop)
      for (const SideDisc& disc : {f.sprocket, f.idler})
        if (pitched(disc).middle.x + disc.radius <= notch.x) take(disc);
    for (std::size_t k = 0; k < f.pivots.size(); ++k) {
      // A wheel is lowest with a vertical arm.
      const double most = std::max(f.drawn, std::min(f.hanging, 0.5 * base::kPi - angle));
      const SideDisc straight = f.wheelAt(k, most);
      if (edge - pitched(straight).middle.z + f.reach(straight) <= highest) continue;
      const double lowest = lowestArm(f, k, most, pitched, &notch);
      if (lowest >= 0) take(f.wheelAt(k, lowest));
    }
  }
  return highest;
}

} // namespace

double shortestLoop(const std::vector<SideDisc>& discs) {
  std::vector<SidePoint> corners;
  for (const SideDisc& disc : discs) addCorners(disc, corners);
  return perimeter(hullOf(std::move(corners)));
}

double shortestLoop(const std::vector<SideDisc>& discs, const SidePoint& notch) {
  std::vector<SidePoint> corners;
  for (const SideDisc& disc : discs) addCorners(disc, corners);
  const std::vector<SidePoint> hull = hullOf(corners);
  if (!isInside(notch, hull)) return perimeter(hull);
  // Split vertically at the notch: each side of the loop is convex.
  const SidePoint top{notch.x, topAt(hull, notch.x)};
  double length = -2 * distance(notch, top);
  for (const double side : {-1.0, 1.0}) {
    std::vector<SidePoint> half{notch, top};
    for (const SidePoint& p : corners)
      if (side * (p.x - notch.x) > 0) half.push_back(p);
    length += perimeter(hullOf(std::move(half)));
  }
  return length;
}

double highestStep(const vehicle::VehicleSpec& spec, double gravity) {
  const vehicle::Assembly drawn = vehicle::assemble(spec);
  const Frame f = frameOf(spec, drawn.wrap, gravity);
  const base::TriangleMesh hull =
      spheredecomp::importMesh((std::filesystem::path(spec.meshFolder) / spec.chassis.mesh).string());
  const SidePoint centre = foremostCentre(spec, drawn, f);
  double highest = 0;
  for (int degrees = kMinPitch; degrees <= kMaxPitch; degrees += kPitchStep) {
    const double angle = degrees * kDegree;
    highest = highestAt(f, centre, hullBelow(hull, centre, angle), angle, highest);
  }
  return highest;
}

} // namespace grouser::events
