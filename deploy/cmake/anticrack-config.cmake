# SPDX-License-Identifier: GPL-3.0-or-later
# find_package(anticrack): the target anticrack::client, the headers <anticrack/client/...> and <anticrack/v1/...pb.h>.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(OpenSSL)
find_dependency(Protobuf)
list(PREPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})  # Findre2 for gRPC
find_dependency(gRPC CONFIG)
list(POP_FRONT CMAKE_MODULE_PATH)
find_dependency(PkgConfig)
if(NOT TARGET PkgConfig::ISAL)
  pkg_check_modules(ISAL QUIET IMPORTED_TARGET libisal)
endif()
if(NOT TARGET PkgConfig::ISAL)
  set(anticrack_FOUND FALSE)
  set(anticrack_NOT_FOUND_MESSAGE "pkg-config does not know libisal (Debian: libisal-dev)")
  return()
endif()
include(${CMAKE_CURRENT_LIST_DIR}/anticrack-targets.cmake)
