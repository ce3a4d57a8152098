# SPDX-License-Identifier: GPL-3.0-or-later
# Part of cpack: folders have the umask of who makes the packages, and everybody is to see what is in them.
execute_process(COMMAND find ${CPACK_TEMPORARY_INSTALL_DIRECTORY} -type d -exec chmod 755 {} + COMMAND_ERROR_IS_FATAL ANY)
