// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/run_notices.hpp"

#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/support/print_stderr.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <utility>

namespace grouser::sweeps {

namespace {

struct Mark {
  const char* begin; ///< start of a line in a log
  bool isWarning;
};
constexpr Mark kMarks[] = {{"WARNING: ", true}, {"grouser: note: ", false}, {"note      ", false}};

/// The text with '#' for each number, which identifies its kind. Digits within a word ("k_phi2") remain.
std::string kindOf(const std::string& text) {
  static const std::regex number(R"((^|[^\w.])\d+(\.\d+)?(e[-+]?\d+)?)");
  return std::regex_replace(text, number, "$1#");
}

/// Different notices in the log of a run, in their order.
std::vector<RunNotice> noticesIn(const std::filesystem::path& log) {
  std::vector<RunNotice> found;
  std::ifstream file(log);
  for (std::string line; std::getline(file, line);)
    for (const Mark& mark : kMarks)
      if (line.starts_with(mark.begin))
        if (std::string text = line.substr(std::string(mark.begin).size());
            std::none_of(found.begin(), found.end(), [&](const RunNotice& n) { return n.text == text; }))
          found.push_back({mark.isWarning, std::move(text), false, {}});
  return found;
}

} // namespace

bool isOnRigidGround(const scene::Scene& scene) {
  return scene.vehicle && scene.terrain && scene.terrain->kind == scene::TerrainKind::rigid;
}

std::vector<RunNotice> runNotices(const SweepPlan& plan, const std::filesystem::path& folder, bool sinkages) {
  std::vector<RunNotice> all;
  for (const SweepRun& run : plan.runs)
    for (RunNotice& own : noticesIn(folder / run.name / kRunLog)) {
      const auto same = std::find_if(all.begin(), all.end(), [&](const RunNotice& n) {
        return n.isWarning == own.isWarning && kindOf(n.text) == kindOf(own.text);
      });
      if (same == all.end()) {
        own.runs.push_back(run.name), all.push_back(std::move(own));
        continue;
      }
      same->varies = same->varies || same->text != own.text;
      if (same->runs.back() != run.name) same->runs.push_back(run.name);
    }
  std::stable_partition(all.begin(), all.end(), [](const RunNotice& n) { return n.isWarning; });
  RunNotice rigid{false,
                  "shoes do not sink into rigid ground; a negative sinkage is the height of the pads above it, on "
                  "their grousers",
                  false,
                  {}};
  for (const SweepRun& run : plan.runs)
    if (sinkages && isOnRigidGround(run.scene)) rigid.runs.push_back(run.name);
  if (!rigid.runs.empty()) all.push_back(std::move(rigid));
  return all;
}

std::string noticesText(const std::vector<RunNotice>& notices, std::size_t runs) {
  std::string text;
  for (const RunNotice& n : notices)
    text += fmt::format("{} in {} of {} run{}{}: {}\n", n.isWarning ? "WARNING" : "note", n.runs.size(), runs,
                        runs == 1 ? "" : "s", n.varies ? fmt::format(", e.g. {}", n.runs.front()) : "", n.text);
  return text;
}

nlohmann::ordered_json noticesJson(const std::vector<RunNotice>& notices) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const RunNotice& n : notices)
    json.push_back({{"kind", n.isWarning ? "warning" : "note"}, {"text", n.text}, {"runs", n.runs}});
  return json;
}

std::string noticesOfRun(const SweepRun& run, const std::filesystem::path& folder) {
  std::string text;
  for (const RunNotice& n : noticesIn(folder / run.name / kRunLog))
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", n.isWarning ? "WARNING" : "note", n.text);
  return text;
}

void printNotesOf(const SweepPlan& plan) {
  std::set<std::string> printed;
  for (const SweepRun& run : plan.runs)
    for (const auto& [isWarning, text] : scene::sceneNotes(run.scene))
      if (printed.insert(kindOf(text)).second)
        support::printStderr("{}: {}\n", isWarning ? "WARNING" : "grouser: note", text);
}

} // namespace grouser::sweeps
