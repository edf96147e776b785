// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "runs/setup/provenance.hpp"

#include <string>

namespace grouser::commands {

/// Throws base::InputError where a rank was started with another command than the first one: some of them would wait
/// for ever for what the others never do. `command`: "run", or "bench bed".
void requireSameCommand(const std::string& command, const base::Comm& comm);

/// Throws base::InputError, naming the rank and what differs, where the ranks run other programs or other scenes than
/// the first one, or another command line: the promise of one answer holds for one program and one
/// scene. `commandLine`: the program, and all its words behind the first space.
void requireAlike(const setup::Provenance& provenance, const std::string& commandLine, const base::Comm& comm);

/// The same of a command without a scene: program and command line. `command`: begins the message.
void requireSameWords(const std::string& command, const std::string& commandLine, const base::Comm& comm);

} // namespace grouser::commands
