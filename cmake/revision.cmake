# SPDX-License-Identifier: Apache-2.0
# Writes OUT, a header with the revision of the sources and the optional features of the build; only if it has
# changed, so that nothing is compiled in vain.
# A source archive without git has no revision.
find_program(git git)
set(revision "")
if(git)
  execute_process(COMMAND ${git} -C "${SOURCE}" rev-parse --short=12 HEAD OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  execute_process(COMMAND ${git} -C "${SOURCE}" diff --quiet HEAD -- RESULT_VARIABLE changed ERROR_QUIET)
  if(revision AND changed)
    string(APPEND revision " with changes")
  endif()
endif()
set(content "// Made by cmake/revision.cmake.\n#pragma once\nnamespace takt::cli {\ninline constexpr const char* revision = \"${revision}\";\ninline constexpr const char* features = \"${FEATURES}\";\n}\n")
set(old "")
if(EXISTS "${OUT}")
  file(READ "${OUT}" old)
endif()
if(NOT old STREQUAL content)
  file(WRITE "${OUT}" "${content}")
endif()
