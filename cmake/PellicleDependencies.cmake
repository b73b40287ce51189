# Where the libraries come from. Kokkos and AMGCL have three ways (see docs/building.md), the others are the
# distribution's packages. `./pellicle setup` fills the private prefix only where no Kokkos is installed and upstream
# cannot be reached, so `auto` takes that prefix where it exists, unless Kokkos_ROOT names another Kokkos.

set(PELLICLE_KOKKOS_MINIMUM 4.6)
set(PELLICLE_KOKKOS_RELEASE 5.2.2)
set(PELLICLE_AMGCL_RELEASE 1.4.8)

set(dependencies_way "${PELLICLE_DEPS}")
if(dependencies_way STREQUAL "auto")
  if(DEFINED Kokkos_ROOT OR DEFINED ENV{Kokkos_ROOT})
    set(dependencies_way system)
  elseif(EXISTS "${PELLICLE_PRIVATE_PREFIX}/include/kokkos")
    set(dependencies_way debian)
  else()
    find_package(Kokkos ${PELLICLE_KOKKOS_MINIMUM} QUIET CONFIG)
    find_package(amgcl QUIET CONFIG)
    if(Kokkos_FOUND AND amgcl_FOUND)
      set(dependencies_way system)
    else()
      set(dependencies_way fetch)
    endif()
  endif()
endif()

if(dependencies_way STREQUAL "debian")
  include(PelliclePrivatePrefix)
endif()

if(dependencies_way STREQUAL "fetch")
  # Written by the documentation of both projects; not exercised where pellicle is developed, since upstream cannot
  # be reached from there.
  include(FetchContent)
  find_package(OpenMP REQUIRED COMPONENTS CXX)
  set(Kokkos_ENABLE_OPENMP ON CACHE BOOL "OpenMP backend of the fetched Kokkos")
  set(Kokkos_ENABLE_SERIAL OFF CACHE BOOL "Serial backend of the fetched Kokkos")
  set(AMGCL_TESTS OFF CACHE BOOL "")
  FetchContent_Declare(Kokkos
    GIT_REPOSITORY https://github.com/kokkos/kokkos.git GIT_TAG ${PELLICLE_KOKKOS_RELEASE} GIT_SHALLOW TRUE)
  FetchContent_Declare(amgcl
    GIT_REPOSITORY https://github.com/ddemidov/amgcl.git GIT_TAG ${PELLICLE_AMGCL_RELEASE} GIT_SHALLOW TRUE)
  FetchContent_MakeAvailable(Kokkos amgcl)
  set(amgcl_headers "${amgcl_SOURCE_DIR}")
  # Headers of the fetched sources must not be judged by this project's warnings.
  foreach(target kokkoscore kokkoscontainers kokkosalgorithms kokkossimd amgcl)
    if(TARGET ${target})
      get_target_property(directories ${target} INTERFACE_INCLUDE_DIRECTORIES)
      if(directories)
        set_target_properties(${target} PROPERTIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${directories}")
      endif()
    endif()
  endforeach()
else()
  find_package(Kokkos ${PELLICLE_KOKKOS_MINIMUM} REQUIRED CONFIG)
  find_package(amgcl REQUIRED CONFIG)
endif()

# Reached through a target of our own: AMGCL's adds compiler options that this project sets itself.
add_library(pellicle_amgcl INTERFACE)
if(TARGET amgcl::amgcl)
  get_target_property(amgcl_headers amgcl::amgcl INTERFACE_INCLUDE_DIRECTORIES)
  list(REMOVE_ITEM amgcl_headers /usr/include)
endif()
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(Boost REQUIRED)
target_include_directories(pellicle_amgcl SYSTEM INTERFACE ${amgcl_headers})
target_link_libraries(pellicle_amgcl INTERFACE OpenMP::OpenMP_CXX Boost::headers)

find_package(Eigen3 REQUIRED NO_MODULE)
find_package(HDF5 REQUIRED COMPONENTS C)
find_package(yaml-cpp REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)

# UDUNITS-2 ships no CMake files in Debian.
find_path(UDUNITS2_INCLUDE_DIR udunits2.h PATH_SUFFIXES udunits2 REQUIRED)
find_library(UDUNITS2_LIBRARY udunits2 REQUIRED)
mark_as_advanced(UDUNITS2_INCLUDE_DIR UDUNITS2_LIBRARY)
add_library(pellicle_udunits2 INTERFACE)
target_include_directories(pellicle_udunits2 SYSTEM INTERFACE "${UDUNITS2_INCLUDE_DIR}")
target_link_libraries(pellicle_udunits2 INTERFACE "${UDUNITS2_LIBRARY}")

# Debian's Python modules (numpy, h5py, matplotlib) belong to /usr/bin/python3; another one on PATH may lack them.
if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python3 REQUIRED COMPONENTS Interpreter)

message(STATUS "Kokkos ${Kokkos_VERSION} (${dependencies_way}), devices: ${Kokkos_DEVICES}")

if(dependencies_way STREQUAL "debian")
  # The compiler's own libgomp, named by its full path, makes CMake warn that the prefix hides it, which is the aim.
  set_target_properties(OpenMP::OpenMP_CXX PROPERTIES INTERFACE_LINK_LIBRARIES "" INTERFACE_LINK_OPTIONS -fopenmp)
endif()
