# SPDX-License-Identifier: GPL-3.0-or-later
"""A page to watch jobs and explore results, served on this machine only: `anticrack view`."""
