// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grains.hpp"

#include "base/error.hpp"

#include <cstring>
#include <fmt/format.h>

namespace grouser::terrain {

using base::Position;
using base::Vec3f;
using base::Vec3i;

namespace {

Vec4f withZero(const Vec3f& v) { return {v.x, v.y, v.z, 0}; }

/// Where the grain was `travelled` ago.
Position before(const Position& now, const base::Vec3<std::uint32_t>& travelled) {
  return base::fromUnits(base::toUnits(now) - base::Vec3l{static_cast<std::int32_t>(travelled.x),
                                                          static_cast<std::int32_t>(travelled.y),
                                                          static_cast<std::int32_t>(travelled.z)});
}

} // namespace

std::vector<std::uint32_t> GrainState::words() const {
  std::vector<std::uint32_t> words;
  const std::size_t count = position.size();
  words.reserve(count * 24);
  const auto put = [&words](const auto& value) {
    static_assert(sizeof value % 4 == 0);
    std::uint32_t raw[sizeof value / 4];
    std::memcpy(raw, &value, sizeof value);
    words.insert(words.end(), raw, raw + sizeof value / 4);
  };
  std::size_t c = 0;
  for (std::size_t g = 0; g < count; ++g) {
    put(position[g]), put(velocity[g]), put(spin[g]), put(remainders[g]);
    for (const std::size_t end = c + contacts[g]; c < end; ++c) {
      put(neighbour[c]);
      if (!contactShear.empty()) put(contactShear[c]);
    }
    if (wallBits.empty()) continue;
    put(wallBits[g]);
    for (std::size_t b = 0; b * count < wallShear.size(); ++b)
      if (wallBits[g] >> b & 1) put(wallShear[b * count + g]);
  }
  return words;
}

GrainState Grains::state() const {
  const auto position = position_[0].toHost();
  const auto velocity = velocity_[0].toHost(), spin = spin_[0].toHost();
  const auto remainders = remainders_.toHost();
  const auto id = id_.toHost(), wallBits = wallTouching_.toHost();
  const auto wallShear = wallShear_.toHost();
  const auto dissipated = dissipated_.toHost();
  const auto reference = reference_.toHost();
  const bool listed = rebuilds_ > 0;
  const auto lists = listed ? neighbours_.toHost() : contact::NeighbourList::HostCopy{};
  std::vector<std::uint32_t> slotOf(count_);
  for (std::size_t i = 0; i < count_; ++i) slotOf[id[i]] = static_cast<std::uint32_t>(i);

  GrainState s;
  s.skin = model_.skin, s.rebuilds = rebuilds_;
  s.wallShear.resize(wallShear.size());
  for (std::size_t g = 0; g < count_; ++g) {
    const std::size_t i = slotOf[g];
    s.position.push_back(position[i]);
    s.velocity.push_back(velocity[i].xyz());
    s.spin.push_back(spin[i].xyz());
    s.remainders.push_back(remainders[i]);
    if (!dissipated.empty()) s.dissipated.push_back(dissipated[i]);
    s.travelled.push_back(listed ? base::Vec3<std::uint32_t>{position[i].x - reference[i].x,
                                                             position[i].y - reference[i].y,
                                                             position[i].z - reference[i].z}
                                 : base::Vec3<std::uint32_t>{});
    s.contacts.push_back(0);
    for (std::size_t k = 0; listed && k < lists.count[i]; ++k) {
      if (!(lists.touching[i] >> k & 1)) continue;
      const auto at = static_cast<std::size_t>(lists.at(i, static_cast<std::uint32_t>(k)));
      s.neighbour.push_back(id[lists.slot[at]]);
      if (!lists.shear.empty()) s.contactShear.push_back(lists.shear[at]);
      ++s.contacts.back();
    }
    if (!wallBits.empty()) s.wallBits.push_back(wallBits[i]);
    // Springs of walls out of touch are never read again.
    for (std::size_t b = 0; b * count_ < wallShear.size(); ++b)
      if (wallBits[i] >> b & 1) s.wallShear[b * count_ + g] = wallShear[b * count_ + i];
  }
  return s;
}

std::vector<std::uint32_t> Grains::stateWords() const { return state().words(); }

void Grains::restore(const GrainState& s) {
  if (s.position.size() != count_ || s.dissipated.size() != dissipated_.size() ||
      s.wallBits.size() != wallTouching_.size() || s.wallShear.size() != wallShear_.size() ||
      s.contactShear.size() != (frictional_ ? s.neighbour.size() : 0))
    throw base::InputError(fmt::format("the checkpoint holds {} grains of another kind of scene, this scene has {}; "
                                       "resume with the scene that was run",
                                       s.position.size(), count_));
  // The list is built where the saved run built it, so that it stays valid for as long. With another skin that would
  // say nothing: then it is built here and now.
  const bool asThen = s.rebuilds > 0 && s.skin == model_.skin;
  std::vector<Position> position(count_);
  std::vector<Vec4f> velocity(count_), spin(count_);
  std::vector<std::uint32_t> id(count_);
  for (std::size_t g = 0; g < count_; ++g) {
    position[g] = asThen ? before(s.position[g], s.travelled[g]) : s.position[g];
    velocity[g] = withZero(s.velocity[g]), spin[g] = withZero(s.spin[g]);
    id[g] = static_cast<std::uint32_t>(g);
  }
  position_[0].assign(position), velocity_[0].assign(velocity), spin_[0].assign(spin);
  remainders_.assign(s.remainders), id_.assign(id), dissipated_.assign(s.dissipated);
  wallTouching_.assign(s.wallBits), wallShear_.assign(s.wallShear);
  invalidateNeighbours();
  refreshNeighbours();

  id = id_.toHost();
  const auto units = [](std::uint32_t word) { return static_cast<std::int32_t>(word); };
  for (std::size_t i = 0; i < count_; ++i) {
    const auto& t = s.travelled[id[i]];
    position[i] = s.position[id[i]];
    if (asThen && base::squaredNorm(Vec3i{units(t.x), units(t.y), units(t.z)}) > (skinUnits_ / 2) * (skinUnits_ / 2))
      invalidateNeighbours();
  }
  position_[0].assign(position);
  restoreContacts(s, id);
  rebuilds_ = s.rebuilds;
  if (rebuilds_ == 0) invalidateNeighbours(); // the first list is still to come
}

void Grains::restoreContacts(const GrainState& s, const std::vector<std::uint32_t>& id) {
  std::vector<std::size_t> first(count_ + 1);
  for (std::size_t g = 0; g < count_; ++g) first[g + 1] = first[g] + s.contacts[g];
  auto lists = neighbours_.toHost();
  for (std::size_t i = 0; i < count_; ++i) {
    lists.touching[i] = 0;
    // Both ascend in the neighbours' ids.
    std::size_t c = first[id[i]];
    const std::size_t end = first[id[i] + 1];
    for (std::uint32_t k = 0; k < lists.count[i] && c < end; ++k) {
      const auto at = static_cast<std::size_t>(lists.at(i, k));
      if (id[lists.slot[at]] != s.neighbour[c]) continue;
      lists.touching[i] |= std::uint64_t{1} << k;
      if (!lists.shear.empty()) lists.shear[at] = s.contactShear[c];
      ++c;
    }
    if (c < end)
      throw base::InputError(fmt::format("run.skin = {:g} is too small to take over the contacts of the checkpoint, "
                                         "made with {:g}; raise it",
                                         model_.skin, s.skin));
  }
  neighbours_.setHistory(lists);
}

} // namespace grouser::terrain
