// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/wrap.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace grouser::vehicle {
namespace {

using base::kPi;

/// Tolerance within which a concave kink counts as convex: the top strand meets the sprocket's first gap within a
/// fraction of a degree of the tangent.
constexpr double kConcave = 1.0 * kPi / 180;
/// Closure tolerance of the loop [m]: deviation of the free strands from whole pitches. It is a few ulp of the loop's
/// length; Newton's method reaches this accuracy.
constexpr double kClosed = 1e-14;

PlanePoint onCircle(double cx, double cz, double radius, double angle) {
  return {cx + radius * base::cos(angle), cz + radius * base::sin(angle)};
}
double distance(PlanePoint a, PlanePoint b) { return std::sqrt((b.x - a.x) * (b.x - a.x) + (b.z - a.z) * (b.z - a.z)); }
double direction(PlanePoint a, PlanePoint b) { return base::atan2(b.z - a.z, b.x - a.x); }
double wrapToPi(double angle) { return angle - 2 * kPi * std::floor((angle + kPi) / (2 * kPi)); }

/// Constants shared by all splits.
struct Frame {
  int shoes, teeth;
  double pitch, sprocketRadius, idlerRadius, idlerStep, idlerX, idlerZ, groundZ, rearWheelX, frontWheelX, maximumFold;

  explicit Frame(const VehicleSpec& spec)
      : shoes(spec.shoe.count), teeth(spec.sprocket.teeth), pitch(spec.shoe.pitch),
        sprocketRadius(spec.sprocketPinRadius()), idlerRadius(spec.idlerPinRadius()),
        idlerStep(2 * base::asin(0.5 * spec.shoe.pitch / spec.idlerPinRadius())), idlerX(spec.idler.x),
        idlerZ(spec.idler.z), groundZ(spec.groundPinHeight()), rearWheelX(spec.roadWheel.firstX),
        frontWheelX(spec.lastWheelX()), maximumFold(spec.shoe.maximumFold) {}

  /// Angle of gap k; the gaps are symmetric about the horizontal through the axle: 180 degrees plus k teeth.
  double gapAngle(int k) const { return kPi + 2 * kPi * k / teeth; }
};

/// Unknowns of one split.
struct Ends {
  double idlerX, firstAngle;
};

/// Solves |front strand| = n_front pitch, |top| = n_top pitch by Newton's method for idler x and first pin angle.
std::optional<Ends> solveIdler(const Frame& f, PlanePoint groundEnd, PlanePoint sprocketTop, const WrapCounts& n) {
  Ends u{f.idlerX, -0.5 * kPi};
  const double turn = n.idler * f.idlerStep;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const PlanePoint in = onCircle(u.idlerX, f.idlerZ, f.idlerRadius, u.firstAngle);
    const PlanePoint out = onCircle(u.idlerX, f.idlerZ, f.idlerRadius, u.firstAngle + turn);
    const double front = distance(groundEnd, in), top = distance(sprocketTop, out);
    const double missFront = front - n.frontStrand * f.pitch, missTop = top - n.top * f.pitch;
    if (std::fabs(missFront) <= kClosed && std::fabs(missTop) <= kClosed) return u;

    // d(length)/d(x) = e_x; d(length)/d(angle) = e . d(point)/d(angle), where d(point)/d(angle) = (-(z - z_c), x -
    // x_c).
    const double a = (in.x - groundEnd.x) / front;
    const double b = (-(in.x - groundEnd.x) * (in.z - f.idlerZ) + (in.z - groundEnd.z) * (in.x - u.idlerX)) / front;
    const double c = (out.x - sprocketTop.x) / top;
    const double d =
        (-(out.x - sprocketTop.x) * (out.z - f.idlerZ) + (out.z - sprocketTop.z) * (out.x - u.idlerX)) / top;
    const double determinant = a * d - b * c;
    if (std::fabs(determinant) < 1e-9) return std::nullopt;
    const double stepX = (-missFront * d + missTop * b) / determinant;
    const double stepAngle = (-a * missTop + c * missFront) / determinant;
    u.idlerX += std::clamp(stepX, -0.1, 0.1);
    u.firstAngle += std::clamp(stepAngle, -0.3, 0.3);
    // The last steps only change round-off of the lengths.
    if (iteration > 8 && std::fabs(stepX) < 1e-15 && std::fabs(stepAngle) < 1e-14) return u;
  }
  return std::nullopt;
}

