# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD document objects: the App side, without Qt, so that they work with and without a window."""
