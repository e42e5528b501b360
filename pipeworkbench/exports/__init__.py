# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipelines to files: one writer per format, chosen by the file's ending."""
