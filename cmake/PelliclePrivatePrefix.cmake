# The private prefix holds a Kokkos that was built against a newer C library than the system's, and that C library.
# Executables therefore start with the prefix's own loader and find its libraries first. Included only when that
# prefix is in use.
find_file(PELLICLE_PRIVATE_LOADER NAMES ld-linux-x86-64.so.2
  PATHS "${PELLICLE_PRIVATE_PREFIX}/lib/x86_64-linux-gnu" NO_DEFAULT_PATH REQUIRED)
mark_as_advanced(PELLICLE_PRIVATE_LOADER)
cmake_path(GET PELLICLE_PRIVATE_LOADER PARENT_PATH private_libraries)
# --allow-shlib-undefined: the linker looks up the library's newer symbols in the system's C library.
add_link_options(
  "-Wl,--dynamic-linker=${PELLICLE_PRIVATE_LOADER}"
  "-Wl,-rpath,${private_libraries}"
  "-Wl,--allow-shlib-undefined")
list(PREPEND CMAKE_PREFIX_PATH "${PELLICLE_PRIVATE_PREFIX}")
