// SPDX-License-Identifier: BSD-3-Clause
#include "contact/gear_surfaces.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::contact {

using base::squareRoot;
using base::Vec3d;

namespace {

// Gauss-Legendre points and weights on [-1, 1].
constexpr double kGauss3[3] = {-0.7745966692414834, 0, 0.7745966692414834};
constexpr double kWeight3[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
constexpr double kGauss4[4] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
constexpr double kWeight4[4] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
constexpr PointLanes kGauss8{-0.9602898564975363, -0.7966664774136267, -0.5255324099163290, -0.1834346424956498,
                             0.1834346424956498,  0.5255324099163290,  0.7966664774136267,  0.9602898564975363};
constexpr PointLanes kWeight8{0.1012285362903763, 0.2223810344533745, 0.3137066458778873, 0.3626837833783620,
                              0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
constexpr double kGauss2 = 0.5773502691896257;

GROUSER_SIMD PointLanes rootOf(const PointLanes& x) { return squareRoot(greater(x, allLanes(0))); }

} // namespace

GROUSER_SIMD_CLONES PressureLanes pressRims(const PatchLaw& law, double timeStep, const RimsOnPlates& r) {
  PressureLanes sums;
  sums.clear();
  // Squared distance from the axis along a strip: D + 2 B s + A s^2.
  const Vec3P slant = r.along - r.axis * dot(r.along, r.axis);
  const PointLanes a = dot(slant, slant), none = allLanes(0), tiny = allLanes(1e-12);
  const PointLanes middle = (r.from + r.to) * 0.5, halfWidth = greater((r.to - r.from) * 0.5, none);
  for (int strip = 0; strip < RimQuadrature::kStrips; ++strip) {
    const Vec3P line = r.plate + r.across * (middle + halfWidth * kGauss3[strip]);
    const Vec3P apart = line - r.axle, radial = apart - r.axis * dot(apart, r.axis);
    const PointLanes b = dot(radial, slant), d = dot(radial, radial);
    const PointLanes inside = b * b - a * (d - r.radius * r.radius), root = rootOf(inside);
    const PointLanes first = greater((none - b - root) / a, none - r.halfLength);
    const PointLanes last = lesser((root - b) / a, r.halfLength);
    const PointLanes half = inside > none ? greater((last - first) * 0.5, none) : none, centre = (first + last) * 0.5;
    const PointLanes width = half * halfWidth * kWeight3[strip];
    for (int k = 0; k < RimQuadrature::kAlong; ++k) {
      const PointLanes s = centre + half * kGauss4[k];
      const Vec3P out = radial + slant * s;
      const PointLanes rho = greater(rootOf(dot(out, out)), tiny);
      const PointLanes overlap = r.radius - rho;
      const Vec3P normal = out * (1.0 / rho);
      sums.add(law, timeStep, r.motion, line + r.along * s + normal * (overlap * 0.5), normal, overlap,
               width * kWeight4[k]);
    }
  }
  return sums;
}

/// Lanes contain columns of the face. Each column is integrated from the chamfer of the disc to the point where the
/// face leaves the disc side, in two intervals: one is nearest to the chamfer, the other to the side.
GROUSER_SIMD_CLONES PatchPressure pressFace(const PatchLaw& law, double timeStep, const FaceAtDisc& f) {
  PressureLanes sums;
  sums.clear();
  // Face point: foot + along x + up u, 0 <= u <= 1. Its depth behind the disc side: deep + deepX x + deepU u.
  const Vec3d apart = f.foot - f.axle;
  const double deep = dot(apart, f.axis), deepX = dot(f.along, f.axis), deepU = dot(f.up, f.axis);
  const Vec3d radial = apart - f.axis * deep, radialX = f.along - f.axis * deepX, radialU = f.up - f.axis * deepU;
  // Upper bound of u behind the disc side, and the chord of the disc there.
  const double most = deep + std::fabs(deepX) * f.halfFoot;
  const double top = deepU < 0 ? std::min(1.0, most / -deepU) : 1;
  if (!(most > 0 || most + deepU > 0) || !(top > 0)) return sums.sum();
  const Vec3d there = radial + radialU * top;
  const double a = dot(radialX, radialX), b = dot(there, radialX);
  const double reach = f.radius - f.chamfer + std::max(most + deepU * top, 0.0);
  const double inside = b * b - a * (dot(there, there) - reach * reach);
  if (!(inside > 0)) return sums.sum();
  const double root = std::sqrt(inside), low = std::max((-b - root) / a, -f.halfFoot);
  const double high = std::min((root - b) / a, f.halfFoot);
  if (!(high > low)) return sums.sum();

  const PointLanes none = allLanes(0), one = allLanes(1);
  const PointLanes x = kGauss8 * (0.5 * (high - low)) + 0.5 * (low + high);
  const PointLanes ends = base::absolute(x);
  // The half length of the trapezoid decreases from halfFoot to halfTip.
  const double narrowing = f.halfFoot - f.halfTip;
  PointLanes to = narrowing > 0 ? lesser((f.halfFoot - ends) * (1 / narrowing), one) : one;
  PointLanes from = none;
  const PointLanes depthAtFoot = x * deepX + deep;
  if (deepU < 0)
    to = lesser(to, depthAtFoot * (1 / -deepU));
  else if (deepU > 0)
    from = greater(from, (none - depthAtFoot) * (1 / deepU));
  else
    to = depthAtFoot > none ? to : none;
  const Vec3P column = allLanes(radial) + allLanes(radialX) * x, rise = allLanes(radialU);
  const double au = dot(radialU, radialU);
  const double flat = f.radius - f.chamfer;
  const PointLanes bu = dot(column, rise), c2 = dot(column, column), insideU = bu * bu - (c2 - flat * flat) * au;
  const PointLanes rootU = rootOf(insideU), first = (none - bu - rootU) * (1 / au), tiny = allLanes(1e-12);
  to = insideU > none ? lesser(to, (rootU - bu) * (1 / au)) : none;
  // Solves radius - rho + share x side = chamfer for u by Newton iteration, starting from the solution for side = 0.
  const auto reaches = [&](double share) {
    PointLanes u = first;
    for (int k = 0; k < 2; ++k) {
      const PointLanes rho = greater(rootOf(c2 + u * (bu * 2.0 + u * au)), tiny);
      const PointLanes slope = share * deepU - (bu + u * au) / rho;
      u -= insideU > none ? (flat - rho + (depthAtFoot + u * deepU) * share) / slope : none;
    }
    return u;
  };
  constexpr double kBehindChamfer = 0.41421356237309503; // sqrt(2) - 1: equal distance from chamfer and side
  from = greater(from, reaches(1));
  const PointLanes change = greater(from, lesser(to, reaches(-kBehindChamfer)));

  const Vec3P axis = allLanes(f.axis), origin = allLanes(f.foot) + allLanes(f.along) * x;
  const double diagonal = std::sqrt(0.5), width = 0.5 * (high - low) * norm(f.up);
  const RelativeMotion<PointLanes> motion = allLanes(f.motion);
  for (int piece = 0; piece < 2; ++piece) {
    const PointLanes begin = piece == 0 ? from : change, end = piece == 0 ? lesser(change, to) : to;
    const PointLanes half = greater((end - begin) * 0.5, none), middle = (begin + end) * 0.5;
    for (int k = 0; k < 3; ++k) {
      const PointLanes u = middle + half * kGauss3[k];
      const Vec3P out = column + rise * u;
      const PointLanes rho = greater(rootOf(dot(out, out)), tiny);
      const Vec3P outward = out * (1.0 / rho);
      const PointLanes side = depthAtFoot + u * deepU, rim = f.radius - rho;
      const PointLanes edge = (side + rim - f.chamfer) * diagonal;
      PointLanes overlap = side;
      Vec3P normal = -axis;
      normal = base::select(rim < overlap, outward, normal), overlap = lesser(overlap, rim);
      normal = base::select(edge < overlap, (outward - axis) * allLanes(diagonal), normal);
      overlap = lesser(overlap, edge);
      sums.add(law, timeStep, motion, origin + allLanes(f.up) * u + normal * (overlap * 0.5), normal, overlap,
               kWeight8 * half * (width * kWeight3[k]));
    }
  }
  return sums.sum();
}

GapProfile::GapProfile(int number, double pins, double seat, double seatHalfAngle, double flank, double tip)
    : teeth(number), pinRadius(pins), seatRadius(seat), flankRadius(flank), tipRadius(tip),
      seatCos(base::cos(seatHalfAngle)), seatSin(base::sin(seatHalfAngle)), flankX((seat + flank) * seatSin),
      flankY(-(seat + flank) * seatCos), seatStep(seatHalfAngle / kSeatPoints) {
  if (teeth > kMaxTeeth) throw base::InputError("a sprocket with shapes has at most 64 teeth");
  for (std::size_t k = 0; k < kSeatPoints; ++k) {
    const double angle = (static_cast<double>(k) + 0.5) * seatStep;
    sine[k / kPointLanes][k % kPointLanes] = base::sin(angle);
    cosine[k / kPointLanes][k % kPointLanes] = base::cos(angle);
  }
  for (std::size_t k = 0; k < kAround; ++k) {
    const double angle = 2 * base::kPi * (static_cast<double>(k) + 0.5) / kAround;
    around[k / kPointLanes][0][k % kPointLanes] = base::cos(angle);
    around[k / kPointLanes][1][k % kPointLanes] = base::sin(angle);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(teeth); ++k) {
    const double angle = 2 * base::kPi * static_cast<double>(k) / teeth;
    gapCos[k] = base::cos(angle), gapSin[k] = base::sin(angle);
  }
}

namespace {

constexpr double kShallow = 0.25; ///< largest overlap [boss radius] for the closed-form limits

/// Strip of a boss in one half of a gap; x is positive in that half.
struct HalfGap {
  const GapProfile& gap;
  double bossX, bossY, radius, width;
  // A profile point (x, y) is origin + tangent x + outward y in the world.
  Vec3d origin, tangent, outward;
  const PatchLaw& law;
  double timeStep;
  RelativeMotion<PointLanes> motion;

  GROUSER_SIMD void add(PressureLanes& sums, const PointLanes& x, const PointLanes& y, const PointLanes& normalX,
                        const PointLanes& normalY, const PointLanes& overlap, const PointLanes& length) const {
    const Vec3P normal = allLanes(tangent) * normalX + allLanes(outward) * normalY;
    const Vec3P at = allLanes(origin) + allLanes(tangent) * x + allLanes(outward) * y;
    sums.add(law, timeStep, motion, at + normal * (overlap * 0.5), normal, overlap, length * width);
  }

  // seat() and flank() return false if they added nothing.

  /// Computes contact with the seat, by rays from its centre that reach the boss at distance t.
  GROUSER_SIMD bool seat(PressureLanes& sums) const {
    const double c2 = bossX * bossX + bossY * bossY, r = gap.seatRadius;
    if (!(c2 > (r - radius) * (r - radius)) || !(c2 < radius * radius)) return false;
    // Overlap along the ray at angle a from the bottom of the seat increases with p(a) = x sin(a) - y cos(a).
    const double towards = bossX > 0 && -bossY > gap.seatCos * std::sqrt(c2) ? std::sqrt(c2)
                           : bossX > 0                                       ? bossX * gap.seatSin - bossY * gap.seatCos
                                                                             : -bossY;
    if (!(2 * r * towards > r * r + c2 - radius * radius)) return false;
    for (std::size_t k = 0; k < gap.sine.size(); ++k) {
      const PointLanes s = gap.sine[k], c = gap.cosine[k];
      const PointLanes p = s * bossX - c * bossY, root = squareRoot(p * p + (radius * radius - c2)), t = p + root;
      const PointLanes turned = (c * bossX + s * bossY) * t / root; // dt / dangle
      const PointLanes length = squareRoot(t * t + turned * turned) * gap.seatStep;
      add(sums, s * t, -c * t, -s, c, t - gap.seatRadius, length);
    }
    return true;
  }

  /// Computes contact with the flank: arc of the boss inside the flank circle, beyond the seat.
  GROUSER_SIMD bool flank(PressureLanes& sums) const {
    const double x = gap.flankX, y = gap.flankY, r = gap.flankRadius;
    const double mx = bossX - x, my = bossY - y, m2 = mx * mx + my * my, m = std::sqrt(m2);
    if (!(m < r + radius) || !(m > 0)) return false;
    const double k = (m2 + radius * radius - r * r) / (2 * radius * m);
    const double ux = mx / m, uy = my / m;
    double most = k > 0 ? std::sqrt(std::max(1 - k * k, 0.0)) : 1, least = -most;
    most = std::min(most, 0.999), least = std::max(least, -0.999);
    // Boundary with the seat: the line from the flank centre to the pin.
    const double away = std::sqrt(x * x + y * y), ex = -x / away, ey = -y / away;
    const double along = mx * ex + my * ey, inside = along * along - m2 + radius * radius;
    if (inside > 0) {
      const double t = along - std::sqrt(inside), dx = t * ex - mx, dy = t * ey - my;
      least = std::max(least, (dx * uy - dy * ux) / radius);
    } else if (ex * my - ey * mx > 0) {
      return false;
    }
    if (!(most > least)) return false;
    const PointLanes w = kGauss8 * (0.5 * (most - least)) + 0.5 * (most + least);
    const PointLanes c = squareRoot(1.0 - w * w), length = kWeight8 * (0.5 * (most - least) * radius) / c;
    // (-uy, ux) is u rotated by 90 degrees.
    const PointLanes px = bossX - (c * ux - w * uy) * radius, py = bossY - (c * uy + w * ux) * radius;
    const PointLanes qx = px - x, qy = py - y, q = squareRoot(qx * qx + qy * qy);
    add(sums, px, py, qx / q, qy / q, r - q, length);
    return true;
  }

  enum class Depth { apart, shallow, deep };

  /// Classifies the overlap. seat() and flank() require a shallow one: a small fraction of the boss radius, and every
  /// overlapping point nearer to the flank than to the tip circle.
  GROUSER_SIMD Depth depth() const {
    const double most = kShallow * radius, r = gap.flankRadius, mx = bossX - gap.flankX, my = bossY - gap.flankY;
    const double m = std::sqrt(mx * mx + my * my), inFlank = r + radius - m;
    const double towards = bossY > 0 ? bossX * gap.seatSin - bossY * gap.seatCos // end of the seat
                                     : std::sqrt(bossX * bossX + bossY * bossY);
    const double inSeat = towards - (gap.seatRadius - radius);
    if (!(inFlank > 0) && !(inSeat > 0)) return Depth::apart;
    if (!(inFlank < most) || !(inSeat < most)) return Depth::deep;
    if (!(inFlank > 0)) return Depth::shallow;
    // End of the arc in the flank, on the tip side.
    const double c = (m * m + radius * radius - r * r) / (2 * radius * m), w = std::sqrt(std::max(1 - c * c, 0.0));
    const double x = bossX - (c * mx - w * my) / m * radius, y = bossY - (c * my + w * mx) / m * radius;
    const double fromAxle = std::sqrt(x * x + (gap.pinRadius + y) * (gap.pinRadius + y));
    return gap.tipRadius - fromAxle > inFlank ? Depth::shallow : Depth::deep;
  }

  /// Computes contact at any depth, by points fixed on the circumference of the boss, which makes the forces
  /// conservative. `x`, `y`: profile components of two perpendicular axes of the boss.
  GROUSER_SIMD void whole(PressureLanes& sums, const base::Vec3d& x, const base::Vec3d& y) const {
    const PointLanes none = allLanes(0), tiny = allLanes(1e-12);
    const double share = 2 * base::kPi * radius / GapProfile::kAround;
    for (const auto& [c, s] : gap.around) {
      const PointLanes px = bossX + (c * x.x + s * y.x) * radius, py = bossY + (c * x.y + s * y.y) * radius;
      const PointLanes p = greater(rootOf(px * px + py * py), tiny);
      const PointLanes fx = px - gap.flankX, fy = py - gap.flankY, f = greater(rootOf(fx * fx + fy * fy), tiny);
      const PointLanes ty = py + gap.pinRadius, t = greater(rootOf(px * px + ty * ty), tiny);
      const PointLanes inFlank = gap.flankRadius - f, inTip = gap.tipRadius - t;
      const auto onSeat = py < p * -gap.seatCos, onTip = inTip < inFlank;
      const PointLanes overlap = onSeat ? p - gap.seatRadius : onTip ? inTip : inFlank;
      const PointLanes nx = onSeat ? -px / p : onTip ? px / t : fx / f;
      const PointLanes ny = onSeat ? -py / p : onTip ? ty / t : fy / f;
      add(sums, px, py, nx, ny, overlap, px > none ? allLanes(share) : none);
    }
  }
};

} // namespace

GROUSER_SIMD_CLONES std::array<PatchPressure, 2> pressBoss(const PatchLaw& law, double timeStep, const GapProfile& gap,
                                                           const BossInGap& b) {
  std::array<PressureLanes, 2> sums;
  std::array<bool, 2> any{};
  for (PressureLanes& s : sums) s.clear();
  const double middle = 0.5 * (b.from + b.to), half = 0.5 * (b.to - b.from);
  int at = -1;
  for (const double strip : {-kGauss2, kGauss2}) {
    const Vec3d centre = b.boss + b.across * (middle + half * strip), apart = centre - b.axle;
    const double x = dot(apart, b.x), z = dot(apart, b.z);
    const double beyond = gap.tipRadius + b.radius;
    if (x * x + z * z > beyond * beyond) continue;
    if (at < 0) {
      double nearest = -1e300;
      for (int k = 0; k < gap.teeth; ++k) {
        const auto i = static_cast<std::size_t>(k);
        if (const double along = x * gap.gapCos[i] + z * gap.gapSin[i]; along > nearest) nearest = along, at = k;
      }
    }
    const double c = gap.gapCos[static_cast<std::size_t>(at)], s = gap.gapSin[static_cast<std::size_t>(at)];
    const double across = z * c - x * s, out = x * c + z * s - gap.pinRadius;
    const Vec3d outward = b.x * c + b.z * s, tangent = b.z * c - b.x * s;
    const Vec3d origin = b.axle + b.axis * dot(apart, b.axis) + outward * gap.pinRadius;
    for (std::size_t side = 0; side < 2; ++side) {
      const double sign = side == 0 ? -1 : 1;
      const HalfGap on{gap,     sign * across, out,      b.radius,          half, origin, tangent * sign,
                       outward, law,           timeStep, allLanes(b.motion)};
      const HalfGap::Depth depth = on.depth();
      if (depth == HalfGap::Depth::apart) continue;
      if (depth == HalfGap::Depth::deep) {
        const auto inGap = [&](const Vec3d& v) { return Vec3d{sign * dot(v, tangent), dot(v, outward), 0}; };
        any[side] = true;
        on.whole(sums[side], inGap(b.alongX), inGap(b.alongZ));
        continue;
      }
      const bool onSeat = on.seat(sums[side]);
      const bool onFlank = on.flank(sums[side]);
      any[side] = any[side] || onSeat || onFlank;
    }
  }
  return {any[0] ? sums[0].sum() : PatchPressure{}, any[1] ? sums[1].sum() : PatchPressure{}};
}

} // namespace grouser::contact
