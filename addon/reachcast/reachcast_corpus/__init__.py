# SPDX-License-Identifier: GPL-3.0-or-later
"""Corpora without Blender: recordings in, motions listed, checked, merged and written out again.

As a command, with the Python that reachcast_core was built for:

    PYTHONPATH=addon/reachcast /usr/bin/python3 -m reachcast_corpus --help

Every function takes the loaded `reachcast_core` as `core`, so that the add-on and the command share one module.
"""
