# SPDX-License-Identifier: GPL-3.0-or-later
# Part of cpack: makes folders readable for everyone, whatever the umask.
execute_process(COMMAND find ${CPACK_TEMPORARY_INSTALL_DIRECTORY} -type d -exec chmod 755 {} + COMMAND_ERROR_IS_FATAL ANY)
