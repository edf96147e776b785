// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "contact/part_surface.hpp"
#include "contact/patch_law.hpp"
#include "contact/saved_contacts.hpp"

#include <cstdint>
#include <vector>

namespace grouser::contact {

/// Range of samples of one pair: the unit of work when samples are listed.
struct SampleChunk {
  std::uint32_t pair, first, last; ///< samples [first, last)
};

/// Lists and sums of contacts of extended surfaces, independent of the type of the other surface.
struct PatchBuffers {
  /// `sampledParts`: for each pair, the part with the samples to be tested against the other surface.
  PatchBuffers(const base::Exec& exec, const std::vector<const base::SphereSet*>& sets,
               const std::vector<int>& setOfPart, const std::vector<int>& sampledParts);

  base::Exec exec;
  std::size_t pairs;
  base::Array<SurfaceSample> sample;
  base::Array<int> setOfPart;
  base::Array<SampleChunk> chunks;
  base::Array<std::uint32_t> near, count, first;
  base::Array<std::uint64_t> entry;
  base::Array<float> gap;
  std::size_t entries{0};
  base::Array<PatchSums> sums;
  base::Array<PatchState> states;

  /// Energies [J] of all patches and number of patches in contact, at the last step.
  struct Ledger {
    double elastic{}, dissipated{};
    std::int64_t patches{};
    void operator+=(const Ledger& more) {
      elastic += more.elastic, dissipated += more.dissipated, patches += more.patches;
    }
  };
  Ledger ledger(const PatchQuanta& quanta) const;
  /// State for hashes and checkpoints. restore() throws InputError if the state belongs to other pairs; list the
  /// samples again afterwards.
  SavedPatches save() const;
  void restore(const SavedPatches& saved);
};

} // namespace grouser::contact
