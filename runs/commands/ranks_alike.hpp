// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "runs/setup/provenance.hpp"

#include <string>

namespace grouser::commands {

/// Throws base::InputError where a rank was started with another command than the first one, which would end in a
/// deadlock. `command`: "run", or "bench bed".
void requireSameCommand(const std::string& command, const base::Comm& comm);

/// Throws base::InputError, naming rank and difference, if program, scene or command line of a rank differ from those
/// of the first: results are reproducible for one program and one scene only. `commandLine`: the program, and its
/// arguments after the first space.
void requireAlike(const setup::Provenance& provenance, const std::string& commandLine, const base::Comm& comm);

/// The same of a command without a scene: program and command line. `command`: begins the message.
void requireSameWords(const std::string& command, const std::string& commandLine, const base::Comm& comm);

} // namespace grouser::commands
