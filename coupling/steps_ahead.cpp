// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/steps_ahead.hpp"

#include "base/error.hpp"

namespace grouser::coupling {

StepsAhead::StepsAhead(const base::Exec& exec, GranularGround& ground, VehicleRig& vehicle)
    : grains_(ground.grains()), onParts_(*ground.onParts()), vehicle_(vehicle), gate_(exec), graph_(exec) {}

StepsAhead::~StepsAhead() {
  try {
    callOff();
  } catch (const base::DeviceError&) { // the device failure has been or will be reported
  }
}

void StepsAhead::launch() {
  PartContacts& contacts = vehicle_.stepContacts();
  if (listings_ != contacts.listings()) graph_.forget();
  listings_ = contacts.listings();
  graph_.from(grains_.view().position).run([&] { contacts.launchAhead(gate_, grains_, onParts_); });
  grains_.exchangeBuffers();
  ++launched_;
}

void StepsAhead::begin() {
  if (launched_ == 0) launch();
  vehicle_.stepContacts().noteTravel();
  gate_.open();
  --launched_;
  begun_ = true;
}

void StepsAhead::computeOnHost() { vehicle_.stepContacts().computeOnHost(); }

void StepsAhead::launchNext() {
  if (vehicle_.contacts().listsAreValid(true)) launch();
}

void StepsAhead::end() {
  gate_.await(base::Gate::kSecond);
  begun_ = false;
  const int further = launched_;
  launched_ = 0; // cancelled if it throws
  if (grains_.end(further)) launched_ = further;
}

void StepsAhead::callOff() {
  if (launched_ == 0 && !begun_) return;
  gate_.callOff();
  begun_ = false;
  if (launched_ % 2 != 0) grains_.exchangeBuffers(); // reverts the swap of buffers
  launched_ = 0;
}

} // namespace grouser::coupling
