// SPDX-License-Identifier: BSD-3-Clause
// Saves and restores the contacts of parts.
#include "base/algorithms.hpp"
#include "base/bits.hpp"
#include "base/error.hpp"
#include "contact/grain_part_contacts.hpp"
#include "contact/patch_contacts.hpp"
#include "contact/saved_contacts.hpp"

#include <algorithm>
#include <cstring>

namespace grouser::contact {

namespace {

constexpr std::size_t kWords = 8; // words per patch between a grain and a part
static_assert(sizeof(std::uint64_t) + sizeof(PatchMemory) == kWords * sizeof(std::uint32_t));

[[noreturn]] void refuse() {
  throw base::InputError("the checkpoint belongs to another vehicle; resume with the scene that was run");
}

} // namespace

std::vector<std::uint32_t> SavedPatches::words() const {
  std::vector<std::uint32_t> words;
  for (const PatchState& s : states) {
    std::uint32_t raw[8];
    std::memcpy(raw, &s.shear, 24);
    std::memcpy(raw + 6, &s.stiffness, 8);
    words.insert(words.end(), raw, raw + 8);
  }
  return words;
}

std::vector<std::uint32_t> SavedGrainPatches::words() const {
  std::vector<std::uint32_t> words = memories;
  static_assert(sizeof(float) == sizeof(std::uint32_t));
  for (const std::vector<float>* numbers : {&angles, &dents})
    for (const float number : *numbers) words.push_back(base::bitsAs<std::uint32_t>(number));
  return words;
}

SavedPatches PatchBuffers::save() const { return {states.toHost(), sums.toHost()}; }

void PatchBuffers::restore(const SavedPatches& saved) {
  if (saved.states.size() != states.size() || saved.sums.size() != sums.size()) refuse();
  states.assign(saved.states);
  sums.assign(saved.sums);
}

std::vector<GrainPartContacts::Touch> GrainPartContacts::touching() const {
  std::vector<std::uint64_t> listed = key_.toHost();
  listed.resize(pairs_);
  const std::vector<PatchMemory> memory = memory_.toHost();
  std::vector<std::uint64_t> keys;
  for (std::size_t k = 0; k < listed.size(); ++k)
    for (std::size_t q = 0; q < kPatches; ++q) {
      if (norm2(memory[k * kPatches + q].normal) == 0) continue;
      keys.push_back(listed[k]);
      break;
    }
  if (held_ != Held::everywhere && !comm_.alone()) {
    const auto all = comm_.gatherAll(keys);
    keys.clear();
    for (const std::vector<std::uint64_t>& of : all) keys.insert(keys.end(), of.begin(), of.end());
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Touch> touches;
  for (const std::uint64_t key : keys)
    touches.push_back({static_cast<std::uint32_t>(key >> 16), static_cast<int>(key & 0xffffu)});
  return touches;
}

SavedGrainPatches GrainPartContacts::save() const {
  std::vector<std::uint64_t> key = key_.toHost();
  key.resize(pairs_);
  std::vector<PatchMemory> memory = memory_.toHost();
  memory.resize(pairs_ * kPatches);
  std::vector<base::Vec3f> angle = angle_.toHost();
  if (rolling_) angle.resize(pairs_ * kPatches);
  std::vector<float> dent = dent_.toHost();
  if (crushes_) dent.resize(pairs_ * kPatches);
  if (held_ != Held::everywhere && !comm_.alone()) {
    const auto keys = comm_.gatherAll(key);
    const auto memories = comm_.gatherAll(memory);
    const auto angles = comm_.gatherAll(angle);
    const auto dents = comm_.gatherAll(dent);
    key.clear(), memory.clear(), angle.clear(), dent.clear();
    for (std::size_t r = 0; r < keys.size(); ++r) {
      key.insert(key.end(), keys[r].begin(), keys[r].end());
      memory.insert(memory.end(), memories[r].begin(), memories[r].end());
      angle.insert(angle.end(), angles[r].begin(), angles[r].end());
      dent.insert(dent.end(), dents[r].begin(), dents[r].end());
    }
  }
  std::vector<std::uint32_t> order(key.size()), words;
  std::vector<float> angles, dents;
  for (std::size_t e = 0; e < key.size(); ++e) order[e] = static_cast<std::uint32_t>(e);
  base::sortByKey(base::cpuExec(1), key.data(), order.data(), key.size());
  for (std::size_t k = 0; k < key.size(); ++k)
    for (int q = 0; q < kPatches; ++q) {
      const std::size_t at = static_cast<std::size_t>(order[k]) * kPatches + static_cast<std::size_t>(q);
      const PatchMemory& m = memory[at];
      if (norm2(m.normal) == 0) continue;
      std::uint32_t raw[kWords];
      std::memcpy(raw, &key[k], 8);
      std::memcpy(raw + 2, &m, sizeof m);
      words.insert(words.end(), raw, raw + kWords);
      if (rolling_) angles.insert(angles.end(), {angle[at].x, angle[at].y, angle[at].z});
      if (crushes_) dents.push_back(dent[at]);
    }
  return {words, angles, dents, allSums(), allDeepest()};
}

void GrainPartContacts::restore(const SavedGrainPatches& saved) {
  if (saved.sums.size() != sums_.size() || saved.deepest.size() != deepest_.size() ||
      saved.memories.size() % kWords != 0 ||
      saved.angles.size() != (rolling_ ? saved.memories.size() / kWords * 3 : 0) ||
      saved.dents.size() != (crushes_ ? saved.memories.size() / kWords : 0))
    refuse();
  std::vector<std::uint64_t> keys;
  std::vector<PatchMemory> memories;
  std::vector<base::Vec3f> angles;
  std::vector<float> dents;
  std::size_t place = 0;
  for (std::size_t w = 0; w < saved.memories.size(); w += kWords) {
    std::uint64_t key;
    std::memcpy(&key, &saved.memories[w], sizeof key);
    if (keys.empty() || keys.back() != key) {
      keys.push_back(key);
      memories.resize(keys.size() * kPatches);
      if (rolling_) angles.resize(memories.size());
      if (crushes_) dents.resize(memories.size());
      place = 0;
    }
    if ((key & 0xFFFFu) >= partCount_ || place == kPatches) refuse();
    float f[6];
    std::memcpy(f, &saved.memories[w + 2], sizeof f);
    const std::size_t at = (keys.size() - 1) * kPatches + place++;
    memories[at] = {{f[0], f[1], f[2]}, {f[3], f[4], f[5]}};
    if (crushes_) dents[at] = saved.dents[w / kWords];
    if (!rolling_) continue;
    const float* a = saved.angles.data() + w / kWords * 3;
    angles[at] = {a[0], a[1], a[2]};
  }
  // Build a list of the touching pairs only; the next refresh copies the history from it, as from any previous list.
  pairs_ = keys.size();
  held_ = Held::everywhere;
  key_.assign(keys);
  memory_.assign(memories);
  angle_.assign(angles);
  dent_.assign(dents);
  deepest_.assign(saved.deepest);
  sums_.assign(comm_.first() ? saved.sums : std::vector<std::int64_t>(saved.sums.size()));
}

} // namespace grouser::contact
