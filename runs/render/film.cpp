// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/film.hpp"

#include "base/error.hpp"
#include "runs/support/not_written.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

namespace grouser::render {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, 3> kEndings = {".mp4", ".mkv", ".mov"};

/// Where a program of this name lies on the PATH; empty where there is none.
fs::path programOnPath(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::stringstream folders(path ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (fs::path file = fs::path(folder) / name; !folder.empty() && access(file.c_str(), X_OK) == 0) return file;
  return {};
}

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string lastLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

/// Ignores SIGPIPE for its life: ffmpeg may end before it has read everything.
class PipeMayBreak {
public:
  PipeMayBreak() : former_(std::signal(SIGPIPE, SIG_IGN)) {}
  ~PipeMayBreak() { std::signal(SIGPIPE, former_); }
  PipeMayBreak(const PipeMayBreak&) = delete;
  PipeMayBreak& operator=(const PipeMayBreak&) = delete;

private:
  void (*former_)(int);
};

bool send(int pipe, const std::string& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t n = write(pipe, bytes.data() + sent, bytes.size() - sent);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) sent += static_cast<std::size_t>(n);
  }
  return true;
}

/// Starts `words` with the read end of a pipe as its input and `log` for its output; returns process and write end.
std::pair<pid_t, int> start(std::vector<std::string> words, const fs::path& log) {
  std::vector<char*> arguments;
  for (std::string& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw base::DeviceError(fmt::format("no pipe to ffmpeg: {}", std::strerror(errno)));
  const pid_t process = fork();
  if (process == 0) {
    const int output = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(ends[0], STDIN_FILENO), dup2(output, STDOUT_FILENO), dup2(output, STDERR_FILENO);
    std::signal(SIGPIPE, SIG_DFL);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  close(ends[0]);
  return {process, ends[1]};
}

} // namespace

void checkFilm(const fs::path& film) {
  if (std::find(kEndings.begin(), kEndings.end(), film.extension().string()) == kEndings.end())
    throw base::InputError(fmt::format("--film {}: its name must end with .mp4, .mkv or .mov", film.string()));
  std::error_code error;
  if (const fs::path folder = fs::absolute(film).parent_path(); !fs::is_directory(folder, error))
    throw base::InputError(fmt::format("--film {}: there is no folder {}", film.string(), folder.string()));
  checkFilmProgram(fmt::format("--film {}", film.string()));
}

void checkFilmProgram(const std::string& word) {
  if (programOnPath("ffmpeg").empty())
    throw base::InputError(fmt::format("{}: a film needs the program ffmpeg, which is not installed; install the "
                                       "package ffmpeg, or leave {} out for pictures alone",
                                       word, word.substr(0, word.find(' '))));
}

void makeFilm(const std::vector<fs::path>& pictures, double framesPerSecond, const fs::path& film) {
  // Its last ending tells ffmpeg the format.
  const fs::path part = film.parent_path() / fmt::format(".{}.part{}", film.stem().string(), film.extension().string());
  const fs::path log = film.parent_path() / fmt::format(".{}.log", film.stem().string());
  const std::string rate = fmt::format("{:.6g}", framesPerSecond);
  const PipeMayBreak guard;
  // The picture type that every player knows halves the colours' resolution: sizes must be even, or a row is added.
  const auto [process, pipe] = start({programOnPath("ffmpeg").string(),
                                      "-y",
                                      "-loglevel",
                                      "error",
                                      "-f",
                                      "image2pipe",
                                      "-framerate",
                                      rate,
                                      "-c:v",
                                      "png",
                                      "-i",
                                      "-",
                                      "-vf",
                                      "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                      "-c:v",
                                      "libx264",
                                      "-preset",
                                      "medium",
                                      "-crf",
                                      "18",
                                      "-pix_fmt",
                                      "yuv420p",
                                      "-movflags",
                                      "+faststart",
                                      part.string()},
                                     log);
  if (process < 0) throw base::DeviceError(fmt::format("ffmpeg could not be started: {}", std::strerror(errno)));
  for (const fs::path& picture : pictures)
    if (!send(pipe, contents(picture))) break;
  close(pipe);
  int status = 0;
  waitpid(process, &status, 0);
  const std::string words = lastLine(contents(log));
  std::error_code error;
  fs::remove(log, error);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    fs::remove(part, error);
    throw support::NotWritten(fmt::format("{}: ffmpeg could not make the film: {}", film.string(),
                                          words.empty() ? "it was ended by a signal" : words));
  }
  fs::rename(part, film);
}

} // namespace grouser::render
