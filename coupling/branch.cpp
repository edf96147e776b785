// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/branch.hpp"

#include "coupling/inputs.hpp"
#include "coupling/ledger.hpp"
#include "coupling/towing.hpp"

namespace grouser::coupling {

namespace {

/// Keeps the work of the former hitch in the ledger.
void keepWork(SimulationState& state, double work) {
  Ledger start;
  start.setCounted(state.ledgerAtStart);
  start.driveWork -= work;
  state.ledgerAtStart = start.counted();
}

/// Releases the control inputs of a drive or hitch that the branch replaces.
void releaseInputs(SimulationState& state, bool driver, bool hitch) {
  Inputs inputs;
  inputs.restore(state.inputs);
  const std::vector<Input> acting = inputs.acting();
  for (Input input : acting) {
    const bool ofHitch = input.kind == InputKind::hitchForce || input.kind == InputKind::hitchSpeed;
    const bool ofDrive = input.kind == InputKind::sprocketSpeed || input.kind == InputKind::sprocketTorque ||
                         input.kind == InputKind::throttle;
    if (!(ofDrive && driver) && !(ofHitch && hitch)) continue;
    input.step = state.steps, input.released = true, input.value = {};
    inputs.set(input);
  }
  state.inputs = inputs.save();
}

} // namespace

void branch(SimulationState& state, const VehicleSetup& setup, bool otherDriver, bool otherHitch, double time) {
  VehicleState& vehicle = *state.vehicle;
  releaseInputs(state, otherDriver, otherHitch);
  const vehicle::Handover asked = vehicle::Handover::of(vehicle.asked);
  vehicle::Driver driver(setup.driver);
  if (otherDriver) {
    driver.takeOver(vehicle.driver, asked);
    vehicle.driver = driver.save();
  } else {
    driver.restore(vehicle.driver);
  }
  if (!otherHitch) return;
  if (!vehicle.hitchSums.empty()) keepWork(state, Towing::workOf(vehicle.hitchSums));
  vehicle.hitch.clear(), vehicle.hitchSums.clear();
  if (!setup.hitch) return;
  vehicle::Hitch hitch(*setup.hitch);
  if (asked.driven) hitch.holdFrom(time - *driver.driveStart());
  vehicle.hitch = hitch.save();
  vehicle.hitchSums = Towing(*setup.hitch).saveSums();
}

} // namespace grouser::coupling
