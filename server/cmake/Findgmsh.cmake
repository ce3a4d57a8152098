# SPDX-License-Identifier: GPL-3.0-or-later
# Debian ships gmsh with neither a CMake configuration nor a pkg-config file. Target: gmsh::gmsh.
find_path(gmsh_INCLUDE_DIR gmsh.h)
find_library(gmsh_LIBRARY gmsh)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(gmsh REQUIRED_VARS gmsh_LIBRARY gmsh_INCLUDE_DIR)
if(gmsh_FOUND AND NOT TARGET gmsh::gmsh)
  add_library(gmsh::gmsh UNKNOWN IMPORTED)
  set_target_properties(gmsh::gmsh PROPERTIES IMPORTED_LOCATION "${gmsh_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${gmsh_INCLUDE_DIR}")
endif()
