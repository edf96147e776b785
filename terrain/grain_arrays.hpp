// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_constants.hpp"
#include "terrain/grain_field.hpp"

#include <tuple>

namespace grouser::terrain {

struct GrainKernelData;

/// Fields of the grains, each declared with its uses. Growth, sorting, migration, ghosts and memory counts loop over
/// all fields; checkpoints loop over the fields that are saved unchanged.
struct GrainFields {
  /// Sets the field widths required by this layout; does not allocate.
  explicit GrainFields(const GrainLayout& scene);

  GrainField<base::Position> position{kBuffered | kSorted | kMigrates | kGhosted | kUpdated, &GrainState::position};
  GrainField<Motion> motion{kBuffered | kSorted | kMigrates | kGhosted | kUpdated};
  GrainField<Remainders> remainders{kSorted | kMigrates, &GrainState::remainders};
  GrainField<std::uint32_t> id{kSorted | kMigrates | kGhosted, &GrainState::id};
  /// Bit mask of walls, floor and surfaces in contact.
  GrainField<std::uint32_t> boundaryContactMask{kSorted | kMigrates, &GrainState::wallBits};
  GrainField<Crossings> crossings{kSorted | kMigrates, &GrainState::crossings};
  /// Motion before the last step, stored while grains are sorted between steps; at other times motion.next stores it,
  /// and the width is 0.
  GrainField<Motion> formerMotion{kSorted | kMigrates};
  /// Low words of the positions when the neighbours were last listed.
  GrainField<base::Vec3<std::uint32_t>> reference{0};
  /// 1 + index in the list of grains near boundaries, and of their springs, until the next such list; 0 for all other
  /// grains. Undefined for ghosts until then.
  GrainField<std::uint32_t> boundaryOf{kSorted | kMigrates};
  /// Row origins, on several ranks, from migration to list: see contact::RowOrigins. Width 0 until first migration.
  GrainField<std::uint32_t> rowOrigin{kSorted};

  template <class Self> static auto all(Self& f) {
    return std::tie(f.position, f.motion, f.remainders, f.id, f.boundaryContactMask, f.crossings, f.formerMotion,
                    f.reference, f.boundaryOf, f.rowOrigin);
  }

  /// Device memory per grain [B].
  std::size_t bytesPerGrain() const;
  /// Part of that memory released while grains are sorted and lists rebuilt [B].
  std::size_t bytesMadeAnew() const;
};

/// Grains that enter on this rank, one per element.
struct EnteringGrains {
  std::vector<base::Position> position;
  std::vector<Motion> motion;
  std::vector<std::uint32_t> id;
};

/// State of this rank's grains on its device, by slot, including ghosts of other ranks' grains.
class GrainArrays {
public:
  GrainArrays(const base::Exec& exec, const GrainConstants& constants);

  std::size_t slots() const { return slots_; }
  GrainFields& fields() { return fields_; }
  const GrainFields& fields() const { return fields_; }
  /// Calls visit(field) for all fields.
  template <class Visit> void forEach(const Visit& visit) {
    std::apply([&](auto&... field) { (visit(field), ...); }, GrainFields::all(fields_));
  }
  template <class Visit> void forEach(const Visit& visit) const {
    std::apply([&](const auto&... field) { (visit(field), ...); }, GrainFields::all(fields_));
  }

  void setGravityStep(const base::Vec3d& step) { gravityStep_ = step; } ///< g dt [m/s], for entering grains
  /// Appends grains after the existing slots; missing values are zero. Entering grains are treated as in free fall.
  void append(const EnteringGrains& grains);
  /// Sets the number of slots for a loaded state; the caller sets the fields.
  void setSlots(std::size_t slots);
  /// Call before grains migrate and are sorted: releases memory that is rebuilt afterwards (`next` of fields,
  /// references) for use by the lists. No step may run before endRebuild().
  void beginRebuild();
  /// Call after the neighbours are listed at the current positions: allocates the memory again.
  void endRebuild();
  /// Moves slot order[i] (device array) to slot i. Call it only during a rebuild.
  void permute(const std::uint32_t* order);
  /// Swaps `next` and `now` after a step; the previous state remains in `next`.
  void swapBuffers();

  /// Fields of one use (kMigrates, kGhosted, kUpdated), for an exchange between ranks. `written`: true to use `next`,
  /// which the launched step writes, before the buffers are swapped.
  std::vector<contact::ExchangeField> exchanged(FieldUse use, bool written = false);
  /// Moves slot from[k] to slot to[k], for k < count (device arrays); the two sets must be disjoint.
  void move(const std::uint32_t* from, const std::uint32_t* to, std::size_t count);
  /// Changes the number of slots; contents that fit are kept, new slots are undefined. Call it only during a rebuild.
  void resizeKeeping(std::size_t slots);

  /// Motion before the last step, on the device, by slot; null unless the last operation was a step.
  const Motion* formerMotion() const { return hasFormer_ ? fields_.motion.next.data() : nullptr; }
  bool knowsFormerMotion() const { return hasFormer_; } ///< also true on a rank without grains, whose array is null
  /// Preserves formerMotion() while grains are sorted and migrate, between these two calls.
  void holdFormer();
  void releaseFormer();
  /// Sets velocities and spins to zero.
  void stop();

  void describe(GrainKernelData& d);
  std::size_t bytes() const;

private:
  template <class T> void gather(const std::uint32_t* order, const GrainField<T>& field, T* to) const;

  base::Exec exec_;
  base::Vec3d gravityStep_; ///< g dt [m/s]
  GrainFields fields_;
  std::size_t slots_{0};
  bool hasFormer_{false};
};

} // namespace grouser::terrain
