// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/forecast.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/progress.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdint>

namespace grouser::forecast {

namespace {

constexpr double kProbed = 1.5, kKept = 2,
                 kTypical = 3; // factors of accuracy [-]: docs/large_runs.md#forecast

std::string time(double seconds) {
  return seconds < 0.095  ? fmt::format("{:.2f} s", seconds)
         : seconds < 9.95 ? fmt::format("{:.1f} s", seconds)
                          : support::Progress::duration(seconds);
}

const char* nameOf(Source source) {
  return source == Source::probed ? "probed" : source == Source::kept ? "kept" : "typical";
}

std::string partsText(const char* title, const std::vector<ForecastPart>& parts) {
  if (parts.empty()) return "";
  std::string text = fmt::format("  {:<24} {}\n", title, time(Forecast::sum(parts)));
  for (const ForecastPart& p : parts)
    text += fmt::format("    {:<22} {:<12}{}{}\n", p.name, time(p.seconds), nameOf(p.source),
                        p.how.empty() ? "" : " (" + p.how + ")");
  return text;
}

std::string bytes(double b) {
  return b >= 1e9 ? fmt::format("{:.3g} GB", 1e-9 * b) : fmt::format("{:.3g} MB", 1e-6 * b);
}

} // namespace

double Forecast::accuracy(Source source) const {
  return source == Source::typical ? kTypical : probed ? kProbed : kKept;
}

double Forecast::bound(int sign) const {
  double all = 0;
  for (const auto* parts : {&preparation, &steps, &output})
    for (const ForecastPart& p : *parts) all += p.seconds * (sign < 0 ? 1 / accuracy(p.source) : accuracy(p.source));
  return all;
}

double Forecast::sum(const std::vector<ForecastPart>& parts) {
  double all = 0;
  for (const ForecastPart& p : parts) all += p.seconds;
  return all;
}

std::string forecastText(const Forecast& f) {
  std::string text = f.cuts.empty() ? "" : "\nmeshes as spheres\n";
  for (const spheredecomp::CutReport& cut : f.cuts) text += fmt::format("  {}\n", spheredecomp::protrusionLine(cut));
  for (const spheredecomp::CutReport& cut : f.cuts)
    if (const std::string warning = spheredecomp::protrusionWarning(cut); !warning.empty())
      text += fmt::format("\nWARNING: {}\n", warning);
  text += fmt::format("\nprediction on {} ({} probe, {})\n", f.onDevice, f.probed ? "long" : "short", time(f.spent));
  text += partsText("preparation", f.preparation);
  text += partsText("steps", f.steps);
  text += partsText("output", f.output);
  if (f.warning.empty())
    text += fmt::format("  {:<24} {} ({} to {})\n", "total", time(f.total()), time(f.bound(-1)), time(f.bound(1)));
  if (f.probed)
    text += fmt::format("  {:<24} within a factor of {:g}\n", "accuracy", f.accuracy(Source::probed));
  else
    text += fmt::format("  {:<24} within a factor of {:g} (probed, kept) or {:g} (typical); measure all parts for this "
                        "and later plans with grouser plan --probe\n",
                        "accuracy", f.accuracy(Source::kept), f.accuracy(Source::typical));
  text += fmt::format("  {:<24} about {}\n", "process memory", bytes(f.process));
  if (f.device > 0) text += fmt::format("  {:<24} about {}\n", "GPU memory", bytes(f.device));
  text += fmt::format("  {:<24} about {}{}\n", "disk space", bytes(f.disk),
                      f.diskSpeed > 0 ? fmt::format(", written at {}/s", bytes(f.diskSpeed)) : "");
  if (!f.warning.empty()) text += fmt::format("\nWARNING: {}\n", f.warning);
  return text;
}

std::string forecastJson(const Forecast& f) {
  nlohmann::ordered_json json;
  json["machine"] = support::machineText(), json["commit"] = support::buildInfo().commit;
  json["device"] = f.onDevice;
  json["total_s"] = f.total(), json["least_s"] = f.bound(-1), json["most_s"] = f.bound(1);
  json["probe_s"] = f.spent, json["long_probe"] = f.probed;
  const auto put = [&json](const char* name, const std::vector<ForecastPart>& parts) {
    json[name]["total_s"] = Forecast::sum(parts);
    for (const ForecastPart& p : parts) json[name][p.name] = p.seconds, json["sources"][p.name] = nameOf(p.source);
  };
  put("preparation", f.preparation), put("steps", f.steps), put("output", f.output);
  json["process_bytes"] = f.process, json["device_bytes"] = f.device, json["disk_bytes"] = f.disk;
  json["checkpoint_bytes"] = static_cast<std::int64_t>(f.checkpoint);
  if (!f.warning.empty()) json["warning"] = f.warning;
  return support::jsonText(json, 2) + "\n";
}

} // namespace grouser::forecast
