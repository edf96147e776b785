// SPDX-License-Identifier: BSD-3-Clause
// Rows of the grains' state between ranks: from those that own the grains to those that write them, and back.
#include "terrain/grain_state.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace grouser::terrain {

namespace {

class RowPacker {
public:
  explicit RowPacker(std::vector<std::uint32_t>& words) : words_(words) {}
  template <class T> void operator()(const T& value) {
    static_assert(sizeof value % 4 == 0);
    std::uint32_t raw[sizeof value / 4];
    std::memcpy(raw, &value, sizeof value);
    words_.insert(words_.end(), raw, raw + sizeof value / 4);
  }

private:
  std::vector<std::uint32_t>& words_;
};

class RowReader {
public:
  explicit RowReader(const std::vector<std::uint32_t>& words) : words_(words) {}
  bool more() const { return at_ < words_.size(); }
  template <class T> T take() {
    T value;
    std::memcpy(static_cast<void*>(&value), words_.data() + at_, sizeof value);
    at_ += sizeof value / 4;
    return value;
  }

private:
  const std::vector<std::uint32_t>& words_;
  std::size_t at_ = 0;
};

/// The same rows in the order of their ids.
GrainState inOrder(const GrainState& s) {
  std::vector<std::size_t> order(s.rows()), first(s.rows() + 1);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return s.id[a] < s.id[b]; });
  for (std::size_t k = 0; k < s.rows(); ++k) first[k + 1] = first[k] + s.contacts[k];
  GrainState out;
  out.layout = s.layout, out.total = s.total, out.skin = s.skin, out.rebuilds = s.rebuilds;
  const auto walls = static_cast<std::size_t>(s.layout.boundaries);
  for (const std::size_t k : order) {
    out.id.push_back(s.id[k]);
    out.position.push_back(s.position[k]), out.velocity.push_back(s.velocity[k]), out.spin.push_back(s.spin[k]);
    out.remainders.push_back(s.remainders[k]), out.travelled.push_back(s.travelled[k]);
    if (!s.radius.empty()) out.radius.push_back(s.radius[k]);
    if (!s.material.empty()) out.material.push_back(s.material[k]);
    if (!s.dissipated.empty()) out.dissipated.push_back(s.dissipated[k]);
    if (!s.crossings.empty()) out.crossings.push_back(s.crossings[k]);
    if (!s.wallBits.empty()) out.wallBits.push_back(s.wallBits[k]);
    if (!s.wallShear.empty())
      for (std::size_t b = 0; b < walls; ++b) out.wallShear.push_back(s.wallShear[k * walls + b]);
    if (!s.wallRolling.empty())
      for (std::size_t b = 0; b < walls; ++b) out.wallRolling.push_back(s.wallRolling[k * walls + b]);
    out.contacts.push_back(s.contacts[k]);
    for (std::size_t c = first[k]; c < first[k + 1]; ++c) {
      out.neighbour.push_back(s.neighbour[c]);
      if (!s.contactShear.empty()) out.contactShear.push_back(s.contactShear[c]);
      if (!s.contactRolling.empty()) out.contactRolling.push_back(s.contactRolling[c]);
    }
  }
  return out;
}

} // namespace

