// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/period.hpp"

#include <cstdint>

namespace grouser::contact {

/// Where rows lie, one for each grain slot: place k of row i is start[i] + k stride. On a CPU row stands behind row, in
/// few cache lines each; on a GPU the rows of 32 slots lie side by side, so that a warp reads its k-th places at once.
struct NeighbourRows {
  const std::uint32_t* start;
  std::int64_t stride;
  GROUSER_HD std::int64_t at(int i, std::uint32_t k) const { return start[i] + k * stride; }
};

/// What a kernel sees of the list: for grain slot i the slots of its neighbours, in ascending order of their global
/// ids, each with the history of that contact: `width` numbers. Bit k of the mask at touching[i * maskWords] says that
/// slot k touched in the last step. A CPU may read slots by eights: what lies behind a row's last is some grain's slot.
struct NeighbourView : NeighbourRows {
  const std::uint32_t *count, *slot;
  float* history; ///< null where contacts have none
  std::uint64_t* touching;
  std::int64_t maskWords; ///< 1 among equal spheres
};

/// Rows that came from other ranks with grains that were handed over: for each row `words(capacity)` words, namely the
/// number of neighbours in touch, `capacity` ids of those (ascending), and `capacity` histories of `width` numbers.
struct TravellingRows {
  std::uint32_t* data;
  std::uint32_t capacity;
  std::uint32_t width;
  GROUSER_HD std::uint32_t words() const { return 1 + capacity * (1 + width); }
};

/// Radii of spheres that are not all alike: by slot, in `w` [m], each a whole number of units of length.
struct RadiiInW {
  const base::Vec4f* sphere = nullptr; ///< null: all have the list's diameter
  float unitsPerLength = 0;            ///< a power of two
  GROUSER_HD std::int64_t units(int i) const { return static_cast<std::int64_t>(sphere[i].w * unitsPerLength); }
};

/// Where the rows of a list on one of several ranks come from.
struct RowOrigins {
  static constexpr std::uint32_t kNone = ~0u;
  const std::uint32_t* origin; ///< by new slot: row of the former list, or rows() + place in `arrived`, or kNone
  const std::uint32_t* ghost;  ///< by new slot: not 0 for a grain that needs no row
  TravellingRows arrived;
};

/// Dense grid over the cells in use; z runs fastest, so the three cells of a column are neighbours in memory. Along
/// periodic boundaries it is a ring of cells that fills the period, none narrower than `edge` asks.
struct CellGrid {
  using Cell = base::Vec3<std::uint32_t>;
  base::Period period;
  base::Vec3l edge{}; ///< [units]
  Cell low{}, cells{};

  /// Sets the edges, at least `least`, and the rings; bounds of the other axes are the caller's to find.
  void setEdge(std::int64_t least);
  GROUSER_HD std::uint64_t key(const Cell& c) const {
    return (static_cast<std::uint64_t>(c.x) * cells.y + c.y) * cells.z + c.z;
  }
  /// Counted from the lowest representable position, or from the lower of two periodic boundaries.
  GROUSER_HD Cell cellOf(const base::Position& p) const {
    constexpr std::int64_t kBias = std::int64_t{1} << 41;
    const base::Vec3l u = base::toUnits(p);
    Cell c;
    for (int a = 0; a < 3; ++a) {
      if (period.along(a)) {
        const std::int64_t inside = u[a] + period.periodsBack(a, u[a]) * period.length[a] - period.low[a];
        const auto k = static_cast<std::uint32_t>(inside / edge[a]);
        c[a] = k < cells[a] ? k : cells[a] - 1; // the last cell holds what the division leaves over
      } else {
        c[a] = static_cast<std::uint32_t>((u[a] + kBias) / edge[a]);
      }
    }
    return c;
  }
  GROUSER_HD Cell local(const base::Position& p) const { return cellOf(p) - low; }
};

struct TouchingRows;

/// Every pair of spheres whose surfaces are closer than the skin, listed from both sides, with contact history.
///
/// Valid while no grain has moved more than half the skin. Rows are as long as they need to be: no neighbour is ever
/// dropped. Grains are re-sorted in space at every rebuild; history follows the pair of global ids. Forces do not
/// depend on when the list is rebuilt: candidates that do not touch add nothing, and the order is that of the ids.
class NeighbourList {
public:
  /// `diameter` of the largest sphere and `skin` in units of the scene's position scale; `width`: numbers of history
  /// that each contact has, 0 for none. `period`: periodic boundaries, at least three diameters and skins apart.
  NeighbourList(const base::Exec& exec, std::int64_t diameter, std::int64_t skin, int width,
                const base::Period& period = {});

  /// Sorts `count` grains in space. Afterwards `order()[i]` is the old slot of the grain that belongs in slot i.
  void sort(const base::Position* position, std::size_t count);
  const std::uint32_t* order() const { return order_.data(); }

  /// Lists the neighbours of grains already permuted by `order()`, and carries history over from the last list.
  /// `id` is ascending-comparable global id by new slot.
  /// `origins`: on one of several ranks, else null; `radii`: of spheres of several sizes.
  void build(const base::Position* position, const std::uint32_t* id, const RowOrigins* origins = nullptr,
             const RadiiInW& radii = {});

  /// Neighbours in touch, at most, of the grains in `slots` (device array).
  std::uint32_t mostTouching(const std::uint32_t* slots, std::size_t count) const;
  /// Writes the rows of these slots for other ranks.
  void exportRows(const std::uint32_t* slots, std::size_t count, const TravellingRows& travelling) const;
  /// Grains that have a row; those that were added since the last build have none.
  std::uint32_t rows() const { return haveRows_ ? static_cast<std::uint32_t>(count_.size()) : 0; }

  /// The next list begins without history: other grains have taken the slots.
  void forget() { haveRows_ = false; }

  NeighbourView view();
  /// Between builds; a build needs more, for the contacts that it sets aside and for its grid of cells [B].
  std::size_t bytes() const;

  /// Contacts with history, for checkpoints and the state hash: arrays by slot, host side.
  struct HostCopy {
    std::vector<std::uint32_t> count, start, slot;
    std::vector<float> history; ///< [slot][width]; empty where contacts have none
    std::vector<std::uint64_t> touching;
    std::int64_t stride{}, maskWords{};
    bool touched(std::size_t i, std::uint32_t k) const {
      return touching[i * static_cast<std::size_t>(maskWords) + k / 64] >> (k & 63u) & 1;
    }
    std::int64_t at(std::size_t i, std::uint32_t k) const { return start[i] + k * stride; }
  };
  HostCopy toHost() const;
  /// Takes over touching bits and history of a host copy of the present list.
  void setHistory(const HostCopy& copy);

private:
  TouchingRows contacts() const;
  /// Gives the rows of `count_` neighbours their starts. Returns the places of all of them.
  std::uint32_t layRows();
  void checkLengths(std::uint32_t most, bool equal) const;

  base::Exec exec_;
  std::int64_t diameter_, skin_;
  base::Period period_;
  int width_;
  std::size_t sorted_{0}; ///< grains of the next list
  bool haveRows_{false};
  base::Array<std::uint32_t> count_, start_, slot_;
  base::Array<float> history_;
  base::Array<std::uint64_t> touching_;
  base::Array<std::uint32_t> id_; ///< by slot, as at the build
  std::int64_t stride_{1}, maskWords_{1};
  base::Array<std::uint32_t> order_, cellStart_, bounds_;
  CellGrid grid_;
};

} // namespace grouser::contact
