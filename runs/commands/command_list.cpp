// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

namespace grouser::commands {

std::vector<CommandEntry> allCommands() {
  return {{"run", addRun, RankUse::shared},
          {"sweep", addSweep, RankUse::refused, "; use --jobs for concurrent runs"},
          {"check", addCheck, RankUse::refused, "; use --jobs for concurrent runs"},
          {"compare", addCompare, RankUse::refused, "; use --jobs for concurrent runs"},
          {"events", addEvents, RankUse::refused, "; use --jobs for concurrent runs"},
          {"map", addMap, RankUse::refused, "; use --jobs for concurrent runs"},
          {"bench", addBench, RankUse::shared},
          {"hash", addHash},
          {"study", addStudy, RankUse::refused},
          {"soil", addSoil, RankUse::refused, "; use --jobs for concurrent tests"},
          {"render", addRender, RankUse::shared},
          {"report", addReport},
          {"sinkage", addSinkage},
          {"plan", addPlan},
          {"spheres", addSpheres},
          {"fields", addFields},
          {"soils", addSoils},
          {"manual", addManual}};
}

} // namespace grouser::commands
