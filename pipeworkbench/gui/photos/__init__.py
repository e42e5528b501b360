# SPDX-License-Identifier: LGPL-2.1-or-later
"""The photo window: a station's photographs side by side, to look at and to click in."""
