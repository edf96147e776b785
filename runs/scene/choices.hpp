// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "base/peer_memory.hpp"
#include "contact/mixing.hpp"
#include "multibody/model.hpp"
#include "multibody/solver_options.hpp"
#include "runs/support/device_choice.hpp"
#include "terrain/bed_plan.hpp"
#include "terrain/grain_model.hpp"
#include "terrain/radius_distribution.hpp"
#include "vehicle/driver.hpp"
#include "vehicle/hitch.hpp"

/// Enums of scene files and their words. Enums of the solvers are used directly; their words are defined only here.
namespace grouser::scene {

/// Source of the centres of [[grains]].
enum class FillForm { lattice, random, file };

/// Contact method of grains, [run].
enum class ContactMethod {
  penalty,        ///< springs and dashpots, explicit in time
  complementarity ///< impulses of all contacts, solved simultaneously
};

/// Ground of [terrain].
enum class TerrainKind {
  granular,
  rigid,
  scm ///< deformable soil (soil contact model)
};

/// [scm]: source of the constants that the section omits.
enum class SoilConstantsFrom { published, measured };

/// Initial arrangement of the grains of a granular [terrain].
enum class Arrangement { random, lattice };

/// Mount of the chassis of [vehicle].
enum class ChassisMount {
  free,
  fixed,
  guided, ///< can move along its heading, heave and pitch
  level   ///< can move along its heading and heave
};

/// Tracks of [vehicle].
enum class Tracks {
  both,
  single ///< one track in the middle of the hull, as on a test rig
};

/// Parts of [vehicle] with soil contact.
enum class SoilContact {
  all,  ///< every part but the hull
  shoes ///< no wheel, sprocket, idler or roller
};

/// Axes of the world.
enum class Axis { x, y, z };

/// Surface of a body.
enum class ShapeKind { sphere, box, cylinder, capsule, cone, mesh };

/// Time of placement of a surface in a scene with a settling bed, which settles around surfaces placed before.
enum class PlacedWhen { before, afterSettling };

} // namespace grouser::scene

