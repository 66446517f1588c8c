# SPDX-License-Identifier: GPL-3.0-or-later
"""Thousands of motions from a table: tasks are read, solved and written one by one, and no finished one is lost."""
