# SPDX-License-Identifier: GPL-3.0-or-later
# `cpack --config build/release/CPackConfig.cmake -B DIR`: a Debian package of each component.
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_GENERATOR DEB)
# Of a build that made programs only, as that of quickstart, the library is missing.
set(CPACK_INSTALL_COMMANDS "\"${CMAKE_COMMAND}\" --build \"${CMAKE_BINARY_DIR}\" --target product")
set(CPACK_COMPONENTS_ALL server client library python doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_VENDOR anticrack)
set(CPACK_PACKAGE_CONTACT ${maintainer})
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/open-folders.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_SERVER_PACKAGE_NAME anticrack-server)
set(CPACK_DEBIAN_SERVER_PACKAGE_SECTION science)
set(CPACK_DEBIAN_SERVER_PACKAGE_RECOMMENDS "anticrack-doc, openssl") # openssl is of make-certificates
set(CPACK_DEBIAN_SERVER_PACKAGE_SUGGESTS "anticrack-client, prometheus")
set(debian ${CMAKE_CURRENT_SOURCE_DIR}/debian)
set(CPACK_DEBIAN_SERVER_PACKAGE_CONTROL_EXTRA
    ${debian}/conffiles ${debian}/postinst ${debian}/prerm ${debian}/postrm)
set(CPACK_DEBIAN_SERVER_DESCRIPTION "solver service for membranes with cracks and rigid inclusions
The daemon anticrackd: takes a mesh once, factorises it once, keeps it, and
then answers load case after load case over gRPC. Elastic membranes with
cracks and delaminated thin rigid inclusions, by domain decomposition.")

set(CPACK_DEBIAN_CLIENT_PACKAGE_NAME anticrack-client)
set(CPACK_DEBIAN_CLIENT_PACKAGE_SECTION science)
set(CPACK_DEBIAN_CLIENT_PACKAGE_RECOMMENDS "anticrack-doc, python3-anticrack") # the latter draws for anticrack plot
set(CPACK_DEBIAN_CLIENT_PACKAGE_SUGGESTS anticrack-server)
set(CPACK_DEBIAN_CLIENT_DESCRIPTION "command of the membrane solver anticrack
The command anticrack: submits cases to anticrackd, watches every iteration,
saves the answers in HDF5, draws figures with the Python package and exports
to ParaView. With the API's proto files and example cases.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libanticrack-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS # gRPC's CMake package fails without its plugins
    "libgrpc++-dev, libisal-dev, libprotobuf-dev, libssl-dev, pkg-config | pkgconf, protobuf-compiler-grpc")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS "anticrack-client, cmake")
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "C++ client library of the membrane solver anticrack
A static library with headers and a CMake package: connect to anticrackd,
create meshes, submit jobs, watch them and read their results.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-anticrack)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.11), python3-grpcio, python3-h5py, python3-numpy, python3-protobuf")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS # the latter three are of anticrack view
    "python3-matplotlib, python3-aiohttp, libjs-three, libjs-chart.js")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "anticrack-client, anticrack-server, ffmpeg, python3-pandas")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${debian}/python/postinst ${debian}/python/prerm)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "Python client of the membrane solver anticrack
The module anticrack: starts or connects to anticrackd, submits cases from TOML
or from Python objects, watches them, and gives the answers as numpy arrays.
Draws them with matplotlib, and works with asyncio.")

set(CPACK_DEBIAN_DOC_PACKAGE_NAME anticrack-doc)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOC_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DOC_PACKAGE_RECOMMENDS anticrack-client) # has the examples that they show
set(CPACK_DEBIAN_DOC_DESCRIPTION "documents of the membrane solver anticrack
In /usr/share/doc/anticrack: the tutorial, the guide, the theory in one page,
result files and JSON, running a server, and the reference of the API.")
include(CPack)
