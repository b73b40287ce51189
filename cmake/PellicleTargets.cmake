# Helpers for the top CMakeLists.txt. Sources are globbed, so a new file needs no edit here.

# Version and commit, written at build time into one small header that only core/version.cpp includes.
set(build_info_dir "${CMAKE_BINARY_DIR}/generated")
add_custom_target(pellicle_write_build_info
  COMMAND "${CMAKE_COMMAND}" -D "source=${CMAKE_SOURCE_DIR}" -D "output=${build_info_dir}/pellicle_build_info.hpp"
    -D "version=${PROJECT_VERSION}" -D "build_type=${CMAKE_BUILD_TYPE}"
    -P "${CMAKE_SOURCE_DIR}/cmake/write_build_info.cmake"
  BYPRODUCTS "${build_info_dir}/pellicle_build_info.hpp"
  COMMENT "" VERBATIM)
add_library(pellicle_build_info INTERFACE)
target_include_directories(pellicle_build_info INTERFACE "${build_info_dir}")

# pellicle_folder(NAME [SOURCES_IN DIR] [PUBLIC targets...] [PRIVATE targets...])
# One library a folder: pellicle_NAME. Targets of folders that do not exist are dropped from the lists.
function(pellicle_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "SOURCES_IN" "PUBLIC;PRIVATE")
  set(dir "${CMAKE_SOURCE_DIR}/${name}")
  if(arg_SOURCES_IN)
    set(dir "${CMAKE_SOURCE_DIR}/${arg_SOURCES_IN}")
  endif()
  foreach(kind PUBLIC PRIVATE)
    set(${kind}_targets "")
    foreach(target IN LISTS arg_${kind})
      # Only folders may be missing; a library that was not found must still be an error.
      if(TARGET ${target} OR NOT target MATCHES "^pellicle_(dem|cfd|coupling|heat|spray)$")
        list(APPEND ${kind}_targets ${target})
      endif()
    endforeach()
  endforeach()

  file(GLOB sources CONFIGURE_DEPENDS "${dir}/*.cpp")
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  if(sources)
    add_library(pellicle_${name} STATIC ${sources})
    target_link_libraries(pellicle_${name} PUBLIC ${PUBLIC_targets} PRIVATE pellicle_flags ${PRIVATE_targets})
    if("pellicle_build_info" IN_LIST PRIVATE_targets)
      add_dependencies(pellicle_${name} pellicle_write_build_info)
    endif()
  else()
    add_library(pellicle_${name} INTERFACE)
    target_link_libraries(pellicle_${name} INTERFACE ${PUBLIC_targets})
  endif()
endfunction()

# The preset cuda-check: its only target runs the script, which knows by itself what has changed.
function(pellicle_cuda_check)
  get_target_property(kokkos_headers Kokkos::kokkoscore INTERFACE_INCLUDE_DIRECTORIES)
  string(GENEX_STRIP "${kokkos_headers}" stripped)
  if(NOT stripped) # sources fetched by CMake: the folders stand in build-interface expressions
    string(REGEX REPLACE "\\$<BUILD_INTERFACE:([^>]*)>" "\\1" kokkos_headers "${kokkos_headers}")
    string(GENEX_STRIP "${kokkos_headers}" stripped)
  endif()
  add_custom_target(cuda-check ALL
    COMMAND "${Python3_EXECUTABLE}" "${CMAKE_SOURCE_DIR}/tools/setup/cuda_check.py"
      --output "${CMAKE_BINARY_DIR}" --kokkos-include "${stripped}"
    USES_TERMINAL VERBATIM)
endfunction()

