// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The complete public interface of grouser. Headers in <grouser/internal/> may change at any time.
#include <grouser/errors.hpp>
#include <grouser/scene.hpp>
#include <grouser/simulation.hpp>
#include <grouser/types.hpp>
#include <grouser/vehicle.hpp>
#include <grouser/version.hpp>
