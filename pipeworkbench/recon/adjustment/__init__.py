# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the common adjustment is made of; its door is :mod:`pipeworkbench.recon.adjust`."""
