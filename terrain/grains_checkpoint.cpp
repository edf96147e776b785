// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grains.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace grouser::terrain {

using base::Position;
using base::Vec3f;
using base::Vec3i;

namespace {

Vec3f vectorAt(const std::vector<float>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// History of contacts as it lies on the device: spring and rolling angle of each, one after the other.
std::vector<float> historyOf(const std::vector<Vec3f>& shear, const std::vector<Vec3f>& rolling) {
  std::vector<float> history;
  for (std::size_t c = 0; c < shear.size(); ++c) {
    history.insert(history.end(), {shear[c].x, shear[c].y, shear[c].z});
    if (!rolling.empty()) history.insert(history.end(), {rolling[c].x, rolling[c].y, rolling[c].z});
  }
  return history;
}

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
      if (!contactRolling.empty()) put(contactRolling[c]);
    }
    if (!radius.empty()) put(radius[g]);
    if (!material.empty()) put(material[g]);
    if (wallBits.empty()) continue;
    put(wallBits[g]);
    const auto walls = static_cast<std::size_t>(layout.boundaries);
    for (std::size_t b = 0; b < walls && layout.friction; ++b) {
      if (!(wallBits[g] >> b & 1)) continue;
      put(wallShear[g * walls + b]);
      if (layout.rolling) put(wallRolling[g * walls + b]);
    }
  }
  return words;
}

GrainState Grains::state() const { return inBlocks(ownRows()); }

GrainSnapshot Grains::snapshot() const {
  const GrainState s = inBlocks(ownPlaces());
  GrainSnapshot out;
  out.first = blockStart(comm_, static_cast<std::int64_t>(count_), comm_.rank()), out.total = count_;
  for (const Position& p : s.position) out.position.push_back(scale_.toMetres(p));
  out.velocity = s.velocity, out.spin = s.spin, out.radius = s.radius;
  return out;
}

/// Each rank's rows, given to those whose blocks of ids they are in.
GrainState Grains::inBlocks(GrainState own) const {
  if (comm_.alone()) return own;
  std::vector<int> block;
  for (const std::uint32_t id : own.id) block.push_back(blockOf(comm_, own.total, id));
  return redistribute(comm_, own, block);
}

GrainLayout Grains::layout() const {
  return {model_.ledger,     boundaryCount_,      historyWidth_ > 0,
          historyWidth_ > 3, manyRadii() ? 1 : 0, static_cast<std::int64_t>(model_.materials.count()),
          period_.any()};
}

/// Slots of the grains that this rank integrates, in the order of their ids.
std::vector<std::uint32_t> Grains::ownSlots(const std::vector<std::uint32_t>& id) const {
  const auto ghost = ghosts() ? base::toHost(exec_, ghosts(), slots_) : std::vector<std::uint32_t>(slots_);
  std::vector<std::uint32_t> slots;
  for (std::size_t i = 0; i < slots_; ++i)
    if (!ghost[i]) slots.push_back(static_cast<std::uint32_t>(i));
  std::sort(slots.begin(), slots.end(), [&](std::uint32_t a, std::uint32_t b) { return id[a] < id[b]; });
  return slots;
}

/// What can be seen of these grains, without contacts: little to bring from the device.
GrainState Grains::ownPlaces() const {
  const auto position = position_[0].toHost();
  const auto velocity = velocity_[0].toHost(), spin = spin_[0].toHost();
  const auto id = id_.toHost();
  GrainState s;
  s.layout.radii = layout().radii, s.total = static_cast<std::int64_t>(count_);
  for (const std::uint32_t i : ownSlots(id)) {
    s.id.push_back(id[i]);
    s.position.push_back(position[i]);
    s.velocity.push_back(velocity[i].xyz());
    s.spin.push_back(spin[i].xyz());
    if (s.layout.radii) s.radius.push_back(velocity[i].w);
  }
  s.remainders.resize(s.rows()), s.travelled.resize(s.rows()), s.contacts.resize(s.rows());
  return s;
}

