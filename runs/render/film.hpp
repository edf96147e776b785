// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::render {

/// Throws base::InputError if the file name is not that of a film, the folder does not exist, or ffmpeg is not
/// installed.
void checkFilm(const std::filesystem::path& film);

/// Checks for ffmpeg only; the message begins with `word`, an option with its value.
void checkFilmProgram(const std::string& word);

/// Makes a film (H.264; MP4, MKV or MOV by the file name) of PNG pictures of equal size, in this order, with ffmpeg.
/// The complete file is renamed into place. Throws support::NotWritten with the message of ffmpeg, base::DeviceError if
/// the machine is out of processes.
void makeFilm(const std::vector<std::filesystem::path>& pictures, double framesPerSecond,
              const std::filesystem::path& film);

} // namespace grouser::render
