// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/mechanism.hpp"
#include "runs/output/channels.hpp"
#include "runs/output/records.hpp"

#include <string>
#include <vector>

/// What a run writes of a mechanism.
namespace grouser::output {

/// The quantities of a mechanism's rows. `record`: names of the bodies, joints, springs and drives that are written;
/// empty: all.
std::vector<Channel> mechanismChannels(const multibody::Model& model, const std::vector<std::string>& record);

/// Fills a row of these channels but for the ledger's changes, which the simulation knows.
void setMechanismRow(RowBuilder& row, const coupling::Mechanism& mechanism, const std::vector<std::string>& record);

/// "RATTLE of order 2, springs implicit".
std::string integratorText(const multibody::SolverOptions& options);

/// Lines about the size of a mechanism: bodies, joints, freedoms, rows held more than once.
std::string mechanismSize(const coupling::Mechanism& mechanism);

/// Each body as a box and thin bars to its joints, for pictures and ParaView.
std::vector<FramePart> mechanismParts(const coupling::MechanismSetup& setup);

} // namespace grouser::output
