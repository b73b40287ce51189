# Run at build time: writes the header with version and commit, touching it only when they change.
set(commit "")
find_program(GIT_PROGRAM git)
if(GIT_PROGRAM)
  execute_process(COMMAND "${GIT_PROGRAM}" -C "${source}" describe --always --dirty --abbrev=10 --exclude=*
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT commit)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT "${output}" CONTENT [[
#pragma once
// Written by cmake/write_build_info.cmake.
#define PELLICLE_VERSION "@version@"
#define PELLICLE_COMMIT "@commit@"
#define PELLICLE_BUILD_TYPE "@build_type@"
]] @ONLY)