/// All of these grains.
GrainState Grains::ownRows() const {
  const auto position = position_[0].toHost();
  const auto velocity = velocity_[0].toHost(), spin = spin_[0].toHost();
  const auto remainders = remainders_.toHost();
  const auto id = id_.toHost(), wallBits = boundaryContactMask_.toHost();
  const auto boundaryHistory = boundaryHistory_.toHost();
  const auto dissipated = dissipated_.toHost();
  const auto crossings = crossings_.toHost();
  const auto reference = reference_.toHost();
  const bool listed = rebuilds_ > 0;
  const auto lists = listed ? neighbours_.toHost() : contact::NeighbourList::HostCopy{};

  GrainState s;
  s.layout = layout();
  s.total = static_cast<std::int64_t>(count_), s.skin = model_.skin, s.rebuilds = rebuilds_;
  const auto walls = static_cast<std::size_t>(boundaryCount_), width = static_cast<std::size_t>(historyWidth_);
  for (const std::uint32_t i : ownSlots(id)) {
    s.id.push_back(id[i]);
    s.position.push_back(position[i]);
    s.velocity.push_back(velocity[i].xyz());
    s.spin.push_back(spin[i].xyz());
    s.remainders.push_back(remainders[i]);
    if (s.layout.radii) s.radius.push_back(velocity[i].w);
    if (s.layout.materials) s.material.push_back(static_cast<std::uint32_t>(spin[i].w));
    if (model_.ledger) s.dissipated.push_back(dissipated[i]);
    if (s.layout.periodic) s.crossings.push_back(crossings[i]);
    s.travelled.push_back(listed ? base::Vec3<std::uint32_t>{position[i].x - reference[i].x,
                                                             position[i].y - reference[i].y,
                                                             position[i].z - reference[i].z}
                                 : base::Vec3<std::uint32_t>{});
    s.contacts.push_back(0);
    for (std::uint32_t k = 0; listed && k < lists.count[i]; ++k) {
      if (!lists.touched(i, k)) continue;
      const auto at = static_cast<std::size_t>(lists.at(i, k));
      s.neighbour.push_back(id[lists.slot[at]]);
      if (width > 0) s.contactShear.push_back(vectorAt(lists.history, at * width));
      if (width > 3) s.contactRolling.push_back(vectorAt(lists.history, at * width + 3));
      ++s.contacts.back();
    }
    if (walls > 0) s.wallBits.push_back(wallBits[i]);
    // Springs of walls out of touch are never read again.
    for (std::size_t b = 0; b < walls && width > 0; ++b) {
      const bool held = wallBits[i] >> b & 1;
      const std::size_t at = (i * walls + b) * width;
      s.wallShear.push_back(held ? vectorAt(boundaryHistory, at) : Vec3f{});
      if (width > 3) s.wallRolling.push_back(held ? vectorAt(boundaryHistory, at + 3) : Vec3f{});
    }
  }
  return s;
}

std::vector<std::uint32_t> Grains::stateWords() const { return state().words(); }