/// Both ends of the pin line in ground contact, which extends under all road wheels.
struct GroundRun {
  PlanePoint start, end;
};
std::optional<GroundRun> groundRun(const Frame& f, int bottomGap, int rearStrand, int ground) {
  const PlanePoint sprocketBottom = onCircle(0, 0, f.sprocketRadius, f.gapAngle(bottomGap));
  const double drop = sprocketBottom.z - f.groundZ, rear = rearStrand * f.pitch;
  if (drop < 0 || drop >= rear) return std::nullopt;
  const PlanePoint start{sprocketBottom.x + std::sqrt((rear - drop) * (rear + drop)), f.groundZ};
  const PlanePoint end{start.x + ground * f.pitch, f.groundZ};
  if (start.x > f.rearWheelX || end.x < f.frontWheelX) return std::nullopt;
  return GroundRun{start, end};
}

/// The closed, convex loop for one split of the shoes, or empty. `topGap` and `bottomGap` count teeth from the gap at
/// 180 degrees.
std::optional<Wrap> closeLoop(const Frame& f, int topGap, int bottomGap, WrapCounts n) {
  n.sprocket = bottomGap - topGap;
  n.top = f.shoes - n.sprocket - n.rearStrand - n.ground - n.frontStrand - n.idler;
  if (n.top < 1) return std::nullopt;
  const PlanePoint sprocketTop = onCircle(0, 0, f.sprocketRadius, f.gapAngle(topGap));
  const PlanePoint sprocketBottom = onCircle(0, 0, f.sprocketRadius, f.gapAngle(bottomGap));

  const auto run = groundRun(f, bottomGap, n.rearStrand, n.ground);
  if (!run) return std::nullopt;
  const PlanePoint groundStart = run->start, groundEnd = run->end;

  const auto ends = solveIdler(f, groundEnd, sprocketTop, n);
  if (!ends) return std::nullopt;
  const PlanePoint in = onCircle(ends->idlerX, f.idlerZ, f.idlerRadius, ends->firstAngle);
  const PlanePoint out = onCircle(ends->idlerX, f.idlerZ, f.idlerRadius, ends->firstAngle + n.idler * f.idlerStep);

  Wrap wrap;
  wrap.counts = n;
  wrap.pitch = f.pitch;
  wrap.idlerX = ends->idlerX;
  wrap.idlerFirstAngle = ends->firstAngle;
  const double halfTooth = kPi / f.teeth;
  const double edges[] = {f.gapAngle(bottomGap) - halfTooth + 0.5 * kPi,
                          direction(sprocketBottom, groundStart),
                          0,
                          direction(groundEnd, in),
                          ends->firstAngle + 0.5 * f.idlerStep + 0.5 * kPi,
                          ends->firstAngle + (n.idler - 0.5) * f.idlerStep + 0.5 * kPi,
                          direction(out, sprocketTop),
                          f.gapAngle(topGap) + halfTooth + 0.5 * kPi};
  wrap.kinks = {wrapToPi(edges[1] - edges[0]), wrapToPi(edges[2] - edges[1]), wrapToPi(edges[3] - edges[2]),
                wrapToPi(edges[4] - edges[3]), wrapToPi(edges[6] - edges[5]), wrapToPi(edges[7] - edges[6])};
  for (const double kink : wrap.kinks)
    if (kink < -kConcave || kink > f.maximumFold) return std::nullopt;

  // Free strands are straight: their pins divide them evenly.
  const auto strand = [&wrap](PlanePoint a, PlanePoint b, int pitches) {
    for (int i = 0; i < pitches; ++i) {
      const double s = static_cast<double>(i) / pitches;
      wrap.pins.push_back({a.x + s * (b.x - a.x), a.z + s * (b.z - a.z)});
    }
  };
  for (int i = 0; i < n.sprocket; ++i) wrap.pins.push_back(onCircle(0, 0, f.sprocketRadius, f.gapAngle(topGap + i)));
  strand(sprocketBottom, groundStart, n.rearStrand);
  strand(groundStart, groundEnd, n.ground);
  strand(groundEnd, in, n.frontStrand);
  for (int i = 0; i < n.idler; ++i)
    wrap.pins.push_back(onCircle(wrap.idlerX, f.idlerZ, f.idlerRadius, wrap.idlerFirstAngle + i * f.idlerStep));
  strand(out, sprocketTop, n.top);
  // A mesh has gap 0 on its x axis; with an odd number of teeth the gap at 180 degrees is half a tooth away.
  wrap.sprocketPhase = f.teeth % 2 == 0 ? 0.0 : halfTooth;
  return wrap;
}

