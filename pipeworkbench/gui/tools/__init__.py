# SPDX-License-Identifier: LGPL-2.1-or-later
"""The measuring tools: what is clicked or proposed becomes components of the document."""
