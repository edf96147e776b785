// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/detail/ply_text.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

namespace grouser::spheredecomp::detail {

namespace {

struct Element {
  std::string name;
  std::size_t count{}, properties{};
  bool hasList = false;
};

struct Header {
  std::vector<Element> elements;
  bool isText = false, isWhole = false;
};

Header headerOf(std::istream& in, int& number) {
  Header header;
  for (std::string line; !header.isWhole && std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string word, kind;
    words >> word >> kind;
    if (word == "end_header") header.isWhole = true;
    if (word == "format") header.isText = kind == "ascii";
    if (word == "element") {
      header.elements.push_back({kind});
      words >> header.elements.back().count;
    }
    if (word == "property" && !header.elements.empty()) {
      ++header.elements.back().properties;
      header.elements.back().hasList |= kind == "list";
    }
  }
  return header;
}

std::size_t wordsIn(const std::string& line) {
  std::istringstream words(line);
  std::size_t count = 0;
  for (std::string word; words >> word;) ++count;
  return count;
}

} // namespace

void checkPly(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  int number = 0;
  const Header header = headerOf(in, number);
  if (!header.isWhole)
    throw base::InputError(path + ": the header has no line \"end_header\"; the file is damaged or truncated; export "
                                  "it again");
  if (!header.isText) return;
  for (const Element& element : header.elements) {
    std::string line;
    for (std::size_t i = 0; i < element.count && std::getline(in, line);) {
      ++number;
      const std::size_t found = wordsIn(line);
      if (found == 0) continue;
      ++i;
      if (element.name == "vertex" && !element.hasList && found != element.properties)
        throw base::InputError(fmt::format("{}:{}: a vertex has {} numbers, but the header lists {} properties; export "
                                           "the mesh again, or correct the line",
                                           path, number, found, element.properties));
    }
  }
}

} // namespace grouser::spheredecomp::detail
