// SPDX-License-Identifier: BSD-3-Clause
#include "scm/node_contact.hpp"

namespace grouser::scm {

double press(NodeContact& contact, const NodeContact* former, const LoadedNodes& loaded, SoilEnergy& energy) {
  const LoadedNode& t = loaded[contact.loaded];
  const Compaction& state = t.state();
  const double sinkage = contact.depth - t.offset;
  const double pressure = sinkage > 0 ? state.pressureAt(sinkage) : 0;
  contact.offset = t.offset, contact.onLoose = t.onLoose, contact.elastic = state.elastic(pressure);
  energy.elastic += contact.area * contact.elastic;
  if (former && former->onLoose != t.onLoose) release(*former, energy), former = nullptr; // loaded layer has changed
  double before = 0;                                                                      // area in the last step
  if (former) {
    before = former->area;
    double elastic = former->elastic;
    if (former->offset != t.offset) { // the soil has sunk away from the body
      elastic = t.before.elastic(t.before.pressureAt(former->depth - t.offset));
      energy.slipSinkage += before * (former->elastic - elastic);
    }
    if (t.yields && before > 0) {
      Compaction path = t.before;
      const Compression c =
          compress(path, loaded.soil(), loaded.curve(), t.modulus, former->depth - t.offset, std::max(0.0, sinkage));
      energy.compaction += before * (c.work - (contact.elastic - elastic));
    }
  }
  energy.edges -= (contact.area - before) * contact.elastic;
  return pressure;
}

} // namespace grouser::scm
