// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/report_command.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "runs/campaigns/sweeps/run_figures.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/locations.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/output_place.hpp"
#include "runs/support/private_folder.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

namespace grouser::commands {

namespace fs = std::filesystem;

namespace {

void checkPlaces(const ReportCommand& command, const fs::path& file) {
  std::error_code error;
  if (!fs::is_directory(command.folder, error))
    throw base::InputError(fmt::format("{}: is not a folder; specify the results folder of a run, sweep, check, set of "
                                       "events, soil test or calibration",
                                       command.folder));
  if (fs::is_directory(file, error))
    throw base::InputError(fmt::format("--out {}: is a folder; specify a file", file.string()));
  if (!command.force && fs::exists(file, error))
    throw base::InputError(fmt::format("{}: already exists; overwrite it with --force, or choose another file with "
                                       "--out",
                                       file.string()));
  support::requireFile(file, "--out");
  if (!command.film.empty())
    if (const std::string fault = base::inputFault(command.film); !fault.empty())
      throw base::InputError(fmt::format("--film {}{}; specify the film of a run", command.film, fault));
}

} // namespace

void reportCommand(const ReportCommand& command) {
  const fs::path folder = command.folder;
  const fs::path file = command.file.empty() ? folder / "report.html" : fs::path(command.file);
  checkPlaces(command, file);
  const fs::path script = support::shareFolder() / "runs" / "report" / "report.py";
  std::error_code missing;
  if (!fs::exists(script, missing))
    throw base::InputError(
        fmt::format("{} is missing; set GROUSER_SHARE to the folder that contains runs/report", script.string()));
  const support::PrivateFolder passed("grouser_report");
  const fs::path figures = passed.path() / "figures.json"; // data of the program for the script
  support::replaceTextFile(
      figures, fs::exists(folder / "results.h5", missing) ? support::jsonText(sweeps::runFigures(folder)) : "{}");
  std::vector<std::string> words = {folder.string(), file.string(),
                                    "--figures",     figures.string(),
                                    "--frames",      std::to_string(command.frames),
                                    "--grains",      std::to_string(command.grains),
                                    "--program",     fs::read_symlink("/proc/self/exe").string()};
  if (!command.film.empty()) words.insert(words.end(), {"--film", command.film});
  const support::StopSignals signals; // a signal from the terminal also ends the script
  const support::CallOutcome outcome = output::callPython(script, words);
  if (const int signal = support::StopSignals::received(); signal && outcome.status != 0)
    throw support::Stopped(signal,
                           fmt::format("stopped by {}; no report was written", support::StopSignals::name(signal)),
                           support::Stopped::Left::nothing);
  constexpr int kWrongInput = 2, kNotWritten = 4;
  if (outcome.status == kWrongInput || outcome.status == output::kMissingPackage)
    throw base::InputError(support::lastLine(outcome.output));
  if (!outcome.started)
    throw base::InputError(
        fmt::format("a report requires Python: {}; install python3, python3-numpy and python3-h5py", outcome.output));
  if (outcome.status == kNotWritten) throw support::NotWritten(support::lastLine(outcome.output));
  if (outcome.status < 0) // a signal
    throw base::InputError(fmt::format("{}: the results cannot be read ({}): a file is damaged, or the memory is full; "
                                       "run the scene again, or restore the files from a copy",
                                       folder.string(), support::lastLine(outcome.output)));
  if (outcome.status != 0)
    throw std::logic_error(fmt::format("{}: {}", script.string(), support::lastLine(outcome.output)));
  fmt::print("{}", outcome.output);
}

} // namespace grouser::commands