# The command itself, and its place in an installation.
function(pellicle_program)
  file(GLOB main CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/tools/pellicle/main.cpp")
  if(NOT main)
    return()
  endif()
  add_executable(pellicle ${main})
  target_link_libraries(pellicle PRIVATE
    pellicle_flags pellicle_tools CLI11::CLI11 nlohmann_json::nlohmann_json spdlog::spdlog yaml-cpp)
  include(GNUInstallDirs)
  # Kokkos may live in a private prefix: the installed program keeps the run path of the build.
  set_target_properties(pellicle PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
  install(TARGETS pellicle RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
  install(DIRECTORY "${CMAKE_SOURCE_DIR}/cases/" DESTINATION "${CMAKE_INSTALL_DATADIR}/pellicle/cases" OPTIONAL)
endfunction()

# One executable a file of tools/benchmarks.
function(pellicle_benchmarks)
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/tools/benchmarks/*.cpp")
  if(NOT sources OR NOT PELLICLE_BENCHMARKS)
    return()
  endif()
  find_package(benchmark REQUIRED)
  foreach(source IN LISTS sources)
    cmake_path(GET source STEM name)
    add_executable(${name} ${source})
    target_link_libraries(${name} PRIVATE pellicle_flags pellicle_tools benchmark::benchmark)
  endforeach()
endfunction()

# pellicle_test_executable(NAME PREFIX LABEL PROCESSORS LIBRARY sources...)
function(pellicle_test_executable name prefix label processors library)
  add_executable(${name} "${CMAKE_SOURCE_DIR}/tests/test_main.cpp" ${ARGN})
  target_link_libraries(${name} PRIVATE pellicle_flags ${library} GTest::gtest
    hdf5::hdf5 yaml-cpp spdlog::spdlog nlohmann_json::nlohmann_json Eigen3::Eigen pellicle_amgcl pellicle_udunits2)
  target_compile_definitions(${name} PRIVATE "PELLICLE_SOURCE_DIR=\"${CMAKE_SOURCE_DIR}\"")
  if(TARGET pellicle)
    target_compile_definitions(${name} PRIVATE "PELLICLE_PROGRAM=\"$<TARGET_FILE:pellicle>\"")
    add_dependencies(${name} pellicle)
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60 TEST_PREFIX "${prefix}/"
    PROPERTIES LABELS "${label}" PROCESSORS ${processors} TIMEOUT 1500)
  set_property(GLOBAL APPEND PROPERTY PELLICLE_TEST_TARGETS ${name})
endfunction()

# Threads are not bound: two bound processes would share one core. They wait passively, since tests run in parallel.
set(PELLICLE_TEST_ENVIRONMENT OMP_PROC_BIND=false OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive)

# gtest_discover_tests cannot pass a property that is a list, so ctest sets the environment of the tests it found.
function(pellicle_test_environment)
  get_property(targets GLOBAL PROPERTY PELLICLE_TEST_TARGETS)
  list(JOIN targets " " targets)
  set(script "${CMAKE_BINARY_DIR}/test_environment.cmake")
  file(CONFIGURE OUTPUT "${script}" CONTENT [[
foreach(target IN ITEMS @targets@)
  if(${target}_TESTS)
    set_tests_properties(${${target}_TESTS} PROPERTIES ENVIRONMENT "@PELLICLE_TEST_ENVIRONMENT@")
  endif()
endforeach()
]] @ONLY)
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${script}")
endfunction()

# tests/FOLDER/test_*.cpp              -> test_FOLDER      label unit
# tests/verification/FOLDER/test_*.cpp -> verify_FOLDER    label verification
# .../validation_*.cpp of either place -> validate_FOLDER  label validation, left out by `./pellicle test`
# test_*.py of either place            -> one test each, run by Python, same labels
function(pellicle_tests)
  find_package(GTest REQUIRED)
  include(GoogleTest)
  set(tests "${CMAKE_SOURCE_DIR}/tests")
  foreach(place "${tests}" "${tests}/verification")
    file(GLOB entries CONFIGURE_DEPENDS LIST_DIRECTORIES true "${place}/*")
    foreach(entry IN LISTS entries)
      cmake_path(GET entry FILENAME folder)
      if(NOT IS_DIRECTORY "${entry}" OR folder STREQUAL "verification")
        continue()
      endif()
      if(place STREQUAL "${tests}")
        set(executable test_${folder})
        set(label unit)
        set(prefix ${folder})
        set(processors 1)
        set(library pellicle_${folder})
      else()
        set(executable verify_${folder})
        set(label verification)
        set(prefix verification/${folder})
        set(processors 2)
        set(library pellicle_tools)
      endif()
      if(NOT TARGET ${library})
        set(library pellicle_tools)
      endif()
      file(GLOB sources CONFIGURE_DEPENDS "${entry}/test_*.cpp")
      if(sources)
        pellicle_test_executable(${executable} ${prefix} ${label} ${processors} ${library} ${sources})
      endif()
      file(GLOB sources CONFIGURE_DEPENDS "${entry}/validation_*.cpp")
      if(sources)
        string(REGEX REPLACE "^(test|verify)_" "validate_" validation ${executable})
        if(TARGET ${validation})
          set(validation ${validation}_cases)
        endif()
        pellicle_test_executable(${validation} validation/${folder} validation 2 pellicle_tools ${sources})
      endif()
      file(GLOB scripts CONFIGURE_DEPENDS "${entry}/test_*.py" "${entry}/validation_*.py")
      foreach(script IN LISTS scripts)
        cmake_path(GET script STEM name)
        set(script_label ${label})
        if(name MATCHES "^validation_")
          set(script_label validation)
        endif()
        add_test(NAME ${prefix}/${name} COMMAND "${Python3_EXECUTABLE}" "${script}")
        set(environment ${PELLICLE_TEST_ENVIRONMENT} "PELLICLE_SOURCE_DIR=${CMAKE_SOURCE_DIR}")
        if(TARGET pellicle)
          list(APPEND environment "PELLICLE_PROGRAM=$<TARGET_FILE:pellicle>")
        endif()
        set_tests_properties(${prefix}/${name} PROPERTIES
          LABELS ${script_label} ENVIRONMENT "${environment}" TIMEOUT 1500)
      endforeach()
    endforeach()
  endforeach()
  pellicle_test_environment()
endfunction()
