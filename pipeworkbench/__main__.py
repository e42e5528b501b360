# SPDX-License-Identifier: LGPL-2.1-or-later
"""``python -m pipeworkbench``."""

import sys

from pipeworkbench.cli import main

if __name__ == "__main__":
    sys.exit(main())
