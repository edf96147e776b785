# SPDX-License-Identifier: BSD-3-Clause
# Writes the commit of SOURCE to the header OUTPUT, unless the header would not change.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
if(NOT status EQUAL 0 OR commit STREQUAL "")
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// Written by the build.\n#pragma once\ninline constexpr const char* kCommit = \"\${commit}\";\n")
