# Warnings, after the dependencies: what a CUDA build may be strict about depends on the Kokkos that was found.
if(Kokkos_ENABLE_CUDA)
  message(STATUS "Kokkos has CUDA: device code runs on the GPU")
  # The code that nvcc generates does not pass the host compiler's strict warnings.
  target_compile_options(pellicle_flags INTERFACE -Wall -Wextra)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    target_compile_options(pellicle_flags INTERFACE --fmad=false) # as -ffp-contract=off on the host
  endif()
else()
  target_compile_options(pellicle_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  if(PELLICLE_WERROR)
    # Newer Kokkos releases deprecate before they remove: that must not stop a build.
    target_compile_options(pellicle_flags INTERFACE -Werror -Wno-error=deprecated-declarations)
  endif()
endif()
