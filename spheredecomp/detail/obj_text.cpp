// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/detail/obj_text.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <vector>

namespace grouser::spheredecomp::detail {

namespace {

using Fail = std::function<void(const std::string&)>;

/// True if the whole word is a number; like assimp, accepts a decimal comma.
bool isNumber(std::string word, double& value) {
  std::replace(word.begin(), word.end(), ',', '.');
  const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

/// Checks a vertex: assimp skips a vertex with another count of numbers, and ignores numbers that begin with a point.
void checkVertex(std::istream& words, const Fail& fail) {
  std::vector<double> values;
  for (std::string word; words >> word;) {
    values.push_back(0);
    if (!isNumber(word, values.back())) fail(fmt::format("a vertex has \"{:.40}\" instead of a number", word));
    if (word.front() == '.') fail(fmt::format("a vertex has the number \"{0:.40}\"; write 0{0:.40}", word));
  }
  if (values.size() < 3) fail(fmt::format("a vertex has {} of its 3 coordinates", values.size()));
  if (values.size() == 4 && values[3] != 1)
    fail(fmt::format("a vertex has the weight {:g}, which only curves use; remove it", values[3]));
  if (values.size() == 5 || values.size() > 6)
    fail(fmt::format("a vertex has {} numbers; it must have 3 (x y z), 4 (and a weight of 1) or 6 (and a colour)",
                     values.size()));
}

/// Checks how a line begins: assimp requires v or f in the first column, and skips all other lines.
void checkLine(const std::string& line, const Fail& fail) {
  std::istringstream words(line.substr(0, line.find('#')));
  std::string word;
  if (!(words >> word)) return;
  const bool hasMark = word.starts_with("\xEF\xBB\xBF");
  const char kind = hasMark && word.size() == 4 ? word[3] : word.size() == 1 ? word[0] : ' ';
  if (std::string("vVfF").find(kind) == std::string::npos) return;
  if (hasMark) fail(fmt::format("a byte-order mark precedes \"{}\"; save the file without this mark", kind));
  if (line.front() != kind || kind == 'V' || kind == 'F')
    fail(fmt::format("the line is indented or in upper case; it must begin with \"{}\"", kind == 'V'   ? 'v'
                                                                                         : kind == 'F' ? 'f'
                                                                                                       : kind));
  if (kind == 'v') checkVertex(words, fail);
}

/// Checks a material library, which assimp opens if it exists: a FIFO would block it.
void checkLibrary(const std::string& line, const std::string& path, const Fail& fail) {
  if (!line.starts_with("mtllib")) return;
  const std::size_t begin = line.find_first_not_of(" \t", line.find_first_of(" \t")); // after the keyword
  if (begin == std::string::npos) return;
  const std::string name = line.substr(begin, line.find_last_not_of(" \t\r") + 1 - begin);
  std::error_code ignored;
  if (const auto library = std::filesystem::path(path).parent_path() / name; std::filesystem::exists(library, ignored))
    if (const std::string fault = base::inputFault(library); !fault.empty())
      fail(fmt::format("the material library {:.200}{}", name, fault));
}

} // namespace

void checkObj(const std::string& path) {
  std::ifstream in(path);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const Fail fail = [&path, at = number](const std::string& what) {
      throw base::InputError(fmt::format("{}:{}: {}; export the mesh again, or correct the line", path, at, what));
    };
    if (const std::size_t end = line.find('\r'); end < line.size() - 1)
      fail("lines end in bare carriage returns; save the file with Unix or Windows line endings");
    const auto continues = [&line] { return line.ends_with('\\') || line.ends_with("\\\r"); };
    for (std::string next; continues() && std::getline(in, next); ++number)
      line = line.substr(0, line.rfind('\\')) + ' ' + next;
    checkLine(line, fail);
    checkLibrary(line, path, fail);
  }
}

} // namespace grouser::spheredecomp::detail