/// Returns the better of two loops: more pins in the sprocket, then the idler nearer to its design position.
bool better(const Wrap& a, const Wrap& b, double idlerX) {
  if (a.counts.sprocket != b.counts.sprocket) return a.counts.sprocket > b.counts.sprocket;
  return std::fabs(a.idlerX - idlerX) < std::fabs(b.idlerX - idlerX);
}

/// Result of a search over all splits.
struct Found {
  std::optional<Wrap> best;    ///< with the idler within its slide range
  std::optional<Wrap> nearest; ///< with the idler nearest to its design position
};

/// True if a strand of `pitches` from `from` can reach the idler within its slide range: the strand is about as long as
/// the tangent, since the kink at the idler is at most the maximum fold.
bool strandFits(const Frame& f, const VehicleSpec& spec, PlanePoint from, int pitches) {
  const double away = distance(from, {f.idlerX, f.idlerZ});
  const double tangent = std::sqrt(std::max(0.0, (away - f.idlerRadius) * (away + f.idlerRadius)));
  const double slack =
      f.idlerRadius * f.maximumFold + f.pitch + 2 * std::max(spec.idler.slideMax, -spec.idler.slideMin);
  return std::fabs(pitches * f.pitch - tangent) <= slack;
}

/// Searches all splits. `anyPlace`: accept any idler position; otherwise only positions within the slide range.
Found search(const VehicleSpec& spec, bool anyPlace) {
  const Frame f(spec);
  Found found;
  const auto consider = [&](const std::optional<Wrap>& wrap) {
    if (!wrap) return;
    const double slide = wrap->idlerX - f.idlerX;
    if (!found.nearest || std::fabs(slide) < std::fabs(found.nearest->idlerX - f.idlerX)) found.nearest = wrap;
    if (slide < spec.idler.slideMin || slide > spec.idler.slideMax) return;
    if (!found.best || better(*wrap, *found.best, f.idlerX)) found.best = wrap;
  };
  // Try all paths of the track from the ground contact over the idler back to the sprocket.
  const auto considerFront = [&](int topGap, int bottomGap, int rear, int ground, PlanePoint groundEnd) {
    const PlanePoint sprocketTop = onCircle(0, 0, f.sprocketRadius, f.gapAngle(topGap));
    for (int front = 1; front <= f.shoes / 4; ++front)
      for (int idler = 2; idler * f.idlerStep < 1.5 * kPi; ++idler) {
        const int top = f.shoes - (bottomGap - topGap) - rear - ground - front - idler;
        if (anyPlace || (strandFits(f, spec, groundEnd, front) && strandFits(f, spec, sprocketTop, top)))
          consider(closeLoop(f, topGap, bottomGap, {0, rear, ground, front, idler, 0}));
      }
  };
  const double span = f.frontWheelX - f.rearWheelX;
  const int groundMin = std::max(1, static_cast<int>(std::floor(span / f.pitch)));
  for (int topGap = -f.teeth / 2; topGap < 0; ++topGap)
    for (int bottomGap = 1; bottomGap <= f.teeth / 2; ++bottomGap)
      for (int rear = 1; rear <= f.shoes / 4; ++rear)
        for (int ground = groundMin; ground <= groundMin + 6; ++ground)
          if (const auto run = groundRun(f, bottomGap, rear, ground))
            considerFront(topGap, bottomGap, rear, ground, run->end);
  return found;
}

