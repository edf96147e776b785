// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/detail/obj_text.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <vector>

namespace grouser::spheredecomp::detail {

namespace {

/// Whether a word is a number to its end; with a decimal comma too, as the reader takes it.
bool isNumber(std::string word, double& value) {
  std::replace(word.begin(), word.end(), ',', '.');
  const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

} // namespace

void checkObjVertices(const std::string& path) {
  std::ifstream in(path);
  std::string line, word;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    if (!(words >> word) || word != "v") continue;
    std::vector<double> values;
    const auto fail = [&](const std::string& what) {
      throw base::InputError(fmt::format("{}:{}: {}; export the mesh again, or correct the line", path, number, what));
    };
    while (words >> word && word != "\\") {
      values.push_back(0);
      if (!isNumber(word, values.back())) fail(fmt::format("a vertex has \"{}\" for a number", word));
    }
    if (word == "\\") continue; // goes on in the next line
    if (values.size() < 3) fail(fmt::format("a vertex has {} of its 3 coordinates", values.size()));
    if (values.size() == 4 && values[3] != 1)
      fail(fmt::format("a vertex has the weight {:g}, which is for curves; remove it", values[3]));
  }
}

} // namespace grouser::spheredecomp::detail
