// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/bench/report.hpp"

#include "runs/support/build_info.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace grouser::bench {

using Json = nlohmann::ordered_json;

Json benchOrigin(const char* bench, const base::Exec& exec) {
  const support::BuildInfo build = support::buildInfo();
  Json json;
  json["bench"] = bench;
  json["device"] = base::describe(exec);
  json["machine"] = support::machineText();
  json["version"] = build.version;
  json["commit"] = build.commit;
  json["compiler"] = build.compiler;
  json["cuda"] = build.cuda;
  fmt::print("device    {}\nmachine   {}\nprogram   grouser {}, commit {}, {}{}\n", base::describe(exec),
             support::machineText(), build.version, build.commit, build.compiler,
             build.cuda.empty() ? "" : ", CUDA " + build.cuda);
  std::fflush(stdout);
  return json;
}

void writeBench(const Json& json, const std::string& path, const base::Comm& comm) {
  if (path.empty() || !comm.first()) return;
  support::writeTextFile(path, json.dump(2) + '\n', "--json");
  fmt::print("json      {}\n", path);
}

} // namespace grouser::bench
