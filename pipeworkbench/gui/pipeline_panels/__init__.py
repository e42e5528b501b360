# SPDX-License-Identifier: LGPL-2.1-or-later
"""Task panels of what is done with measured components: adjusting, merging stations, comparing with a design, exporting."""