/// Returns the vehicle with front and rear exchanged in all data that affect the loop.
VehicleSpec mirrored(VehicleSpec spec) {
  spec.idler.x = -spec.idler.x;
  spec.roadWheel.firstX = -spec.lastWheelX();
  for (double& x : spec.roller.x) x = -x;
  return spec;
}
VehicleSpec atRear(const VehicleSpec& spec) { return spec.sprocketInFront() ? mirrored(spec) : spec; }

/// Returns the loop of a vehicle with its sprocket in front, from the loop of its mirror image.
Wrap mirrored(const Wrap& image, const VehicleSpec& spec) {
  Wrap wrap = image;
  wrap.sprocketInFront = true;
  wrap.sprocketPhase = 0; // a gap of the sprocket is straight ahead
  wrap.idlerX = -image.idlerX;
  const double turn = image.counts.idler * 2 * base::asin(0.5 * spec.shoe.pitch / spec.idlerPinRadius());
  wrap.idlerFirstAngle = wrapToPi(kPi - (image.idlerFirstAngle + turn));
  std::reverse(wrap.kinks.begin(), wrap.kinks.end());
  const std::size_t n = image.pins.size();
  for (std::size_t k = 0; k < n; ++k) {
    const PlanePoint p = image.pins[(n - k) % n];
    wrap.pins[k] = {-p.x, p.z};
  }
  return wrap;
}

/// Number of shoes of a `sound` vehicle with the loop length nearest to the path around the wheels; 0 if none is sound.
int soundCount(VehicleSpec spec, const std::function<bool(const VehicleSpec&)>& sound) {
  const int wanted = static_cast<int>(std::floor(hullLength(spec) / spec.shoe.pitch + 0.5));
  for (const int off : {0, 1, -1, 2, -2, 3, -3}) {
    spec.shoe.count = wanted + off;
    if (spec.shoe.count >= 12 && spec.shoe.count <= 400 && sound(spec)) return spec.shoe.count;
  }
  return 0;
}

/// Idler x for which the path length around the wheels equals the total length of the shoes [m].
double idlerXOfLength(VehicleSpec spec) {
  const double loop = spec.shoe.count * spec.shoe.pitch;
  double low = spec.roadWheel.firstX, high = low + loop;
  for (int i = 0; i < 40; ++i) {
    spec.idler.x = 0.5 * (low + high);
    (hullLength(spec) < loop ? low : high) = spec.idler.x;
  }
  return spec.idler.x;
}

/// Nearest idler x of a `sound` vehicle, rounded to 0.1 mm, searched in steps of 5 mm; 0 if none is sound within 0.6 m
/// or near the position required by the loop.
double soundIdlerX(VehicleSpec spec, const std::optional<Wrap>& nearest,
                   const std::function<bool(const VehicleSpec&)>& sound) {
  const double drawn = spec.idler.x, asked = idlerXOfLength(spec);
  const auto fits = [&](double x) {
    spec.idler.x = std::floor(1e4 * x + 0.5) / 1e4;
    return x > 0 && sound(spec);
  };
  if (nearest && fits(nearest->idlerX)) return spec.idler.x;
  for (const double about : {drawn, asked})
    for (int k = 0; k <= 120; ++k)
      for (const double side : {-1.0, 1.0})
        if (fits(about + side * 0.005 * k)) return spec.idler.x;
  return 0;
}

} // namespace

double Wrap::closure() const {
  double worst = 0;
  for (std::size_t i = 0; i < pins.size(); ++i)
    worst = std::max(worst, std::fabs(distance(pins[i], pins[(i + 1) % pins.size()]) - pitch));
  return worst;
}

PlanePoint Wrap::shoeCentre(int i) const {
  const PlanePoint a = pins[i], b = pins[(i + 1) % pins.size()];
  return {0.5 * (a.x + b.x), 0.5 * (a.z + b.z)};
}

double Wrap::shoeAngle(int i) const { return direction(pins[i], pins[(i + 1) % pins.size()]); }

base::Quat planeRotation(double angle) { return {base::cos(0.5 * angle), 0, -base::sin(0.5 * angle), 0}; }

