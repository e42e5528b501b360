# SPDX-License-Identifier: LGPL-2.1-or-later
"""Photogrammetric reconstruction of pipelines: photographs in, parametric as-built pipework out."""

__version__ = "0.1.0"
