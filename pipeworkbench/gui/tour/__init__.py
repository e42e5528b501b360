# SPDX-License-Identifier: LGPL-2.1-or-later
"""The first steps: an example project and a guide that says what to click next."""
