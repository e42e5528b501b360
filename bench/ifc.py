# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long writing IFC takes and how large the files are, from 100 to 10,000 components: python bench/ifc.py."""

import argparse
import math
import sys
import tempfile
import time
from pathlib import Path

from pipe_rack import pipe_rack

from pipeworkbench.exports.ifc import SCHEMAS, IfcOptions, write_ifc

COUNTS = (100, 1000, 10000)
LIMITS_S = {1000: 5.0, 10000: 60.0}
LIMITS_MB = {1000: 2.0}
STEEPEST = 1.2  # exponent of time over components that still counts as linear


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--counts", type=int, nargs="+", default=COUNTS, help="components; default: 100 1000 10000")
    parser.add_argument("--schema", choices=SCHEMAS, nargs="+", default=list(SCHEMAS))
    options = parser.parse_args()
    write(1, SCHEMAS[0])  # imports take a second once
    print("| schema | components | seconds | CPU seconds | exponent | size MB | bytes per component |")
    print("|---|---|---|---|---|---|---|")
    missed = []
    for schema in options.schema:
        last = None
        for count in sorted(options.counts):
            seconds, busy, size = write(count, schema)
            exponent = math.log(busy / last[1]) / math.log(count / last[0]) if last else math.nan
            print(f"| {schema} | {count} | {seconds:.2f} | {busy:.2f} | {exponent:.2f} | {size / 1e6:.3f} | {size / count:.0f} |", flush=True)
            limits = ((busy, LIMITS_S.get(count), "s"), (size / 1e6, LIMITS_MB.get(count), "MB"), (exponent, STEEPEST, "(exponent)"))
            missed += [f"{schema}, {count}: {is_:.2f} {unit}, not {limit:g}" for is_, limit, unit in limits if limit is not None and is_ > limit]
            last = count, busy
    print("\n".join(f"missed: {text}" for text in missed) or "all limits kept")
    return 1 if missed else 0


def write(count: int, schema: str) -> tuple[float, float, int]:
    """Return the seconds, the seconds of the processor and the size of writing a plant of so many components to a new file."""
    plant = pipe_rack(count)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "rack.ifc"
        begin, busy = time.perf_counter(), time.process_time()
        write_ifc(plant, path, IfcOptions(schema))
        return time.perf_counter() - begin, time.process_time() - busy, path.stat().st_size


if __name__ == "__main__":
    sys.exit(main())
