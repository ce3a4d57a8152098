# SPDX-License-Identifier: GPL-3.0-or-later
# OpenBLAS with threads of its own (Debian package libopenblas-pthread-dev), which alone is right when several threads
# call it. Not by its own CMake configuration: that of Debian 13 names a file that does not exist. Target:
# OpenBLAS::OpenBLAS.
find_path(OpenBLAS_INCLUDE_DIR openblas_config.h PATH_SUFFIXES openblas-pthread)
find_library(OpenBLAS_LIBRARY openblas PATH_SUFFIXES openblas-pthread)

# What programs get at run time is the choice of update-alternatives, whatever they are linked with. The daemon looks
# again when it starts (server/ddm/blas.hpp).
if(OpenBLAS_INCLUDE_DIR AND OpenBLAS_LIBRARY AND NOT OpenBLAS_THREADS)
  set(source ${CMAKE_BINARY_DIR}/CMakeFiles/openblas_threads.cpp)
  file(WRITE ${source} "#include <cblas.h>\nint main() { return openblas_get_parallel(); }\n")
  try_run(OpenBLAS_MODEL OpenBLAS_COMPILES ${CMAKE_BINARY_DIR} ${source}
          CMAKE_FLAGS "-DINCLUDE_DIRECTORIES=${OpenBLAS_INCLUDE_DIR}" LINK_LIBRARIES ${OpenBLAS_LIBRARY}
          COMPILE_OUTPUT_VARIABLE output)
  if(NOT OpenBLAS_COMPILES)
    message(FATAL_ERROR "OpenBLAS: a program with ${OpenBLAS_LIBRARY} does not compile:\n${output}")
  endif()
  if(OpenBLAS_MODEL STREQUAL 1)
    set(OpenBLAS_THREADS ON CACHE INTERNAL "programs get OpenBLAS with threads of its own")
  endif()
  unset(OpenBLAS_MODEL CACHE) # so that the cure is seen by the next run
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  OpenBLAS REQUIRED_VARS OpenBLAS_LIBRARY OpenBLAS_INCLUDE_DIR OpenBLAS_THREADS
  REASON_FAILURE_MESSAGE "The library must be the pthread build, for the serial and OpenMP ones compute wrongly under \
threads: install libopenblas-pthread-dev and select it with
  update-alternatives --config libopenblas.so.0-${CMAKE_LIBRARY_ARCHITECTURE}")
if(OpenBLAS_FOUND AND NOT TARGET OpenBLAS::OpenBLAS)
  add_library(OpenBLAS::OpenBLAS UNKNOWN IMPORTED)
  set_target_properties(OpenBLAS::OpenBLAS PROPERTIES IMPORTED_LOCATION "${OpenBLAS_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${OpenBLAS_INCLUDE_DIR}")
endif()
