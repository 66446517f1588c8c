# SPDX-License-Identifier: GPL-3.0-or-later
"""What the buttons do: read the settings, call a plain function of scene/, report."""
