// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

namespace grouser::commands {

std::vector<CommandEntry> allCommands() {
  return {{"run", addRun, RankUse::shared},
          {"sweep", addSweep, RankUse::refused, "; --jobs lets several runs go at the same time"},
          {"check", addCheck, RankUse::refused, "; --jobs lets several runs go at the same time"},
          {"compare", addCompare, RankUse::refused, "; --jobs lets several runs go at the same time"},
          {"events", addEvents, RankUse::refused, "; --jobs lets several runs go at the same time"},
          {"map", addMap, RankUse::refused, "; --jobs lets several runs go at the same time"},
          {"bench", addBench, RankUse::shared},
          {"hash", addHash},
          {"study", addStudy, RankUse::refused},
          {"soil", addSoil, RankUse::refused, "; --jobs lets several tests go at the same time"},
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
