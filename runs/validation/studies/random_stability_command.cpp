// SPDX-License-Identifier: BSD-3-Clause
// `grouser study stability --random`: table, files and verdict of the random scenes.
#include "base/error.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/progress.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"
#include "runs/validation/studies/random_stability.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

namespace grouser::studies {

namespace {

namespace fs = std::filesystem;

constexpr double kAccuracy = 0.05;

const char* kColumns =
    "scene,seed,kind,grains,law,precision,restitution,friction,rolling,cohesion,shortest contact [s],limit [s],"
    "limited by,auto [s],auto at fewest steps [s],bounded up to [s],silent up to [s],"
    "auto,auto at fewest steps,limit,what is wrong first";

std::string verdict(const StepTrial& t) { return t.blewUp ? "blows up" : t.alarmed ? "alarm" : "sound"; }

std::string plain(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  return text;
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> row;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) row.push_back(cell);
  return row;
}

/// Lines of the table that an earlier call has written.
std::vector<std::string> formerLines(const fs::path& file, std::int64_t seed) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  std::string line;
  if (!in || !std::getline(in, line)) return lines;
  if (line != kColumns)
    throw base::InputError(file.string() +
                           ": another version has written this file; repeat the command without --resume");
  while (std::getline(in, line)) {
    const std::vector<std::string> row = cells(line);
    if (row.size() < 2 || row[1] != std::to_string(seed))
      throw base::InputError(fmt::format(
          "{}: contains scenes of seed {}; set --seed to this value, or repeat the command without --resume",
          file.string(), row.size() < 2 ? "?" : row[1]));
    lines.push_back(line);
  }
  return lines;
}

struct Spread {
  std::vector<double> values;
  std::string text() const {
    std::vector<double> v = values;
    std::sort(v.begin(), v.end());
    const auto below = static_cast<int>(std::count_if(v.begin(), v.end(), [](double x) { return x < 0.25; }));
    return fmt::format("{:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>14}", v.front(), v[v.size() / 10], jobs::medianOf(v),
                       v.back(), below);
  }
};

} // namespace

std::string marginsHeader() { return kColumns; }

std::string marginsLine(const StepMargins& m) {
  const RandomScene& s = m.scene;
  std::string why;
  for (const StepTrial* t : {&m.atAutomatic, &m.atCoarse, &m.atLimit})
    if (why.empty()) why = t->why;
  return fmt::format("{},{{}},{},{},{},{},{:.4g},{:.4g},{},{},{:.6g},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{},{}",
                     s.number, s.kind, s.grains, s.hertz ? "hertz" : "linear", s.single ? "single" : "double",
                     s.restitution, s.friction, s.rolls ? 1 : 0, s.sticks ? 1 : 0, m.contact, m.limit,
                     plain(m.limiting), m.automatic, m.coarse, m.bounded, m.silent, verdict(m.atAutomatic),
                     verdict(m.atCoarse), verdict(m.atLimit), plain(why));
}

std::string marginsSummary(const std::vector<std::string>& lines, bool& sound) {
  std::map<std::string, std::array<Spread, 3>> bounded, silent;
  std::array<int, 3> blownUp{}, alarmed{};
  for (const std::string& line : lines) {
    const std::vector<std::string> row = cells(line);
    const auto number = [&row](std::size_t i) { return std::stod(row.at(i)); };
    const std::array<double, 3> steps{number(13), number(14), number(11)};
    for (std::size_t k = 0; k < 3; ++k) {
      for (const std::string& kind : {row[2], std::string("all")}) {
        // A longest step of 0 means that no sound step was found.
        bounded[kind][k].values.push_back(number(15) > 0 ? steps[k] / number(15) : INFINITY);
        silent[kind][k].values.push_back(number(16) > 0 ? steps[k] / number(16) : INFINITY);
      }
      blownUp[k] += row.at(17 + k) == "blows up", alarmed[k] += row.at(17 + k) != "sound";
    }
  }
  static const std::array<const char*, 3> kSteps{"auto", "auto, fewest steps per contact", "limit"};
  std::string text;
  for (const auto& [title, of] :
       {std::pair{"longest step without blow-up", &bounded}, std::pair{"longest step without alarm", &silent}}) {
    text += fmt::format("\nstep / {}\n  {:<10} {:<30} {:>8} {:>8} {:>8} {:>8} {:>14}\n", title, "", "", "min", "10 %",
                        "median", "max", "below 1/4");
    for (const auto& [kind, spreads] : *of)
      for (std::size_t k = 0; k < 3; ++k)
        text += fmt::format("  {:<10} {:<30} {}\n", kind, kSteps[k], spreads[k].text());
  }
  text += fmt::format("\n{} scenes\n", lines.size());
  for (std::size_t k = 0; k < 3; ++k)
    text += fmt::format("  at {:<30} {} blow up, {} raise an alarm\n", kSteps[k], blownUp[k], alarmed[k]);
  sound = alarmed[0] == 0 && blownUp[2] == 0;
  return text;
}

void studyRandomStability(const RandomStability& command, const jobs::StudyPlace& place) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  jobs::StudyPlace where = place;
  where.force = place.force || command.resume;
  const fs::path folder = jobs::beginStudy("stability", where), table = folder / "random.csv";
  const support::StopSignals signals;
  std::vector<std::string> lines;
  if (command.resume) lines = formerLines(table, command.seed);
  fmt::print("          {} random scenes with seed {}; accuracy of the longest steps {:g} %\n", command.scenes,
             command.seed, 100 * kAccuracy);
  support::Progress progress("running");
  const auto write = [&] {
    std::string text = std::string(kColumns) + "\n";
    for (const std::string& line : lines) text += line + "\n";
    support::replaceTextFile(table, text);
  };
  for (int k = static_cast<int>(lines.size()); k < command.scenes; ++k) {
    progress.update(static_cast<double>(k) / command.scenes, fmt::format("scene {}", k));
    const RandomScene scene = randomScene(static_cast<std::uint64_t>(command.seed), k);
    lines.push_back(fmt::format(fmt::runtime(marginsLine(stepMargins(scene, kAccuracy))), command.seed));
    write();
  }
  lines.resize(static_cast<std::size_t>(command.scenes));
  progress.finish(fmt::format("{} scenes", lines.size()));
  bool sound = false;
  fmt::print("{}", marginsSummary(lines, sound));
  jobs::writeStudyOrigin(folder, "stability", std::chrono::duration<double>(Clock::now() - begin).count(),
                         {{"random", command.scenes}, {"seed", command.seed}});
  output::drawPicture("study_random_stability.py", {table}, folder / "random.png");
  fmt::print("tables    {}\n", folder.string());
  if (!sound)
    throw base::SimulationError(
        "a random scene raises an alarm at its automatic step or blows up at its step limit (see the table above)");
}

} // namespace grouser::studies
