// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/film.hpp"

#include "base/error.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/program_call.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

namespace grouser::render {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, 3> kEndings = {".mp4", ".mkv", ".mov"};

bool isOnPath(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::stringstream folders(path ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (!folder.empty() && access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

void checkFilm(const fs::path& film) {
  if (std::find(kEndings.begin(), kEndings.end(), film.extension().string()) == kEndings.end())
    throw base::InputError(fmt::format("--film {}: the file name must end in .mp4, .mkv or .mov", film.string()));
  std::error_code error;
  if (const fs::path folder = fs::absolute(film).parent_path(); !fs::is_directory(folder, error))
    throw base::InputError(fmt::format("--film {}: folder {} does not exist", film.string(), folder.string()));
  checkFilmProgram(fmt::format("--film {}", film.string()));
}

void checkFilmProgram(const std::string& word) {
  if (!isOnPath("ffmpeg"))
    throw base::InputError(
        fmt::format("{}: films require ffmpeg, which is not installed; install the package ffmpeg, or remove {}", word,
                    word.substr(0, word.find(' '))));
}

void makeFilm(const std::vector<fs::path>& pictures, double framesPerSecond, const fs::path& film) {
  // ffmpeg derives the format from the last extension.
  const fs::path part = film.parent_path() / fmt::format(".{}.part{}", film.stem().string(), film.extension().string());
  const fs::path log = film.parent_path() / fmt::format(".{}.log", film.stem().string());
  const std::string rate = fmt::format("{:.6g}", framesPerSecond);
  // The widely supported yuv420p requires even sizes: a row or column is added if necessary.
  const std::vector<std::string> words = {
      "ffmpeg",  "-y",        "-loglevel",  "error",      "-f",   "image2pipe", "-framerate",
      rate,      "-c:v",      "png",        "-i",         "-",    "-vf",        "pad=ceil(iw/2)*2:ceil(ih/2)*2",
      "-c:v",    "libx264",   "-preset",    "medium",     "-crf", "18",         "-pix_fmt",
      "yuv420p", "-movflags", "+faststart", part.string()};
  support::ChildProcess ffmpeg({.words = words, .log = log, .input = true});
  for (const fs::path& picture : pictures)
    if (!ffmpeg.write(contents(picture))) break;
  const support::ProcessEnd end = ffmpeg.wait();
  const std::string why = support::lastLine(contents(log));
  std::error_code error;
  fs::remove(log, error);
  if (end.status != 0) {
    fs::remove(part, error);
    throw support::NotWritten(fmt::format("{}: ffmpeg failed: {}", film.string(), why.empty() ? end.text() : why));
  }
  fs::rename(part, film);
}

} // namespace grouser::render
