// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_constants.hpp"
#include "terrain/grain_field.hpp"

#include <tuple>

namespace grouser::terrain {

struct GrainKernelData;

/// The fields of the grains. Each is declared here with its uses; growth, sorting, migration, ghosts and memory counts
/// loop over all of them, and checkpoints over those that are saved unchanged.
struct GrainFields {
  /// With the widths that scenes of this layout need; nothing is allocated.
  explicit GrainFields(const GrainLayout& scene);

  GrainField<base::Position> position{kBuffered | kSorted | kMigrates | kGhosted | kUpdated, &GrainState::position};
  GrainField<Motion> motion{kBuffered | kSorted | kMigrates | kGhosted | kUpdated};
  GrainField<Remainders> remainders{kSorted | kMigrates, &GrainState::remainders};
  GrainField<std::uint32_t> id{kSorted | kMigrates | kGhosted, &GrainState::id};
  /// A bit for each wall, floor or surface in touch.
  GrainField<std::uint32_t> boundaryContactMask{kSorted | kMigrates, &GrainState::wallBits};
  GrainField<Crossings> crossings{kSorted | kMigrates, &GrainState::crossings};
  /// Motion before the last step while the grains are sorted between steps; otherwise that is motion.next, and the
  /// width is 0.
  GrainField<Motion> formerMotion{kSorted | kMigrates};
  /// Low words of the positions when the neighbours were listed.
  GrainField<base::Vec3<std::uint32_t>> reference{0};
  /// 1 + place in the list of grains near boundaries, and so of their springs there, until the next such list; 0 for
  /// all others. Undefined for ghosts until then.
  GrainField<std::uint32_t> boundaryOf{kSorted | kMigrates};
  /// On several ranks, from migration to list: see contact::RowOrigins. Of width 0 before the first migration.
  GrainField<std::uint32_t> rowOrigin{kSorted};

  template <class Self> static auto all(Self& f) {
    return std::tie(f.position, f.motion, f.remainders, f.id, f.boundaryContactMask, f.crossings, f.formerMotion,
                    f.reference, f.boundaryOf, f.rowOrigin);
  }

  /// Device memory of one grain.
  std::size_t bytesPerGrain() const;
  /// Part of it that is released while grains are sorted and lists rebuilt.
  std::size_t bytesMadeAnew() const;
};

/// Grains that enter on this rank, one an element.
struct EnteringGrains {
  std::vector<base::Position> position;
  std::vector<Motion> motion;
  std::vector<std::uint32_t> id;
};

/// The state of this rank's grains on its device, by slot; those of other ranks that it needs (ghosts) lie among them.
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

  void setGravityStep(const base::Vec3d& step) { gravityStep_ = step; } ///< g dt [m/s], for grains that enter
  /// Fills slots behind the others; missing values are zero. Entering grains count as having fallen freely until now.
  void append(const EnteringGrains& grains);
  /// For a loaded state: the caller sets its fields.
  void setSlots(std::size_t slots);
  /// Before grains migrate and are sorted: releases memory that is rebuilt afterwards (the `next` of fields,
  /// references), so that lists may use it meanwhile. No step may be taken between the two calls.
  void beginRebuild();
  /// The neighbours are listed at the present positions; allocates the memory again.
  void endRebuild();
  /// Moves slot order[i] (device array) to slot i. Within a rebuild.
  void permute(const std::uint32_t* order);
  /// After a step: swaps `next` and `now`; the state before it stays in `next`.
  void swapBuffers();

  /// The fields of one use (kMigrates, kGhosted, kUpdated), for an exchange between ranks. `written`: the `next` of
  /// each, which the step just launched writes, since the buffers are not swapped yet.
  std::vector<contact::ExchangeField> exchanged(FieldUse use, bool written = false);
  /// Moves slot from[k] to slot to[k], for k < count (device arrays); nothing moves from any of `to`.
  void move(const std::uint32_t* from, const std::uint32_t* to, std::size_t count);
  /// Keeps the slots that fit; further slots are undefined. Within a rebuild.
  void resizeKeeping(std::size_t slots);

  /// Motion before the last step, on the device, by slot; null unless a step came last.
  const Motion* formerMotion() const { return hasFormer_ ? fields_.motion.next.data() : nullptr; }
  bool knowsFormerMotion() const { return hasFormer_; } ///< a rank without grains too, whose array has no address
  /// Between these two calls the grains may be sorted and migrate without the loss of formerMotion().
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
