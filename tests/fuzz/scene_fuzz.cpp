// SPDX-License-Identifier: BSD-3-Clause
// Feeds damaged scenes to the parser. It must load any bytes, or reject them with one InputError that
// starts with file and line; a loaded scene must survive writing as the resolved copy and reading again.
//
//   grouser_fuzz_scene [--seconds N] [--seed S] [--cases N] [--show] CORPUS...
//
// CORPUS: files, or folders with *.toml. The mutations follow from the seed and the number of the case, so
// that `--seed S --first CASE --cases 1` repeats one. With clang and GROUSER_LIBFUZZER libFuzzer generates the inputs.
#include "base/error.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/load_scene.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace grouser;

constexpr const char* kName = "fuzz.toml";

/// Ends the program, and so the fuzzing, at the first fault.
[[noreturn]] void fault(std::string_view input, const std::string& what) {
  std::ofstream("fuzz_failure.toml", std::ios::binary) << input;
  std::fprintf(stderr, "fault: %s\nthe input is kept in fuzz_failure.toml\n", what.c_str());
  std::abort();
}

/// "fuzz.toml:12: ..." or "fuzz.toml:12:3: ..."; an empty scene has no line.
bool namesLine(const std::string& message) {
  const std::string head = std::string(kName) + ":";
  if (message.rfind(head, 0) != 0 || message.find('\n') != std::string::npos) return false;
  return std::isdigit(static_cast<unsigned char>(message[head.size()])) ||
         message.find("nothing to simulate") != std::string::npos;
}

/// The error message; empty if the scene was loaded.
std::string tryScene(std::string_view input) {
  try {
    const scene::Scene scene = setup::parseScene(input, kName);
    const std::string resolved = scene::resolvedToml(scene);
    try {
      if (scene::resolvedToml(setup::parseScene(resolved, kName)) != resolved)
        fault(input, "the resolved copy reads back as another scene");
    } catch (const std::exception& error) {
      fault(input, std::string("the resolved copy is refused: ") + error.what() + "\n" + resolved);
    }
    return "";
  } catch (const base::InputError& error) {
    if (!namesLine(error.what())) fault(input, std::string("no file and line: ") + error.what());
    return error.what();
  } catch (const std::exception& error) {
    fault(input, std::string("is no InputError: ") + error.what());
  }
}

} // namespace

#ifdef GROUSER_LIBFUZZER

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tryScene({reinterpret_cast<const char*>(data), size});
  return 0;
}

#else

// Called by the sanitizers before they end the program; absent without them.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace {

std::string current; // only for the death callback

void keepCurrent() { std::ofstream("fuzz_failure.toml", std::ios::binary) << current; }

/// Creates damaged scenes from valid ones.
class Mutator {
public:
  Mutator(std::vector<std::string> corpus, std::uint64_t seed, std::uint64_t number)
      : corpus_(std::move(corpus)), random_(seed * 0x9E3779B97F4A7C15ull + number) {}

  std::string make() {
    std::string text = corpus_[below(corpus_.size())];
    for (std::size_t n = 1 + below(4); n > 0; --n) change(text);
    return text;
  }

private:
  std::size_t below(std::size_t n) { return n > 0 ? random_() % n : 0; } // the same for every library

  std::size_t lineStart(const std::string& text) {
    const std::size_t at = text.rfind('\n', below(text.size() + 1));
    return at == std::string::npos ? 0 : at + 1;
  }
  static std::size_t lineEnd(const std::string& text, std::size_t from) {
    const std::size_t at = text.find('\n', from);
    return at == std::string::npos ? text.size() : at + 1;
  }

  /// Replaces the value after a "=".
  void changeValue(std::string& text) {
    static constexpr std::array kValues = {"0",
                                           "-1",
                                           "1e308",
                                           "-1e308",
                                           "1e-320",
                                           "nan",
                                           "-inf",
                                           "true",
                                           "\"\"",
                                           "[]",
                                           "[1]",
                                           "[1, 2]",
                                           "[1,2,3]",
                                           "[[1],[2]]",
                                           "{}",
                                           "{a = 1}",
                                           "\"x\"",
                                           "1e9",
                                           "0.5",
                                           "\"auto\"",
                                           "7",
                                           "1979-05-27",
                                           "0x7F",
                                           "07:32:00",
                                           "[\"a\", 1]",
                                           "9223372036854775807",
                                           "-9223372036854775808",
                                           "[nan, inf]",
                                           "\"\\u0000\"",
                                           "\"world\"",
                                           "\"soil\"",
                                           "[\"world\", \"world\"]"};
    const std::size_t start = lineStart(text), end = lineEnd(text, start);
    const std::size_t equals = text.find('=', start);
    if (equals == std::string::npos || equals >= end) return;
    text.replace(equals + 1, end - equals - 1, std::string(" ") + kValues[below(kValues.size())] + "\n");
  }