void Grains::restore(const GrainState& saved, bool grows) {
  if (saved.total < static_cast<std::int64_t>(count_) || (saved.total > static_cast<std::int64_t>(count_) && !grows) ||
      saved.layout != layout())
    throw base::InputError(fmt::format("the checkpoint holds {} grains of another kind of scene, this scene has {}; "
                                       "resume with the scene that was run",
                                       saved.total, count_));
  // The list is built where the saved run built it, so that it stays valid for as long. With another skin that would
  // say nothing: then it is built here and now.
  const bool asThen = saved.rebuilds > 0 && saved.skin == model_.skin;
  const auto placed = [&](const GrainState& s, std::size_t k) {
    return asThen ? before(s.position[k], s.travelled[k]) : s.position[k];
  };
  std::vector<int> owner;
  if (subdomain_)
    for (std::size_t k = 0; k < saved.rows(); ++k)
      owner.push_back(subdomain_->partition().view().ownerOf(period_.wrapped(base::toUnits(placed(saved, k)))));
  const GrainState s = redistribute(comm_, saved, owner);

  finishGhostUpdate(); // those on their way are of the grains that go
  slots_ = s.rows(), count_ = static_cast<std::size_t>(saved.total);
  std::vector<Position> position(slots_);
  std::vector<Vec4f> velocity(slots_), spin(slots_);
  for (std::size_t k = 0; k < slots_; ++k) {
    position[k] = placed(s, k);
    const Vec3f &v = s.velocity[k], &w = s.spin[k];
    velocity[k] = {v.x, v.y, v.z, s.radius.empty() ? 0.0f : s.radius[k]};
    spin[k] = {w.x, w.y, w.z, s.material.empty() ? 0.0f : static_cast<float>(s.material[k])};
  }
  position_[0].assign(position), velocity_[0].assign(velocity), spin_[0].assign(spin);
  position_[1].resize(slots_), velocity_[1].resize(slots_), spin_[1].resize(slots_);
  remainders_.assign(s.remainders), id_.assign(s.id), dissipated_.assign(s.dissipated);
  crossings_.assign(s.crossings);
  boundaryContactMask_.assign(s.wallBits), boundaryHistory_.assign(historyOf(s.wallShear, s.wallRolling));
  if (subdomain_) subdomain_->forgetRoles();
  neighbours_.forget();
  invalidateNeighbours();
  refreshNeighbours();

  const std::vector<std::uint32_t> id = id_.toHost();
  const auto units = [](std::uint32_t word) { return static_cast<std::int32_t>(word); };
  bool beyond = false;
  position = position_[0].toHost();
  for (std::size_t i = 0; i < slots_; ++i) {
    const auto row = std::lower_bound(s.id.begin(), s.id.end(), id[i]);
    if (row == s.id.end() || *row != id[i]) continue; // a ghost
    const auto k = static_cast<std::size_t>(row - s.id.begin());
    const auto& t = s.travelled[k];
    position[i] = s.position[k];
    beyond =
        beyond || base::squaredNorm(Vec3i{units(t.x), units(t.y), units(t.z)}) > (skinUnits_ / 2) * (skinUnits_ / 2);
  }
  position_[0].assign(position);
  if (subdomain_) updateGhosts();
  if (asThen && comm_.maximumOf(beyond ? 1 : 0) > 0) invalidateNeighbours();
  restoreContacts(s, id);
  rebuilds_ = s.rebuilds;
  if (rebuilds_ == 0) invalidateNeighbours(); // the first list is still to come
}

void Grains::restoreContacts(const GrainState& s, const std::vector<std::uint32_t>& id) {
  std::vector<std::size_t> first(s.rows() + 1);
  for (std::size_t g = 0; g < s.rows(); ++g) first[g + 1] = first[g] + s.contacts[g];
  auto lists = neighbours_.toHost();
  const std::vector<float> history = historyOf(s.contactShear, s.contactRolling);
  const auto width = static_cast<std::size_t>(historyWidth_), words = static_cast<std::size_t>(lists.maskWords);
  const auto ghost = ghosts() ? base::toHost(exec_, ghosts(), slots_) : std::vector<std::uint32_t>(slots_);
  for (std::size_t i = 0; i < slots_; ++i) {
    std::fill_n(lists.touching.begin() + static_cast<std::ptrdiff_t>(i * words), words, 0);
    if (ghost[i]) continue;
    // Both ascend in the neighbours' ids.
    const auto row = static_cast<std::size_t>(std::lower_bound(s.id.begin(), s.id.end(), id[i]) - s.id.begin());
    std::size_t c = first[row];
    const std::size_t end = first[row + 1];
    for (std::uint32_t k = 0; k < lists.count[i] && c < end; ++k) {
      const auto at = static_cast<std::size_t>(lists.at(i, k));
      if (id[lists.slot[at]] != s.neighbour[c]) continue;
      lists.touching[i * words + k / 64] |= std::uint64_t{1} << (k & 63u);
      std::copy_n(history.begin() + static_cast<std::ptrdiff_t>(c * width), width,
                  lists.history.begin() + static_cast<std::ptrdiff_t>(at * width));
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
