# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several viewpoints over the components they share (the paper's Sect. 8): what ``recon.register`` is made of."""
