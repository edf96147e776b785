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

/// Neighbour list of all pairs of spheres with a surface gap below the skin, with contact history. Each pair is listed
/// from both sides, or only from the moving side if the other sphere is fixed.
///
/// The list is valid while no grain has moved more than half the skin. Rows have variable length: no neighbour is
/// dropped. Each rebuild re-sorts the grains in space; history is matched by the global ids of a pair. Forces do not
/// depend on the rebuild times: pairs out of contact contribute zero, and the summation order follows the ids.
class NeighbourList {
public:
  /// `diameter` (largest sphere) and `skin` are in units of the scene's position scale; `width`: history values per
  /// contact, 0 for none. `period`: periodic boundaries, at least three diameters plus skins apart, not along z.
  /// `smallest`: approximate diameter of the smallest sphere; 0: equal spheres.
  NeighbourList(const base::Exec& exec, std::int64_t diameter, std::int64_t skin, int width,
                const base::Period& period = {}, std::int64_t smallest = 0);

  /// Sorts `count` grains in space. Until build(), `order()[i]` is the old slot of the grain that moves to slot i.
  /// `rowOf`: by old slot, its row in the current list, or a higher number if it has none; null: equal to the slot.
  void sort(const base::Position* position, std::size_t count, const std::uint32_t* rowOf = nullptr);
  const std::uint32_t* order() const { return order_.data(); }

  /// Lists the neighbours of grains already permuted by `order()`, and restores the history of the previous list. `id`:
  /// global id by new slot, which defines the order in a row. `origins`: null on a single rank. `radii`: for
  /// spheres of several sizes.
  void build(const base::Position* position, const std::uint32_t* id, const RowOrigins* origins = nullptr,
             const RadiiInW& radii = {});

  /// Maximum number of contacts of the grains in `slots` (device array).
  std::uint32_t maxTouching(const std::uint32_t* slots, std::size_t count) const;
  /// Writes the rows of these slots for transfer to other ranks.
  void exportRows(const std::uint32_t* slots, std::size_t count, const TravellingRows& travelling) const;
  /// Number of grains with a row; grains added since the last build have no row.
  std::uint32_t rows() const { return haveRows_ ? static_cast<std::uint32_t>(count_.size()) : 0; }

  /// Discards the history, because other grains occupy the slots: the next list starts without it.
  void forget() { haveRows_ = false; }

  /// Number of listed neighbours, each pair counted from both sides.
  std::uint64_t listed() const;

  std::size_t places() const { return slot_.size(); } ///< in all rows, padding included

  NeighbourView view();
  /// Memory between builds [B]; a build also needs memory for cached contacts and the cell grid.
  std::size_t bytes() const;

  /// Contacts with history, for checkpoints and the state hash: arrays by slot, host side.
  struct HostCopy {
    std::vector<std::uint32_t> count, start, slot;
    std::vector<float> history; ///< [slot][width]; empty without history
    std::vector<std::uint64_t> touching;
    std::int64_t stride{}, maskWords{};
    bool touched(std::size_t i, std::uint32_t k) const {
      return touching[i * static_cast<std::size_t>(maskWords) + k / 64] >> (k & 63u) & 1;
    }
    std::int64_t at(std::size_t i, std::uint32_t k) const { return start[i] + k * stride; }
  };
  HostCopy toHost() const;
  /// Sets contact bits and history from a host copy of the current list.
  void setHistory(const HostCopy& copy);

private:
  TouchingRows contacts() const;
  /// Maximum radius near each cell of a fine grid.
  base::Array<std::uint32_t> largestNear(const RadiiInW& radii) const;
  void groupByContacts(const std::uint32_t* rowOf);

  base::Exec exec_;
  std::int64_t diameter_, skin_;
  int finer_; ///< cells per maximum reach
  base::Period period_;
  int width_;
  std::size_t sorted_{0}; ///< number of grains in the next list
  bool haveRows_{false};
  base::Array<std::uint32_t> count_, start_, slot_, reach_;
  base::Array<float> history_;
  base::Array<std::uint64_t> touching_;
  base::Array<std::uint32_t> id_; ///< by slot, at the time of build()
  std::int64_t stride_{1}, maskWords_{1};
  base::Array<std::uint32_t> order_, cellStart_, slotAt_;
  CellGrid grid_;
};

} // namespace grouser::contact
