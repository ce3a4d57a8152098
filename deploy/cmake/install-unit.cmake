# SPDX-License-Identifier: GPL-3.0-or-later
# Part of `cmake --install`: the unit and the configuration, whose paths depend on the prefix. `deploy`: their folder.
set(etc ${CMAKE_INSTALL_PREFIX}/etc)
if(CMAKE_INSTALL_PREFIX MATCHES "^/usr(/local)?$")
  set(etc /etc)
endif()
if(EXISTS $ENV{DESTDIR}${etc}/anticrack/anticrackd.toml)
  message(STATUS "Kept as it is: $ENV{DESTDIR}${etc}/anticrack/anticrackd.toml")
else()
  file(INSTALL ${deploy}/anticrackd.toml DESTINATION ${etc}/anticrack)
endif()

set(units ${CMAKE_INSTALL_PREFIX}/lib/systemd/system)
file(INSTALL ${deploy}/anticrackd.service DESTINATION ${units})
file(READ ${deploy}/anticrackd.service unit)
string(REPLACE /usr/local/bin ${CMAKE_INSTALL_PREFIX}/bin unit "${unit}")
string(REPLACE /etc/anticrack ${etc}/anticrack unit "${unit}")
file(WRITE $ENV{DESTDIR}${units}/anticrackd.service "${unit}")
