// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "runs/setup/ground_setup.hpp"
#include "terrain/bed_structure.hpp"
#include "terrain/bed_surface.hpp"
#include "terrain/grains.hpp"
#include "terrain/height_field.hpp"

#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace grouser::simulation {

/// The terrain as the simulation needs it: rigid ground, or grains on a rigid floor, or grains alone. A const Ground
/// keeps what it has, but its grains can be stepped.
struct Ground {
  std::optional<terrain::HeightField> surface; ///< as the height-map says; empty without [terrain]
  std::optional<terrain::HeightField> rigid;   ///< the ground itself, or the floor below a bed; empty without [terrain]
  std::unique_ptr<terrain::Grains> grains;     ///< null without grains
  std::optional<terrain::Rectangle> walls;     ///< around a bed; empty without one
  /// Of a settled bed, before the vehicle touched it; null without a bed, and before keepSurface().
  std::shared_ptr<const terrain::BedSurface> undisturbed;
  std::optional<terrain::BedStructure> structure; ///< of that bed; empty where it was not settled
};

/// Who watches a bed settle.
struct SettleProgress {
  template <class Tell>
  requires std::invocable<const Tell&, double, double> SettleProgress(Tell f) : tell(std::move(f)) {}
  void operator()(double time, double agitation) const { tell(time, agitation); }

  /// Called now and then: simulated time [s], kinetic energy a grain over m g radius [-].
  std::function<void(double time, double agitation)> tell;
  /// Where it ends in a SimulationError: the bed as it is then, and the message of the error, which is thrown when this
  /// returns. May be empty; must not throw.
  std::function<void(const terrain::Grains& bed, const std::string& message)> failed{};
};

/// How settling ended.
struct SettleReport {
  double time{};      ///< simulated [s]
  double agitation{}; ///< mean kinetic energy a grain over m g radius [-]
  std::int64_t steps{};
  double friction{}; ///< [-] with which the bed was prepared; 0: with its own
  /// Of the bed then: the highest grain's top, and the mean over its area of the highest top within a diameter [m].
  double highest{}, meanHeight{};
};

/// Names of the surfaces that are no meshes, in their order.
std::vector<std::string> namesOfShapes(const setup::GroundSetup& setup);

/// Lays the grains and places the walls. Nothing moves yet, but a tile that is to be copied settles. Where more is put
/// on a bed once it has settled (placed_on_bed.hpp), the ground is the bed alone.
/// On several ranks each takes the grains of its subdomain.
Ground buildGround(const setup::GroundSetup& setup, const base::Exec& exec, const base::Comm& comm = {});

/// Prepares the bed, where the scene asks for a porosity, and lets it come to rest under gravity: see
/// bed_preparation.hpp. Throws SimulationError when the scene's time limit passes first, or when the grains meet a
/// fault: the message says that it was while the bed settled.
SettleReport settle(const setup::BedSetup& bed, terrain::Grains& grains, const SettleProgress& progress);

/// Of a ground with a bed: takes its surface as it lies now for the undisturbed one, or `heights` of one taken earlier,
/// with the radius of its largest grains [m].
void keepSurface(Ground& ground, const base::Exec& exec);
void keepSurface(Ground& ground, const std::vector<double>& heights, double radius);

/// Measures the bed, whose surface has been kept.
terrain::BedStructure structureOf(const Ground& ground);
/// Throws SimulationError where the bed has crystallised.
void checkStructure(const setup::BedSetup& bed, const terrain::BedStructure& structure);

/// Height of the undisturbed bed, or of the rigid ground; null where there is neither.
std::function<double(double x, double y)> surfaceHeight(const Ground& ground);

} // namespace grouser::simulation