GrainState redistribute(const base::Comm& comm, const GrainState& s, const std::vector<int>& destination) {
  if (comm.alone()) return s;
  std::vector<std::vector<std::uint32_t>> to(static_cast<std::size_t>(comm.size()));
  const auto walls = static_cast<std::size_t>(s.layout.boundaries);
  std::size_t c = 0;
  for (std::size_t k = 0; k < s.rows(); ++k) {
    RowPacker put(to[static_cast<std::size_t>(destination[k])]);
    put(s.id[k]), put(s.position[k]), put(s.velocity[k]), put(s.spin[k]), put(s.remainders[k]), put(s.travelled[k]);
    if (s.layout.radii) put(s.radius[k]);
    if (s.layout.materials) put(s.material[k]);
    if (s.layout.ledger) put(s.dissipated[k]);
    if (s.layout.periodic) put(s.crossings[k]);
    if (walls > 0) put(s.wallBits[k]);
    for (std::size_t b = 0; s.layout.friction && b < walls; ++b) put(s.wallShear[k * walls + b]);
    for (std::size_t b = 0; s.layout.rolling && b < walls; ++b) put(s.wallRolling[k * walls + b]);
    put(s.contacts[k]);
    for (const std::size_t end = c + s.contacts[k]; c < end; ++c) {
      put(s.neighbour[c]);
      if (s.layout.friction) put(s.contactShear[c]);
      if (s.layout.rolling) put(s.contactRolling[c]);
    }
  }
  std::vector<base::Bytes> bytes;
  for (std::vector<std::uint32_t>& words : to) {
    bytes.push_back(base::Comm::bytesOf(words));
    std::vector<std::uint32_t>().swap(words);
  }
  GrainState out;
  out.layout = s.layout, out.total = s.total, out.skin = s.skin, out.rebuilds = s.rebuilds;
  for (const base::Bytes& from : comm.allToAll(bytes)) {
    const auto words = base::Comm::valuesOf<std::uint32_t>(from);
    for (RowReader row(words); row.more();) {
      out.id.push_back(row.take<std::uint32_t>()), out.position.push_back(row.take<base::Position>());
      out.velocity.push_back(row.take<base::Vec3f>()), out.spin.push_back(row.take<base::Vec3f>());
      out.remainders.push_back(row.take<Remainders>());
      out.travelled.push_back(row.take<base::Vec3<std::uint32_t>>());
      if (s.layout.radii) out.radius.push_back(row.take<float>());
      if (s.layout.materials) out.material.push_back(row.take<std::uint32_t>());
      if (s.layout.ledger) out.dissipated.push_back(row.take<double>());
      if (s.layout.periodic) out.crossings.push_back(row.take<Crossings>());
      if (walls > 0) out.wallBits.push_back(row.take<std::uint32_t>());
      for (std::size_t b = 0; s.layout.friction && b < walls; ++b) out.wallShear.push_back(row.take<base::Vec3f>());
      for (std::size_t b = 0; s.layout.rolling && b < walls; ++b) out.wallRolling.push_back(row.take<base::Vec3f>());
      out.contacts.push_back(row.take<std::uint32_t>());
      for (std::uint32_t n = 0; n < out.contacts.back(); ++n) {
        out.neighbour.push_back(row.take<std::uint32_t>());
        if (s.layout.friction) out.contactShear.push_back(row.take<base::Vec3f>());
        if (s.layout.rolling) out.contactRolling.push_back(row.take<base::Vec3f>());
      }
    }
  }
  return inOrder(out);
}

/// The hash goes from rank to rank.
base::StateHash hashOf(const GrainState& grains, const base::Comm& comm) {
  const std::vector<std::uint32_t> words = grains.words();
  std::uint64_t value = 0;
  const auto total = static_cast<std::uint64_t>(comm.sumOf(static_cast<std::int64_t>(words.size())));
  if (!comm.first()) value = base::Comm::valuesOf<std::uint64_t>(comm.receive(comm.rank() - 1)).front();
  base::StateHash hash(value);
  if (comm.first()) hash.add(total);
  for (const std::uint32_t word : words) hash.add(static_cast<std::uint64_t>(word));
  const auto bytes = base::Comm::bytesOf(std::vector<std::uint64_t>{hash.value()});
  if (comm.rank() + 1 < comm.size()) comm.send(comm.rank() + 1, bytes);
  return base::StateHash(base::Comm::valuesOf<std::uint64_t>(comm.broadcast(bytes, comm.size() - 1)).front());
}

std::uint64_t blockStart(const base::Comm& comm, std::int64_t total, int rank) {
  const auto size = static_cast<std::uint64_t>(comm.size()), r = static_cast<std::uint64_t>(rank);
  const auto all = static_cast<std::uint64_t>(total);
  return all / size * r + std::min(r, all % size);
}

int blockOf(const base::Comm& comm, std::int64_t total, std::uint32_t id) {
  const auto size = static_cast<std::uint64_t>(comm.size()), all = static_cast<std::uint64_t>(total);
  const std::uint64_t each = all / size, larger = all % size, edge = (each + 1) * larger;
  return static_cast<int>(id < edge ? id / (each + 1) : larger + (id - edge) / each);
}

} // namespace grouser::terrain
