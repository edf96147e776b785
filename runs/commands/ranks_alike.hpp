// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "runs/setup/provenance.hpp"

#include <string>

namespace grouser::commands {

/// Throws base::InputError if a rank was started with a different command than the first rank, because that would cause
/// a deadlock. `command`: "run", or "bench bed".
void requireSameCommand(const std::string& command, const base::Comm& comm);

/// Throws base::InputError, with rank and difference, if program, scene or command line of a rank differ from those of
/// the first rank: results are reproducible for one program and one scene only. `commandLine`: the program, a space,
/// and the arguments.
void requireAlike(const setup::Provenance& provenance, const std::string& commandLine, const base::Comm& comm);

/// The same for a command without a scene: compares program and command line. `command`: first word of the message.
void requireSameWords(const std::string& command, const std::string& commandLine, const base::Comm& comm);

} // namespace grouser::commands
