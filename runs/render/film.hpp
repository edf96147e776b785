// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::render {

/// Throws base::InputError if the file name has no ending of a film, the folder does not exist, or ffmpeg is not
/// installed.
void checkFilm(const std::filesystem::path& film);

/// Checks only whether ffmpeg is installed; the message begins with `word`, an option with its value.
void checkFilmProgram(const std::string& word);

/// Makes a film (H.264; MP4, MKV or MOV according to the file name) from PNG pictures of equal size with ffmpeg.
/// Renames the complete file to its final name. Throws support::NotWritten with the message of ffmpeg, or
/// base::DeviceError if no process can be started.
void makeFilm(const std::vector<std::filesystem::path>& pictures, double framesPerSecond,
              const std::filesystem::path& film);

} // namespace grouser::render
