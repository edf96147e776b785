// SPDX-License-Identifier: BSD-3-Clause
#include "runs/studies/common.hpp"

#include "runs/output/output.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace grouser::studies {

namespace fs = std::filesystem;

std::filesystem::path beginStudy(const std::string& name, const StudyPlace& place) {
  const fs::path folder = place.folder.empty() ? fs::path("out") / ("study_" + name) : fs::path(place.folder);
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
  support::writeTextFile(folder / "study.json", json.dump(2) + "\n", "--out");
}

std::string Slope::text() const { return exists() ? fmt::format("{:.2f} +- {:.2f}", value, halfWidth) : "-"; }

Slope linearSlope(const std::vector<double>& x, const std::vector<double>& y) {
  // Two-sided 95 % quantiles of Student's distribution for 1, 2, ... degrees of freedom.
  constexpr std::array kStudent = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                                   2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120};
  Slope slope;
  slope.points = static_cast<int>(x.size());
  if (!slope.exists()) return slope;
  const double n = static_cast<double>(x.size()), meanX = meanOf(x).mean, meanY = meanOf(y).mean;
  double xx = 0, xy = 0, rest = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    xx += (x[i] - meanX) * (x[i] - meanX), xy += (x[i] - meanX) * (y[i] - meanY);
  slope.value = xy / xx;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double off = y[i] - meanY - slope.value * (x[i] - meanX);
    rest += off * off;
  }
  const std::size_t freedom = x.size() - 2;
  const double quantile =
      freedom <= kStudent.size() ? kStudent[freedom - 1] : 1.96 + 2.4 / static_cast<double>(freedom);
  slope.halfWidth = quantile * std::sqrt(rest / (n - 2) / xx);
  return slope;
}

Slope logSlope(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> logX, logY;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0 && y[i] > 0)) continue;
    logX.push_back(std::log(x[i])), logY.push_back(std::log(y[i]));
  }
  return linearSlope(logX, logY);
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

void stopStudyIfAsked() {
  if (const int signal = support::StopSignals::received()) throw support::Stopped(signal, "the study was stopped");
}

} // namespace grouser::studies
