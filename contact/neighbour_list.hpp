// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/period.hpp"
#include "base/position.hpp"
#include "contact/cell_grid.hpp"
#include "contact/neighbour_view.hpp"

#include <cstdint>
#include <vector>

namespace grouser::contact {

struct TouchingRows;

/// Every pair of spheres whose surfaces are closer than the skin, listed from both sides, with contact history; from
/// one side only where the other sphere never moves.
///
/// Valid while no grain has moved more than half the skin. Rows have variable length: no neighbour is dropped. Grains
/// are re-sorted in space at every rebuild; history follows the pair of global ids. Forces do not depend on the time of
/// rebuilds: neighbours that do not touch add nothing, and the order is that of the ids.
class NeighbourList {
public:
  /// `diameter` of the largest sphere and `skin` in units of the scene's position scale; `width`: history values per
  /// contact, 0 for none. `period`: periodic boundaries, at least three diameters and skins apart, none along z.
  /// `smallest`: approximate diameter of the smallest sphere; 0: equal spheres.
  NeighbourList(const base::Exec& exec, std::int64_t diameter, std::int64_t skin, int width,
                const base::Period& period = {}, std::int64_t smallest = 0);

  /// Sorts `count` grains in space. Until build(), `order()[i]` is the old slot of the grain that belongs in slot i.
  /// `rowOf`: by old slot, its row in the present list, or a higher number without one; null: that of the slot itself.
  void sort(const base::Position* position, std::size_t count, const std::uint32_t* rowOf = nullptr);
  const std::uint32_t* order() const { return order_.data(); }

  /// Lists the neighbours of grains already permuted by `order()`, and restores history from the last list.
  /// `id` is ascending-comparable global id by new slot.
  /// `origins`: with several ranks, else null; `radii`: for spheres of several sizes.
  void build(const base::Position* position, const std::uint32_t* id, const RowOrigins* origins = nullptr,
             const RadiiInW& radii = {});

  /// Largest number of contacts of the grains in `slots` (device array).
  std::uint32_t mostTouching(const std::uint32_t* slots, std::size_t count) const;
  /// Writes the rows of these slots for other ranks.
  void exportRows(const std::uint32_t* slots, std::size_t count, const TravellingRows& travelling) const;
  /// Number of grains with a row; grains added since the last build have none.
  std::uint32_t rows() const { return haveRows_ ? static_cast<std::uint32_t>(count_.size()) : 0; }

  /// The next list begins without history: other grains have taken the slots.
  void forget() { haveRows_ = false; }

  /// Neighbours in all rows, each pair from both sides.
  std::uint64_t listed() const;

  std::size_t places() const { return slot_.size(); } ///< in all rows, padding included

  NeighbourView view();
  /// Memory between builds [B]; a build also needs memory for cached contacts and the cell grid.
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
  /// Sets touching bits and history from a host copy of the present list.
  void setHistory(const HostCopy& copy);

private:
  TouchingRows contacts() const;
  /// The largest radius near each cell of a fine grid.
  base::Array<std::uint32_t> largestNear(const RadiiInW& radii) const;
  void groupByContacts(const std::uint32_t* rowOf);

  base::Exec exec_;
  std::int64_t diameter_, skin_;
  int finer_; ///< cells per largest reach
  base::Period period_;
  int width_;
  std::size_t sorted_{0}; ///< grains of the next list
  bool haveRows_{false};
  base::Array<std::uint32_t> count_, start_, slot_, reach_;
  base::Array<float> history_;
  base::Array<std::uint64_t> touching_;
  base::Array<std::uint32_t> id_; ///< by slot, as at the build
  std::int64_t stride_{1}, maskWords_{1};
  base::Array<std::uint32_t> order_, cellStart_, slotAt_;
  CellGrid grid_;
};

} // namespace grouser::contact
