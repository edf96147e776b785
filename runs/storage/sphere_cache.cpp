// SPDX-License-Identifier: BSD-3-Clause
#include "runs/storage/sphere_cache.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "runs/support/file_lock.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/sealed_file.hpp"
#include "runs/support/stopwatch.hpp"

#include <chrono>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <thread>

namespace grouser::storage {

namespace fs = std::filesystem;

namespace {

constexpr auto kSpheres = support::KeptFiles::Kind::spheres;
constexpr const char* kSetFile = "kept sphere set";
constexpr int kSetFileVersion = 2;
constexpr auto kSpheresLook = std::chrono::milliseconds(20); // polling interval for the lock of another program
constexpr double kPatience = 120; // maximum waiting time [s]; then both programs compute the set

// File contents after the seal: length of the origin, origin, figures, spheres, all as in memory.
static_assert(std::is_trivially_copyable_v<base::SetSphere> && sizeof(base::SetSphere) == 10 * sizeof(double),
              "a sphere has another shape: raise kSetFileVersion");

} // namespace

void SphereCache::write(const fs::path& path, const std::string& origin, const Found& found) {
  const base::SphereSet& set = found.set;
  std::ofstream out(path, std::ios::binary);
  const std::string seal(support::kSealBytes, '\0');
  const std::uint64_t length = origin.size();
  const base::SphereSetFigures figures = base::figuresOf(set);
  out.write(seal.data(), static_cast<std::streamsize>(seal.size()));
  out.write(reinterpret_cast<const char*>(&length), sizeof length);
  out.write(origin.data(), static_cast<std::streamsize>(length));
  out.write(reinterpret_cast<const char*>(&figures), sizeof figures);
  out.write(reinterpret_cast<const char*>(&found.protrusion), sizeof found.protrusion);
  out.write(reinterpret_cast<const char*>(set.spheres.data()),
            static_cast<std::streamsize>(set.spheres.size() * sizeof(base::SetSphere)));
  out.close();
  if (!out) throw support::notWritten(path);
}

/// Throws if the bytes have a different origin or are truncated.
SphereCache::Found SphereCache::parsed(const std::string& bytes, const std::string& origin) {
  const char *at = bytes.data(), *end = at + bytes.size();
  const auto take = [&](void* to, std::size_t count) {
    if (static_cast<std::size_t>(end - at) < count) throw base::InputError("is truncated");
    std::memcpy(to, at, count);
    at += count;
  };
  std::uint64_t length = 0;
  take(&length, sizeof length);
  if (length != origin.size() || static_cast<std::size_t>(end - at) < length ||
      origin.compare(0, length, at, length) != 0)
    throw base::InputError("contents do not match the file name");
  at += length;
  base::SphereSetFigures figures{};
  take(&figures, sizeof figures);
  Found found;
  take(&found.protrusion, sizeof found.protrusion);
  if (static_cast<std::size_t>(end - at) != figures.spheres * sizeof(base::SetSphere))
    throw base::InputError("is truncated");
  base::SphereSet& set = found.set;
  set.spheres.resize(figures.spheres);
  take(set.spheres.data(), figures.spheres * sizeof(base::SetSphere));
  setFigures(set, figures);
  return found;
}

std::optional<SphereCache> SphereCache::ofUser(const base::Comm& comm) {
  const std::optional<support::KeptFiles> files = support::KeptFiles::ofUser(comm);
  return files ? std::optional(SphereCache(*files)) : std::nullopt;
}

base::SphereSet SphereCache::cut(const coupling::PartCut& part, spheredecomp::Protrusion* protrusion) {
  // The plain conversion, if accurate enough, serves all contacts of the part.
  if (part.limit && part.limit->automatic) {
    coupling::PartCut plain = part;
    plain.limit->automatic = false;
    spheredecomp::Protrusion measured;
    base::SphereSet set = cut(plain, &measured);
    if (spheredecomp::meets(*part.limit, set, part.options, measured)) {
      if (protrusion) *protrusion = measured;
      return set;
    }
  }
  support::Stopwatch clock;
  const std::string origin =
      spheredecomp::cutOrigin(*part.mesh, part.options) + (part.limit ? spheredecomp::limitOrigin(*part.limit) : "");
  const fs::path file = files_.fileOf(kSpheres, origin);
  std::optional<Found> found = find(file, origin);
  if (!found && lookUpOnly_) throw NotKept();
  support::FileLock lock;
  const bool usable = found || files_.writable();
  if (!found && usable) {
    // If several programs need the same set, the first computes it.
    while (!lock.take(support::KeptFiles::lockOf(file)) && clock.seconds() < kPatience)
      std::this_thread::sleep_for(kSpheresLook);
    found = find(file, origin);
  }
  if (found) {
    found->set.name = part.name;
    ++taken_, taking_ += clock.seconds();
    if (protrusion) *protrusion = found->protrusion;
    return std::move(found->set);
  }
  clock = {};
  Found fresh;
  fresh.set = coupling::cutPart(part, fresh.protrusion);
  ++cut_, cutting_ += clock.seconds();
  if (usable && keep(file, origin, fresh)) ++kept_;
  if (protrusion) *protrusion = fresh.protrusion;
  return std::move(fresh.set);
}

std::optional<SphereCache::Found> SphereCache::find(const fs::path& file, const std::string& origin) const {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  try {
    Found found = parsed(support::readSealed(file, kSetFile, kSetFileVersion), origin);
    support::KeptFiles::noteUse(file);
    return found;
  } catch (const std::exception& e) {
    if (!fs::is_regular_file(file, error)) return {}; // another program has deleted it to free disk space
    const std::string what = e.what();                // begins with the file name for a damaged seal
    support::printStderr("WARNING: {}{}; continuing without it\n",
                         what.rfind(file.string(), 0) == 0 ? "" : file.string() + ": ", what);
    fs::remove(file, error); // so that the warning appears only once
    return {};
  }
}

bool SphereCache::keep(const fs::path& file, const std::string& origin, const Found& found) const {
  const double bytes = static_cast<double>(found.set.spheres.size() * sizeof(base::SetSphere)) + 4096;
  if (!files_.fits(bytes)) return false;
  const fs::path fresh = support::KeptFiles::freshName(file);
  try {
    support::writeSealed(fresh, kSetFile, kSetFileVersion, [&](const fs::path& part) { write(part, origin, found); });
  } catch (const std::exception&) {
    return false;
  }
  return files_.put(fresh, file);
}

std::string SphereCache::summary(const base::Comm& comm) const {
  std::int64_t counts[] = {taken_, cut_, kept_};
  double times[] = {taking_, cutting_};
  comm.sum(counts, 3), comm.maximum(times, 2); // ranks work in parallel, so times are maxima
  const auto [taken, cut, kept] = counts;
  const std::string folder = files_.folder().string();
  std::string text =
      taken > 0 ? fmt::format("{} read from {} in {:.2f} s", base::counted(taken, "sphere set"), folder, times[0]) : "";
  if (cut == 0) return text;
  const std::string what = (text.empty() ? "" : text + "; ") + base::counted(cut, "mesh", "meshes");
  text = fmt::format("{} converted to spheres in {:.2f} s; ", what, times[1]);
  if (kept == 0) return text + "not cached";
  return text + (kept < cut ? fmt::format("{} ", kept) : "") + "cached in " + folder;
}

} // namespace grouser::storage
