// SPDX-License-Identifier: BSD-3-Clause
// Fields of a scene file: rigid surfaces that grains touch.
#include "runs/scene/detail/scene_tables.hpp"

#include "spheredecomp/decompose.hpp"

#include <fmt/format.h>

namespace grouser::scene::detail {

using base::Table;

namespace {

/// What all rigid surfaces have alike.
template <class S> void addSurface(Table<S>& t) {
  using base::Vec3d;
  using Number = std::optional<double>;
  using Vector = std::optional<Vec3d>;
  t.template add<std::string>("material", &S::material, "", "name of its material").required();
  t.template add<std::optional<std::string>>("name", &S::name, "",
                                             "in results.h5 and timeseries.csv; kind and number where not given");
  t.template add<Vector>("velocity", &S::velocity, "m/s", "at which it is moved").atLeast(-1e4).atMost(1e4);
  t.template add<Vector>("spin", &S::spin, "rad/s", "angular velocity at which it is turned, in the world")
      .atLeast(-1e5)
      .atMost(1e5);
  t.template add<Vector>("pivot", &S::pivot, "m",
                         "that it is turned about, which velocity moves along; its own centre where not given");
  t.template add<Vector>("amplitude", &S::amplitude, "m", "of an oscillation, along this vector");
  t.template add<Number>("frequency", &S::frequency, "Hz", "of that oscillation").above(0).atMost(1e5);
  t.template add<Number>("phase", &S::phase, "deg", "of that sine at the start; -90 begins from rest")
      .atLeast(-360)
      .atMost(360);
  t.template add<Number>("start", &S::start, "s", "when velocity, spin and oscillation begin").atLeast(0).atMost(1e5);
  t.template add<Number>("until", &S::until, "s", "when they end").above(0).atMost(1e5);
  t.template add<std::optional<Axis>>("free", &S::free, "",
                                      "axis along which load, grains and weight move it, from the start");
  t.template add<Number>("mass", &S::mass, "kg", "of a free surface; required there").above(0).atMost(1e12);
  t.template add<Number>("load", &S::load, "N", "on a free surface along its axis; negative presses down where z is up")
      .atLeast(-1e12)
      .atMost(1e12);
  t.template add<Number>("load_ramp", &S::loadRamp, "s", "over which the load comes on; at once where not given")
      .atLeast(0)
      .atMost(1e5);
}

/// How a surface that has axes of its own stands at the start; `from`: whose axes it is turned from.
template <class S> void addTurn(Table<S>& t, const std::string& from) {
  t.add("axis", &S::axis, "-", "about which it is turned from the " + from + " axes, with angle");
  t.add("angle", &S::angle, "deg", "of that turn, right-handed").atLeast(-3600).atMost(3600);
  t.add("orientation", &S::orientation, "-", "unit quaternion w, x, y, z, instead of axis and angle");
}

} // namespace

Table<Plane> planeTable() {
  using S = Plane;
  Table<S> t("[plane]", "A rigid plane; the solid lies behind its normal. Fixed, or moved as boxes are");
  t.add("point", &S::point, "m", "any point of the plane; loads are taken about it");
  t.add("normal", &S::normal, "-", "out of the solid; of any length but zero");
  addSurface(t);
  return t;
}

Table<BoxSection> boxTable() {
  using S = BoxSection;
  Table<S> t("[box]", "A solid rigid box that grains touch, fixed or moved");
  t.add("position", &S::position, "m", "of its centre").required();
  t.add("size", &S::size, "m", "its edges along x, y, z before it is turned").above(0).atMost(1e5).required();
  addTurn(t, "world's");
  addSurface(t);
  return t;
}

Table<CylinderSection> cylinderTable() {
  using S = CylinderSection;
  Table<S> t("[cylinder]", "A rigid cylinder that grains touch, fixed or moved: a solid rod with flat ends, or hollow");
  t.add("position", &S::position, "m", "of its centre").required();
  t.add("axis", &S::axis, "-", "its direction; of any length but zero");
  t.add("radius", &S::radius, "m", "of its wall").above(0).atMost(1e5).required();
  t.add("length", &S::length, "m", "along its axis").above(0).atMost(1e5).required();
  t.add("hollow", &S::hollow, "", "a drum or pipe without thickness, felt from inside and outside, open at both ends");
  addSurface(t);
  return t;
}

Table<MeshSection> meshTable() {
  using S = MeshSection;
  Table<S> t("[mesh]", "A rigid body from a file that grains touch, fixed or moved, cut into spheres");
  t.add("file", &S::file, "", "OBJ, STL, PLY...: closed, outward; relative to the scene or to the assets folder")
      .required();
  t.add("scale", &S::scale, "m", "of one unit of the file").above(0).atMost(1e6);
  t.add("position", &S::position, "m", "of the file's origin, about which loads are taken");
  addTurn(t, "file's");
  t.add("sphere_radius", &S::sphereRadius, "m",
        fmt::format("of the spheres it is cut into, which round its edges; {} of its diagonal where not given",
                    S::kShareOfDiagonal))
      .atLeast(spheredecomp::kSmallestRadius)
      .atMost(spheredecomp::kLargestRadius);
  addSurface(t);
  return t;
}

} // namespace grouser::scene::detail
