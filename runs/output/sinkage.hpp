// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::output {

/// Writes sinkage.csv into `folder`: time and one column per shoe [m], NaN while the shoe has no ground contact. With
/// `shoes`, counted from 0, of `track` ("left", "right"; empty: both), writes sinkage_shoes.csv. Throws
/// base::InputError if `results` is not the results.h5 of a run with a vehicle, or has no such shoe. Returns the path.
std::filesystem::path writeSinkageCsv(const std::filesystem::path& results, const std::filesystem::path& folder,
                                      const std::vector<int>& shoes = {}, const std::string& track = {});

/// Shoe numbers in a list such as "10-13,20", in this order. Throws base::InputError for an invalid list.
std::vector<int> shoesNamed(const std::string& list);
/// Throws base::InputError if `results` contains no sinkage or not all of these shoes.
void requireShoes(const std::filesystem::path& results, const std::vector<int>& shoes, const std::string& track = {});

} // namespace grouser::output
