// SPDX-License-Identifier: BSD-3-Clause
#include "base/for_each.cuh"
#include "base/parcel_words.cuh"

namespace grouser::base {

void carry(const Exec& exec, std::span<const Parcel> parcels) {
  const ParcelWords words(parcels);
  if (exec.onCpu()) return words.onHost();
  forEach(exec, "carry", words.count(), words);
}

} // namespace grouser::base