namespace grouser::base {

template <> struct EnumWords<vehicle::SprocketDrive> {
  using E = vehicle::SprocketDrive;
  static constexpr EnumWord<E> list[] = {{E::speed, "speed"}, {E::torque, "torque"}, {E::engine, "engine"}};
};

template <> struct EnumWords<vehicle::HitchKind> {
  using E = vehicle::HitchKind;
  static constexpr EnumWord<E> list[] = {
      {E::force, "force"}, {E::ramp, "ramp"}, {E::sled, "sled"}, {E::speed, "speed"}};
};

template <> struct EnumWords<contact::LawKind> {
  using E = contact::LawKind;
  static constexpr EnumWord<E> list[] = {{E::linear, "linear"},
                                         {E::hertz, "hertz"},
                                         {E::eepa, "eepa"},
                                         {E::eepaLinear, "eepa_linear"},
                                         {E::luding, "luding"}};
};
template <> struct EnumWords<scene::FillForm> {
  using E = scene::FillForm;
  static constexpr EnumWord<E> list[] = {{E::lattice, "lattice"}, {E::random, "random"}, {E::file, "file"}};
};
template <> struct EnumWords<scene::TerrainKind> {
  using E = scene::TerrainKind;
  static constexpr EnumWord<E> list[] = {{E::granular, "granular"}, {E::rigid, "rigid"}, {E::scm, "scm"}};
};
template <> struct EnumWords<scene::SoilConstantsFrom> {
  using E = scene::SoilConstantsFrom;
  static constexpr EnumWord<E> list[] = {{E::published, "published"}, {E::measured, "measured"}};
};
template <> struct EnumWords<scene::Arrangement> {
  using E = scene::Arrangement;
  static constexpr EnumWord<E> list[] = {{E::random, "random"}, {E::lattice, "lattice"}};
};
template <> struct EnumWords<scene::ChassisMount> {
  using E = scene::ChassisMount;
  static constexpr EnumWord<E> list[] = {
      {E::free, "free"}, {E::fixed, "fixed"}, {E::guided, "guided"}, {E::level, "level"}};
};
template <> struct EnumWords<scene::Tracks> {
  using E = scene::Tracks;
  static constexpr EnumWord<E> list[] = {{E::both, "both"}, {E::single, "single"}};
};
template <> struct EnumWords<scene::SoilContact> {
  using E = scene::SoilContact;
  static constexpr EnumWord<E> list[] = {{E::all, "all"}, {E::shoes, "shoes"}};
};
template <> struct EnumWords<scene::Axis> {
  using E = scene::Axis;
  static constexpr EnumWord<E> list[] = {{E::x, "x"}, {E::y, "y"}, {E::z, "z"}};
};
template <> struct EnumWords<scene::ShapeKind> {
  using E = scene::ShapeKind;
  static constexpr EnumWord<E> list[] = {{E::sphere, "sphere"},   {E::box, "box"},   {E::cylinder, "cylinder"},
                                         {E::capsule, "capsule"}, {E::cone, "cone"}, {E::mesh, "mesh"}};
};
template <> struct EnumWords<scene::PlacedWhen> {
  using E = scene::PlacedWhen;
  static constexpr EnumWord<E> list[] = {{E::before, "before"}, {E::afterSettling, "after_settling"}};
};
template <> struct EnumWords<scene::ContactMethod> {
  using E = scene::ContactMethod;
  static constexpr EnumWord<E> list[] = {{E::penalty, "penalty"}, {E::complementarity, "complementarity"}};
};
template <> struct EnumWords<contact::ImpulseFriction> {
  using E = contact::ImpulseFriction;
  static constexpr EnumWord<E> list[] = {{E::coulomb, "coulomb"}, {E::associated, "associated"}};
};
template <> struct EnumWords<contact::Compliance> {
  using E = contact::Compliance;
  static constexpr EnumWord<E> list[] = {{E::law, "law"}, {E::rigid, "rigid"}};
};
template <> struct EnumWords<terrain::Precision> {
  using E = terrain::Precision;
  static constexpr EnumWord<E> list[] = {{E::single, "single"}, {E::double_, "double"}};
};
template <> struct EnumWords<terrain::FloorShape> {
  using E = terrain::FloorShape;
  static constexpr EnumWord<E> list[] = {{E::follow, "follow"}, {E::flat, "flat"}};
};
template <> struct EnumWords<terrain::Interpolation> {
  using E = terrain::Interpolation;
  static constexpr EnumWord<E> list[] = {{E::monotone, "monotone"}, {E::smooth, "smooth"}, {E::bilinear, "bilinear"}};
};
template <> struct EnumWords<terrain::RadiusLaw> {
  using E = terrain::RadiusLaw;
  static constexpr EnumWord<E> list[] = {
      {E::single, "single"}, {E::uniform, "uniform"}, {E::lognormal, "lognormal"}, {E::sieve, "sieve"}};
};
template <> struct EnumWords<multibody::Integrator> {
  using E = multibody::Integrator;
  static constexpr EnumWord<E> list[] = {{E::kSymplecticEuler, "symplectic_euler"}, {E::kRattle, "rattle"}};
};
template <> struct EnumWords<multibody::Springs> {
  using E = multibody::Springs;
  static constexpr EnumWord<E> list[] = {{E::kExplicit, "explicit"}, {E::kImplicit, "implicit"}};
};
template <> struct EnumWords<multibody::JointType> {
  using E = multibody::JointType;
  static constexpr EnumWord<E> list[] = {{E::kRevolute, "revolute"},       {E::kSpherical, "spherical"},
                                         {E::kUniversal, "universal"},     {E::kPrismatic, "prismatic"},
                                         {E::kCylindrical, "cylindrical"}, {E::kFixed, "fixed"},
                                         {E::kDistance, "distance"}};
};
/// kOnly has no word, since it represents a section without the axis key.
template <> struct EnumWords<multibody::JointAxis> {
  using E = multibody::JointAxis;
  static constexpr EnumWord<E> list[] = {{E::kAngle, "angle"}, {E::kSlide, "slide"}};
};
template <> struct EnumWords<multibody::DriveKind> {
  using E = multibody::DriveKind;
  static constexpr EnumWord<E> list[] = {{E::kSpeed, "speed"}, {E::kPosition, "position"}, {E::kForce, "torque"}};
};

} // namespace grouser::base
