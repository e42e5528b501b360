# SPDX-License-Identifier: LGPL-2.1-or-later
"""Images to components: numpy, scipy and OpenCV; knows neither FreeCAD nor Qt."""
