# Options, build type, compiler flags.

option(PELLICLE_NATIVE "Compile for this machine's processor (-march=native)" ON)
option(PELLICLE_WERROR "Treat warnings as errors" ON)
option(PELLICLE_BENCHMARKS "Build the benchmarks" ON)
option(PELLICLE_CUDA_CHECK "Only compile every kernel for an NVIDIA GPU, without linking or running it" OFF)
set(PELLICLE_SANITIZE "" CACHE STRING "Sanitizers, for example address,undefined")

set(PELLICLE_DEPS "auto" CACHE STRING "Where Kokkos and AMGCL come from: auto, system, fetch or debian")
set_property(CACHE PELLICLE_DEPS PROPERTY STRINGS auto system fetch debian)
set(PELLICLE_PRIVATE_PREFIX "${CMAKE_SOURCE_DIR}/.deps/usr"
  CACHE PATH "Prefix filled by tools/setup/private_prefix.sh")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(CCACHE_PROGRAM ccache)
mark_as_advanced(CCACHE_PROGRAM)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Paths below the top folder are hashed relative to it, so that every clone and worktree shares one cache.
  set(CMAKE_CXX_COMPILER_LAUNCHER
    "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}" CCACHE_NOHASHDIR=1 "${CCACHE_PROGRAM}")
endif()

# Flags of everything that is compiled here.
add_library(pellicle_flags INTERFACE)

# No fused multiply-add: the compiler would fuse the force on one particle of a pair and not on the other, so that
# the two would no longer be exactly opposite, and results would depend on how a loop happened to be vectorised.
target_compile_options(pellicle_flags INTERFACE -ffp-contract=off)
# Nobody reads errno after sqrt or installs floating-point traps: without the two, sqrt and selects vectorise.
# These two change no result; nothing else of fast-math is on.
target_compile_options(pellicle_flags INTERFACE $<$<NOT:$<CONFIG:Debug>>:-fno-math-errno;-fno-trapping-math>)
if(PELLICLE_NATIVE)
  target_compile_options(pellicle_flags INTERFACE -march=native)
endif()

target_include_directories(pellicle_flags INTERFACE "${CMAKE_SOURCE_DIR}")

if(PELLICLE_SANITIZE)
  target_compile_options(pellicle_flags INTERFACE
    -fsanitize=${PELLICLE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    # With sanitizers gcc 12 takes the standard library's own std::regex for uninitialised.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized>)
  target_link_options(pellicle_flags INTERFACE -fsanitize=${PELLICLE_SANITIZE})
endif()
