# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the tests of rigs share: convert with black photographs, and refuse."""

import foreign
import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.recon.formats.conversion import convert_rig
from pipeworkbench.recon.formats.recognition import read_rig

PHOTOGRAPHS = tuple(f"{name}.png" for name in foreign.NAMES)


def convert(folder, source, names=PHOTOGRAPHS, *, named=True, cameras=None, **options):
    """Convert an input, with photographs that it names or that the command names, and return the station's file."""
    images = foreign.photographs(folder / "photographs", names)
    output = folder / "station.json"
    options |= {"image_folder": folder / "photographs"} if named else {"images": images}
    convert_rig(read_rig(source, cameras=cameras), output, **options)
    return output


def refuse(source, file, key, problem, cameras=None):
    """Read an input which must be refused, and check that the error names file, key and remedy."""
    with pytest.raises(InputError) as error:
        read_rig(source, cameras=cameras)
    assert error.value.source == str(file)
    assert key in error.value.key
    assert problem in error.value.problem
    assert error.value.remedy
    assert "\n" not in str(error.value)
    return error.value
