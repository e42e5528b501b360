# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rigs from other programs: one small module per format, one way to a station.

`recognition.read_rig` finds the format and reads it into a `rig.Rig`; `conversion.convert_rig` makes a
station of it and writes station.json. The formats' conventions end in their modules: a `Rig` has our
pixels (centres at integers), our camera axes (x right, y down, z forward) and our distortion model.
"""
