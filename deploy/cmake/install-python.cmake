# SPDX-License-Identifier: GPL-3.0-or-later
# Part of `cmake --install`: the Python package, where Debian's Python looks for it. ${built}: its folder in the build,
# ${version}: of Python. Below /usr/local and elsewhere the folder is named after the version.
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(version 3)
endif()
file(INSTALL DESTINATION "${CMAKE_INSTALL_PREFIX}/lib/python${version}/dist-packages" TYPE DIRECTORY
     FILES "${built}/anticrack" "${built}/anticrack.egg-info"
     PATTERN __pycache__ EXCLUDE PATTERN SOURCES.txt EXCLUDE)
