# SPDX-License-Identifier: LGPL-2.1-or-later
"""Insulation: what goes around which component, how much heat it saves, and the sheet metal that is cut for it."""
