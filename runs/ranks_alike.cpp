// SPDX-License-Identifier: BSD-3-Clause
#include "runs/ranks_alike.hpp"

#include "base/error.hpp"
#include "runs/build_info.hpp"
#include "runs/checkpoint.hpp"

#include <fmt/format.h>

namespace grouser::runs {

void requireAlike(const Scene& scene, const base::Comm& comm) {
  if (comm.alone()) return;
  const BuildInfo build = buildInfo();
  const std::pair<const char*, std::string> facts[] = {
      {"program (version, commit, compiler)", fmt::format("{}, {}, {}", build.version, build.commit, build.compiler)},
      {"scene", resolvedToml(scene)},
      {"files that the scene names", inputsOf(scene)},
  };
  for (const auto& [what, mine] : facts) {
    const auto all = comm.gatherAll(std::vector<char>(mine.begin(), mine.end()));
    for (std::size_t r = 1; r < all.size(); ++r) {
      if (all[r] == all[0]) continue;
      const std::string first(all[0].begin(), all[0].end()), other(all[r].begin(), all[r].end());
      const bool brief = first.size() < 100 && other.size() < 100;
      throw base::InputError(fmt::format("{}: rank {} has another {} than rank 0{}; start all ranks with the same "
                                         "program and the same files",
                                         scene.file.string(), r, what,
                                         brief ? fmt::format(" ({} beside {})", other, first) : ""));
    }
  }
}

} // namespace grouser::runs
