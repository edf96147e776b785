// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_arrays.hpp"

#include "base/gather.cuh"
#include "terrain/grain_kernel_data.cuh"

#include <algorithm>
#include <cstddef>
#include <type_traits>

namespace grouser::terrain {

namespace {

struct KeepReference {
  const base::Position* position;
  base::Vec3<std::uint32_t>* reference;
  GROUSER_HD void operator()(int i) const { reference[i] = {position[i].x, position[i].y, position[i].z}; }
};

/// Moves records of `width` elements within one array. Threads do not conflict: no slot is both in `from` and in `to`.
template <class T> struct Move {
  const std::uint32_t *from, *to;
  T* array;
  std::uint32_t width;
  GROUSER_HD void operator()(int k) const {
    for (std::uint32_t w = 0; w < width; ++w)
      array[std::int64_t{to[k]} * width + w] = array[std::int64_t{from[k]} * width + w];
  }
};

/// A field missing in all() would be skipped by growth, sorting and migration. A test checks for duplicates.
template <class... Fields> constexpr std::size_t sizeOf(const std::tuple<Fields&...>*) {
  return (sizeof(Fields) + ...);
}
using AllFields = decltype(GrainFields::all(std::declval<GrainFields&>()));
static_assert(sizeof(GrainFields) == sizeOf(static_cast<AllFields*>(nullptr)),
              "GrainFields::all() must name every grain field");
static_assert(std::tuple_size_v<AllFields> + 2 <= contact::Exchange::kMaxFields,
              "all grain fields, neighbour rows and boundary springs must fit into a migration");

} // namespace

GrainFields::GrainFields(const GrainLayout& scene) {
  boundaryContactMask.width = boundaryOf.width = scene.boundaries > 0;
  crossings.width = scene.periodic > 0;
  formerMotion.width = rowOrigin.width = 0;
}

std::size_t GrainFields::bytesPerGrain() const {
  std::size_t bytes = 0;
  const auto add = [&]<class T>(const GrainField<T>& field) {
    bytes += field.width * sizeof(T) * (field.has(kBuffered) ? 2 : 1);
  };
  std::apply([&](const auto&... field) { (add(field), ...); }, all(*this));
  return bytes;
}

std::size_t GrainFields::bytesMadeAnew() const {
  std::size_t bytes = reference.width * sizeof(base::Vec3<std::uint32_t>);
  const auto add = [&]<class T>(const GrainField<T>& field) {
    if (field.has(kBuffered)) bytes += field.width * sizeof(T);
  };
  std::apply([&](const auto&... field) { (add(field), ...); }, all(*this));
  return bytes;
}

GrainArrays::GrainArrays(const base::Exec& exec, const GrainConstants& c)
    : exec_(exec), gravityStep_(c.model.gravity * c.model.timeStep), fields_(c.layout()) {
  forEach([&]<class T>(GrainField<T>& field) { field.now = base::Array<T>(exec), field.next = base::Array<T>(exec); });
}

void GrainArrays::append(const EnteringGrains& grains) {
  const std::size_t before = slots_, fresh = grains.id.size();
  slots_ += fresh;
  forEach([&]<class T>(GrainField<T>& field) {
    if (!field.has(kMigrates)) return; // rebuilt with the next list
    // Exact size at the start; geometric growth for grains that enter later.
    const auto grow = [&](base::Array<T>& array) {
      before == 0 ? array.resize(slots_ * field.width) : array.resizeKeeping(slots_ * field.width);
      base::setZero(exec_, array.data() + before * field.width, fresh * field.width * sizeof(T));
    };
    grow(field.now);
    if (field.has(kBuffered)) grow(field.next);
  });
  const auto set = [&]<class T>(base::Array<T>& array, const std::vector<T>& values) {
    base::copyToDevice(exec_, array.data() + before, values.data(), fresh * sizeof(T));
  };
  set(fields_.position.now, grains.position), set(fields_.motion.now, grains.motion), set(fields_.id.now, grains.id);
  std::vector<Motion> former = grains.motion;
  const base::Vec3f fallen = gravityStep_.as<float>();
  for (auto& [v, w] : former) v = {v.x - fallen.x, v.y - fallen.y, v.z - fallen.z, v.w};
  set(fields_.motion.next, former);
}

void GrainArrays::setSlots(std::size_t slots) {
  slots_ = slots;
  hasFormer_ = false;
  forEach([&](auto& field) {
    if (field.has(kBuffered)) field.next.resize(slots * field.width);
  });
}

template <class T> void GrainArrays::gather(const std::uint32_t* order, const GrainField<T>& field, T* to) const {
  base::forEach(exec_, "permute grains", static_cast<std::int64_t>(slots_),
                base::Gather<T>{order, field.now.data(), to, static_cast<int>(field.width)});
}

void GrainArrays::permute(const std::uint32_t* order) {
  std::size_t most = 0; // bytes of a field without a buffer
  forEach([&]<class T>(GrainField<T>& field) {
    if (!field.has(kSorted) || field.now.empty()) return;
    if (!field.has(kBuffered)) {
      most = std::max(most, field.now.size() * sizeof(T));
      return;
    }
    field.next = base::Array<T>::unset(exec_, field.now.bytes() / sizeof(T));
    field.next.resize(field.now.size());
    gather(order, field, field.next.data());
    field.now.swap(field.next);
    field.next = base::Array<T>(exec_);
  });
  // Copies all fields through one temporary buffer and back, so that each array keeps its memory between rebuilds.
  base::Array<std::byte> place = base::Array<std::byte>::unset(exec_, most);
  forEach([&]<class T>(GrainField<T>& field) {
    if (!field.has(kSorted) || field.has(kBuffered) || field.now.empty()) return;
    T* const to = reinterpret_cast<T*>(place.data());
    gather(order, field, to);
    base::copyOnDevice(exec_, field.now.data(), to, field.now.size() * sizeof(T));
  });
}

void GrainArrays::beginRebuild() {
  hasFormer_ = false;
  forEach([this]<class T>(GrainField<T>& field) {
    if (field.has(kBuffered)) field.next = base::Array<T>(exec_);
  });
  fields_.reference.now = base::Array<base::Vec3<std::uint32_t>>(exec_);
}

void GrainArrays::endRebuild() {
  forEach([this](auto& field) {
    if (field.has(kBuffered)) field.next.resize(slots_ * field.width);
  });
  fields_.reference.now.resize(slots_);
  base::forEach(exec_, "keep reference", static_cast<std::int64_t>(slots_),
                KeepReference{fields_.position.now.data(), fields_.reference.now.data()});
}

void GrainArrays::swapBuffers() {
  forEach([](auto& field) {
    if (field.has(kBuffered)) field.now.swap(field.next);
  });
  hasFormer_ = true;
}

std::vector<contact::ExchangeField> GrainArrays::exchanged(FieldUse use, bool written) {
  std::vector<contact::ExchangeField> fields;
  forEach([&](auto& field) {
    if (field.has(use)) fields.push_back(field.exchanged(written));
  });
  return fields;
}

void GrainArrays::move(const std::uint32_t* from, const std::uint32_t* to, std::size_t count) {
  forEach([&]<class T>(GrainField<T>& field) {
    if (!field.has(kMigrates)) return;
    base::forEach(exec_, "close ranks", static_cast<std::int64_t>(count),
                  Move<T>{from, to, field.now.data(), static_cast<std::uint32_t>(field.width)});
  });
}

void GrainArrays::resizeKeeping(std::size_t slots) {
  slots_ = slots;
  forEach([&](auto& field) {
    if (field.has(kMigrates)) field.now.resizeKeeping(slots * field.width);
  });
}

void GrainArrays::holdFormer() {
  if (!hasFormer_) return;
  fields_.formerMotion.width = 1;
  fields_.formerMotion.now.swap(fields_.motion.next);
}

void GrainArrays::releaseFormer() {
  if (fields_.formerMotion.width == 0) return;
  fields_.formerMotion.width = 0;
  fields_.formerMotion.now.swap(fields_.motion.next);
  fields_.formerMotion.now = base::Array<Motion>(exec_);
  hasFormer_ = true;
}

void GrainArrays::stop() {
  std::vector<Motion> motion = fields_.motion.now.toHost();
  for (auto& [v, w] : motion) v = {0, 0, 0, v.w}, w = {0, 0, 0, w.w};
  fields_.motion.now.assign(motion);
  fields_.remainders.now.zero();
  hasFormer_ = false;
}

void GrainArrays::describe(GrainKernelData& d) {
  GrainFields& f = fields_;
  d.count = static_cast<std::int64_t>(slots_);
  d.position = f.position.now.data(), d.nextPosition = f.position.next.data();
  d.motion = f.motion.now.data(), d.nextMotion = f.motion.next.data();
  d.remainders = f.remainders.now.data();
  d.id = f.id.now.data();
  d.reference = f.reference.now.data();
  d.crossings = f.crossings.now.data();
  d.boundaryOf = f.boundaryOf.now.data();
  d.boundaryContactMask = f.boundaryContactMask.now.data();
}

std::size_t GrainArrays::bytes() const {
  std::size_t total = 0;
  forEach([&](const auto& field) { total += field.now.bytes() + field.next.bytes(); });
  return total;
}

} // namespace grouser::terrain
