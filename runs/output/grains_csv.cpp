// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/grains_csv.hpp"

#include "base/rounded.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string>

namespace grouser::output {

namespace fs = std::filesystem;

namespace {

constexpr const char* kHead = "step,time [s],id,position.x [m],position.y [m],position.z [m],velocity.x [m/s],"
                              "velocity.y [m/s],velocity.z [m/s],spin.x [rad/s],spin.y [rad/s],spin.z [rad/s],"
                              "radius [m]\n";

/// The lines up to this step, without the header. An incomplete last line has no line end and is ignored.
std::string linesUpTo(std::int64_t last, const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text, line;
  std::getline(file, line);
  while (std::getline(file, line) && !file.eof()) {
    if (std::strtoll(line.c_str(), nullptr, 10) > last) break;
    text += line + '\n';
  }
  return text;
}

/// Rows of all ranks in the order of the ids, collected on the first rank.
template <class T> std::vector<T> onFirst(const std::vector<T>& mine, const base::Comm& comm) {
  if (comm.alone()) return mine;
  std::vector<base::Bytes> to(static_cast<std::size_t>(comm.size()));
  to.front() = base::Comm::bytesOf(mine);
  std::vector<T> all;
  for (const base::Bytes& part : comm.allToAll(to)) {
    const std::vector<T> more = base::Comm::valuesOf<T>(part);
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

} // namespace

bool GrainsCsv::isRequested(std::optional<bool> asked, std::int64_t grains, double duration, double outputInterval) {
  if (asked) return *asked && grains > 0;
  const double rows = std::floor(duration / outputInterval) + 2;
  return grains > 0 && grains <= kMaxGrains && rows * static_cast<double>(grains) <= static_cast<double>(kMaxLines);
}

GrainsCsv::GrainsCsv(const fs::path& folder, std::optional<std::int64_t> kept, const base::Comm& comm)
    : path_(folder / kGrainsCsvName), comm_(comm) {
  if (!comm_.first()) return;
  support::replaceTextFile(path_,
                           kHead + (kept ? linesUpTo(*kept, path_) : "")); // keeps the former file if the run is killed
  file_.open(path_, std::ios::binary | std::ios::app);
  check();
}

void GrainsCsv::add(std::int64_t step, double time, const terrain::Grains& grains) {
  const terrain::GrainSnapshot mine = grains.snapshot();
  const auto id = onFirst(mine.id, comm_);
  const auto position = onFirst(mine.position, comm_);
  const auto velocity = onFirst(mine.velocity, comm_), spin = onFirst(mine.spin, comm_);
  const auto radius = onFirst(mine.radius, comm_); // empty if all radii are equal
  if (!comm_.first()) return;
  const double at = base::nearestDecimal(time);
  for (std::size_t i = 0; i < position.size(); ++i) {
    const auto& p = position[i];
    const auto &v = velocity[i], &w = spin[i];
    file_ << fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", step, at, id[i], p.x, p.y, p.z, v.x, v.y, v.z, w.x,
                         w.y, w.z, radius.empty() ? grains.model().radius : static_cast<double>(radius[i]));
  }
  file_.flush();
  check();
}

void GrainsCsv::check() {
  if (!file_) throw support::notWritten(path_);
}

} // namespace grouser::output
