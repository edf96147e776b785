// SPDX-License-Identifier: BSD-3-Clause
// Inputs of a running simulation.
#include "base/error.hpp"
#include "base/table.hpp"
#include "coupling/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::coupling {

namespace {

/// Allowed values, as for the keys of a scene.
struct Range {
  const char* name;
  double most;
  const char* unit;
};
Range rangeOf(InputKind kind) {
  switch (kind) {
  case InputKind::sprocketSpeed:
    return {"sprocket speed", 100, "rad/s"};
  case InputKind::sprocketTorque:
    return {"sprocket torque", 1e7, "N m"};
  case InputKind::throttle:
    return {"throttle", 1, "-"};
  case InputKind::hitchForce:
    return {"hitch force", 1e8, "N"};
  case InputKind::hitchSpeed:
    return {"hitch speed", 100, "m/s"};
  case InputKind::gravity:
    return {"gravity", 1000, "m/s2"};
  case InputKind::bodyLoad:
    return {"load on a body", 1e9, "N, N m"};
  }
  return {};
}

/// Throws InputError for a torque on a point body, which has no inertia.
void requireTurnable(const multibody::Model& model, const Input& input) {
  const multibody::Body& body = model.bodies()[static_cast<std::size_t>(input.target)];
  if (body.point && (input.value[3] != 0 || input.value[4] != 0 || input.value[5] != 0))
    throw base::InputError(fmt::format("torque on body \"{}\" = [{:g}, {:g}, {:g}] N m, but it is a point body, which "
                                       "cannot rotate; set only a force, or replace point by inertia in [[body]]",
                                       body.name, input.value[3], input.value[4], input.value[5]));
}

} // namespace

void require(const Simulation& simulation, const Input& input) {
  if (input.released) return; // a branch may have no hitch or drive of this kind
  const Range range = rangeOf(input.kind);
  const bool ofTrack = input.kind == InputKind::sprocketSpeed || input.kind == InputKind::sprocketTorque ||
                       input.kind == InputKind::throttle;
  for (const double v : input.value)
    if (!(std::fabs(v) <= range.most))
      throw base::InputError(fmt::format("{}{} = {:g} {}, allowed range [{:g}, {:g}] [{}]; nothing was set",
                                         !ofTrack            ? ""
                                         : input.target == 0 ? "left "
                                                             : "right ",
                                         range.name, v, std::isfinite(v) ? "is out of range" : "is not finite",
                                         -range.most, range.most, range.unit));
  if (fluidOf(simulation) && input.kind == InputKind::gravity)
    throw base::InputError("gravity cannot be set in a scene with [fluid]; set run.gravity");
  const multibody::Model* model = nullptr;
  if (simulation.vehicle()) simulation.vehicle()->require(input), model = &simulation.vehicle()->assembly().model;
  if (simulation.mechanism()) simulation.mechanism()->require(input), model = &simulation.mechanism()->model();
  if (model && input.kind == InputKind::bodyLoad) requireTurnable(*model, input);
  if (model) return;
  if (input.kind != InputKind::gravity)
    throw base::InputError(
        fmt::format("{} cannot be set: the scene has neither vehicle nor mechanism", base::wordOf(input.kind)));
}

void Simulation::set(std::vector<Input> inputs) {
  for (Input& input : inputs) {
    input.step = steps_;
    require(*this, input);
  }
  for (const Input& input : inputs) inputs_.set(input);
  const auto isGravity = [](const Input& i) { return i.kind == InputKind::gravity; };
  if (std::none_of(inputs.begin(), inputs.end(), isGravity)) return command();
  // Potential energies use the current gravity: their change here is not work of the simulation.
  const Ledger before = wholeLedger();
  command();
  start_.move(before, wholeLedger());
}

/// Passes the active inputs to vehicle, mechanism, surfaces and ground.
void Simulation::command() {
  const auto g = inputs_.now(InputKind::gravity);
  const base::Vec3d gravity = g ? base::Vec3d{(*g)[0], (*g)[1], (*g)[2]} : setup_.gravity;
  if (vehicle_) vehicle_->command(inputs_, gravity);
  if (mechanism_) mechanism_->command(inputs_, gravity);
  if (gravity == gravity_) return;
  gravity_ = gravity;
  if (surfaces_) surfaces_->setGravity(gravity), surfaces_->place(*laid_.grains, steps_);
  if (ground_) ground_->setGravity(gravity);
  ahead_.reset(); // its graphs contain the former gravity
}

std::int32_t bodyIndex(const Simulation& simulation, const std::string& name) {
  std::vector<std::string> names;
  const multibody::Model* model = simulation.vehicle() ? &simulation.vehicle()->assembly().model : nullptr;
  if (simulation.mechanism()) model = &simulation.mechanism()->model();
  if (model)
    for (const multibody::Body& body : model->bodies()) {
      if (body.name == name) return static_cast<std::int32_t>(names.size());
      names.push_back(body.name);
    }
  throw base::InputError(
      names.empty()
          ? fmt::format("there is no body \"{}\": the scene has neither vehicle nor mechanism", name)
          : fmt::format("there is no body \"{}\"; the nearest is \"{}\"", name, base::nearestWord(name, names)));
}

} // namespace grouser::coupling
