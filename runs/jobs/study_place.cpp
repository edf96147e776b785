// SPDX-License-Identifier: BSD-3-Clause
#include "runs/jobs/study_place.hpp"

#include "runs/output/output.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grouser::jobs {

namespace fs = std::filesystem;

std::filesystem::path beginStudy(const std::string& name, const StudyPlace& place) {
  fs::path folder = place.folder.empty() ? fs::path("out") / ("study_" + name) : fs::path(place.folder);
  output::checkOutputFolder(folder, place.force);
  fs::create_directories(folder);
  fmt::print("study     {}: commit {}, {}\n", name, support::buildInfo().commit, support::machineText());
  std::fflush(stdout);
  return folder;
}

void writeStudyOrigin(const std::filesystem::path& folder, const std::string& name, double seconds,
                      const nlohmann::ordered_json& more) {
  const support::BuildInfo build = support::buildInfo();
  nlohmann::ordered_json json;
  json["study"] = name;
  json["machine"] = support::machineText();
  json["version"] = build.version;
  json["commit"] = build.commit;
  json["compiler"] = build.compiler;
  json["wall_s"] = seconds;
  json.update(more);
  support::writeTextFile(folder / "study.json", support::jsonText(json, 2) + "\n", "--out");
}

MeanError meanOf(const std::vector<double>& values) {
  MeanError m;
  const double n = static_cast<double>(values.size());
  for (const double v : values) m.mean += v / n;
  double squares = 0;
  for (const double v : values) squares += (v - m.mean) * (v - m.mean);
  if (values.size() > 1) m.error = std::sqrt(squares / (n - 1) / n);
  return m;
}

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? 0 : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

void stopStudyOnRequest() {
  if (const int signal = support::StopSignals::received())
    throw support::Stopped(signal, fmt::format("stopped by {}", support::StopSignals::name(signal)));
}

} // namespace grouser::jobs