  void change(std::string& text) {
    static constexpr std::array kPieces = {"[run]\n",
                                           "[terrain]\n",
                                           "[[grain]]\n",
                                           "[[body]]\n",
                                           "[[joint]]\n",
                                           "[vehicle]\n",
                                           "[[source]]\n",
                                           "[material.a]\n",
                                           "[contact.\"a|b\"]\n",
                                           "version = 1\n",
                                           "a.b = 1\n",
                                           "[[plane]]\n",
                                           "[[drive]]\n",
                                           "[driver.table]\n",
                                           "[[bushing]]\n",
                                           "\xEF\xBB\xBF",
                                           "\xFF\xFE",
                                           "\"\"\"",
                                           "'''",
                                           "# \x01\n",
                                           "[[[",
                                           "]]",
                                           "= =",
                                           "\r",
                                           "\t",
                                           "\\"};
    switch (below(9)) {
    case 0: // one byte
      if (!text.empty()) text[below(text.size())] = static_cast<char>(below(256));
      break;
    case 1: // a line removed
      if (const std::size_t at = lineStart(text); at < text.size()) text.erase(at, lineEnd(text, at) - at);
      break;
    case 2: { // a line duplicated elsewhere
      const std::size_t at = lineStart(text);
      const std::string line = text.substr(at, lineEnd(text, at) - at);
      text.insert(lineStart(text), line);
      break;
    }
    case 3: // truncated
      text.resize(below(text.size() + 1));
      break;
    case 4:
      text.insert(lineStart(text), kPieces[below(kPieces.size())]);
      break;
    case 5: { // the end of another scene
      const std::string& other = corpus_[below(corpus_.size())];
      text = text.substr(0, lineStart(text)) + other.substr(below(other.size() + 1));
      break;
    }
    case 6: // some bytes removed
      if (const std::size_t at = below(text.size()); at < text.size()) text.erase(at, 1 + below(8));
      break;
    default: // the most common human mistake
      changeValue(text);
    }
  }

  std::vector<std::string> corpus_;
  std::mt19937_64 random_; // specified by the standard to the bit
};

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> readCorpus(const std::vector<fs::path>& places) {
  std::vector<fs::path> files;
  for (const fs::path& place : places) {
    if (fs::is_regular_file(place)) files.push_back(place);
    if (fs::is_directory(place))
      for (const auto& entry : fs::recursive_directory_iterator(place))
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> corpus;
  for (const fs::path& file : files) corpus.push_back(contents(file));
  return corpus;
}

/// A message without names and numbers: one for each kind of error.
std::string kindOf(const std::string& message) {
  std::string kind;
  for (const char c : message.substr(message.find(": ") + 2))
    if (!std::isdigit(static_cast<unsigned char>(c))) kind += c;
  return kind.substr(0, 60);
}

} // namespace

int main(int argc, char** argv) {
  double seconds = 2;
  std::uint64_t seed = 1, first = 0, cases = ~std::uint64_t{0};
  bool show = false;
  std::vector<fs::path> places;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&] { return i + 1 < argc ? argv[++i] : "0"; };
    if (word == "--seconds")
      seconds = std::atof(value());
    else if (word == "--seed")
      seed = std::strtoull(value(), nullptr, 10);
    else if (word == "--first")
      first = std::strtoull(value(), nullptr, 10);
    else if (word == "--cases")
      cases = std::strtoull(value(), nullptr, 10);
    else if (word == "--show")
      show = true;
    else
      places.emplace_back(word);
  }
  const std::vector<std::string> corpus = readCorpus(places);
  if (corpus.empty()) {
    std::fprintf(stderr,
                 "usage: grouser_fuzz_scene [--seconds N] [--seed S] [--first CASE] [--cases N] [--show] CORPUS...\n");
    return 2;
  }
  if (__sanitizer_set_death_callback) __sanitizer_set_death_callback(keepCurrent);
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  std::uint64_t done = 0, loaded = 0;
  std::map<std::string, std::string> kinds;
  for (; done < cases && std::chrono::duration<double>(Clock::now() - start).count() < seconds; ++done) {
    current = Mutator(corpus, seed, first + done).make();
    const std::string message = tryScene(current);
    if (message.empty())
      ++loaded;
    else
      kinds.emplace(kindOf(message), message);
  }
  std::printf("%llu broken scenes of %zu sound ones: %llu loaded, the others refused in %zu ways; no fault\n",
              static_cast<unsigned long long>(done), corpus.size(), static_cast<unsigned long long>(loaded),
              kinds.size());
  if (show)
    for (const auto& [kind, message] : kinds) std::printf("%s\n", message.c_str());
  return done > 0 ? 0 : 1;
}

#endif