std::optional<Wrap> findWrap(const VehicleSpec& spec) {
  std::optional<Wrap> wrap = search(atRear(spec), false).best;
  if (wrap && spec.sprocketInFront()) return mirrored(*wrap, spec);
  return wrap;
}

Wrap wrapTrack(const VehicleSpec& spec) {
  if (const std::optional<Wrap> wrap = findWrap(spec)) return *wrap;
  const ClosureFault fault = closureFault(spec, [](const VehicleSpec& other) { return findWrap(other).has_value(); });
  throw base::InputError(
      fmt::format("vehicle {}: {}; {}", spec.name, fault.gap,
                  fault.advice.empty() ? "no single change of shoe.count or idler.x closes the track" : fault.advice));
}

ClosureFault closureFault(const VehicleSpec& given, const std::function<bool(const VehicleSpec&)>& accepts) {
  const double side = given.outward();
  const VehicleSpec spec = atRear(given);
  const auto sound = [&](const VehicleSpec& other) { return accepts(side < 0 ? mirrored(other) : other); };
  const double loop = spec.shoe.count * spec.shoe.pitch, way = hullLength(spec);
  const std::optional<Wrap> nearest = search(spec, true).nearest;
  ClosureFault fault;
  if (nearest)
    fault.gap = fmt::format("{} shoes of pitch {:g} m (loop {:.4f} m) close only with the idler at x = {:.4f} m, "
                            "{:+.1f} mm from idler.x = {:.4f} m, outside its slide range [{:g}, {:g}] mm",
                            spec.shoe.count, spec.shoe.pitch, loop, side * nearest->idlerX,
                            side * 1e3 * (nearest->idlerX - spec.idler.x), side * spec.idler.x,
                            1e3 * spec.idler.slideMin, 1e3 * spec.idler.slideMax);
  else
    fault.gap = fmt::format("the track does not close: {} shoes of pitch {:g} m are {:.4f} m long, the path around the "
                            "wheels is {:.4f} m (difference {:+.1f} mm)",
                            spec.shoe.count, spec.shoe.pitch, loop, way, 1e3 * (loop - way));
  if (const double x = soundIdlerX(spec, nearest, sound); x > 0)
    fault.advice = fmt::format("set idler.x = {:.4f}", side * x);
  if (const int count = soundCount(spec, sound); count > 0)
    fault.advice += fmt::format("{}set shoe.count = {}", fault.advice.empty() ? "" : ", or ", count);
  return fault;
}

double hullLength(const VehicleSpec& spec) {
  // Perimeter of the convex hull of finely sampled circles and the ends of the ground contact (Andrew's monotone
  // chain). A polygon of pins is shorter than its circle; these circles have the length of the polygon per radian.
  const Frame f(atRear(spec));
  const double sprocketRadius = spec.pitchRadius(), idlerRadius = f.pitch / f.idlerStep;
  std::vector<PlanePoint> points{{f.rearWheelX, f.groundZ}, {f.frontWheelX, f.groundZ}};
  constexpr int kCuts = 720;
  for (int i = 0; i < kCuts; ++i) {
    points.push_back(onCircle(0, 0, sprocketRadius, 2 * kPi * i / kCuts));
    points.push_back(onCircle(f.idlerX, f.idlerZ, idlerRadius, 2 * kPi * i / kCuts));
  }
  std::sort(points.begin(), points.end(),
            [](PlanePoint a, PlanePoint b) { return a.x < b.x || (a.x == b.x && a.z < b.z); });
  const auto turnsRight = [](PlanePoint a, PlanePoint b, PlanePoint c) {
    return (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x) <= 0;
  };
  std::vector<PlanePoint> hull;
  const auto chain = [&](auto begin, auto end, std::size_t base) {
    for (auto it = begin; it != end; ++it) {
      while (hull.size() >= base + 2 && turnsRight(hull[hull.size() - 2], hull.back(), *it)) hull.pop_back();
      hull.push_back(*it);
    }
    hull.pop_back();
  };
  chain(points.begin(), points.end(), 0);
  chain(points.rbegin(), points.rend(), hull.size());
  double length = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) length += distance(hull[i], hull[(i + 1) % hull.size()]);
  return length;
}

} // namespace grouser::vehicle
