# SPDX-License-Identifier: LGPL-2.1-or-later
"""Image files looked into before they are decoded: what they hold, and whether all of it is there.

Decoders fill up what is missing, turn pictures, premultiply transparency and convert what was made for
printing, all in silence. A measurement must not: what is not a complete grey or colour photograph of
8 or 16 bits is refused here with its reason, and the rest is made unambiguous for the decoder.

References: ITU-T T.81 (JPEG), Annex B; W3C Portable Network Graphics, Third Edition, Sect. 5; TIFF
Revision 6.0, Sects. 2 and 8; Adobe DNG 1.4.
"""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from pipeworkbench.errors import InputError

COPY_AGAIN = "copy it again from the camera"
CONVERT = "convert it to PNG, TIFF or JPEG"
DEVELOP = "develop it to TIFF, PNG or JPEG, without lens correction and without cropping"
REDUCE = "export it as 8- or 16-bit grey or RGB (in GIMP: Image > Precision > 16 bit integer)"
PRINT = "export it as grey or RGB, or take the original from the camera"

RAW_SUFFIXES = frozenset(
    f".{name}"
    for name in (
        *("3fr", "arw", "cr2", "cr3", "crw", "dcr", "dng", "erf", "iiq", "kdc", "mef", "mos", "mrw", "nef"),
        *("nrw", "orf", "pef", "raf", "raw", "rw2", "rwl", "sr2", "srf", "srw", "x3f"),
    )
)
RAW_STARTS = (b"FUJIFILMCCD-RAW", b"IIRO", b"IIRS", b"MMOR", b"IIU\0", b"FOVb", b"\0MRM", b"II\x1a\0\0\0HEAPCCDR")
OTHER_STARTS = (
    (b"GIF8", "a GIF"),
    (b"\0\0\0\x0cjP  ", "a JPEG 2000"),
    (b"\xff\x4f\xff\x51", "a JPEG 2000"),
    (b"\xff\x0a", "a JPEG XL"),
    (b"\0\0\0\x0cJXL ", "a JPEG XL"),
    (b"II+\0", "a BigTIFF"),
    (b"MM\0+", "a BigTIFF"),
    (b"\x76\x2f\x31\x01", "an OpenEXR"),
    (b"8BPS", "a Photoshop"),
    (b"%PDF", "a PDF"),
)


@dataclass(frozen=True)
class EncodedImage:
    """A sound image file as the decoder is to get it.

    ``luminance`` says that the decoder itself finds the grey values of a colour picture (JPEG stores
    them), ``negative`` that its values count from white to black.
    """

    data: bytes
    width: int
    height: int
    luminance: bool = False
    negative: bool = False


def inspected(path: Path, data: bytes) -> EncodedImage:
    """Look into an image file's content.

    Raises
    ------
    InputError
        Where it is not a complete JPEG, PNG, TIFF, BMP or PGM/PPM image that can be measured in.
    """
    if not data:
        raise InputError(path, "", "is an empty file", COPY_AGAIN)
    for start, look in LOOKS:
        if data.startswith(start):
            return look(path, data)
    if path.suffix.lower() in RAW_SUFFIXES or data.startswith(RAW_STARTS) or data[4:12] == b"ftypcrx ":
        raise _raw(path)
    if data[4:8] == b"ftyp":
        if data[8:12] in {b"heic", b"heix", b"hevc", b"heim", b"heis", b"mif1", b"msf1", b"avif"}:
            raise InputError(path, "", "is an HEIC or AVIF file, which is not read", DEVELOP)
        raise InputError(path, "", "is a film, not a photograph", "give a photograph as PNG, TIFF or JPEG")
    if data.startswith(b"RIFF") and data[8:12] == b"WEBP":
        raise InputError(path, "", "is a WebP file, which is not read", CONVERT)
    for start, name in OTHER_STARTS:
        if data.startswith(start):
            raise InputError(path, "", f"is {name} file, which is not read", CONVERT)
    raise InputError(path, "", "is not an image file that is known", "give a PNG, TIFF or JPEG")


def _raw(path: Path) -> InputError:
    return InputError(path, "", "is a camera's RAW file, which is not read", DEVELOP)


def _cut_off(path: Path) -> InputError:
    return InputError(path, "", "is cut off: its end is missing", COPY_AGAIN)


def _damaged(path: Path, what: str) -> InputError:
    return InputError(path, "", f"is damaged ({what})", COPY_AGAIN)


def _depth(path: Path, what: str) -> InputError:
    return InputError(path, "", f"is not an 8- or 16-bit image ({what})", REDUCE)


def _cmyk(path: Path) -> InputError:
    return InputError(path, "", "is a CMYK picture, converted for printing", PRINT)


# ---------------------------------------------------------------- JPEG

_MARKER = re.compile(rb"\xff[^\x00\xd0-\xd7\xff]")  # stuffed bytes, restarts and fill bytes belong to the scan
_START_OF_SCAN, _END_OF_IMAGE = 0xDA, 0xD9
_FRAMES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
_FRAMES_READ = frozenset({0xC0, 0xC1, 0xC2, 0xC9, 0xCA})  # baseline, extended, progressive; the last two arithmetic
_WITHOUT_LENGTH = frozenset({0x01, 0xD8})


def _segments(path: Path, data: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield the marker and the content of every segment up to the end of the image, which must be there."""
    position = 2
    while found := _MARKER.search(data, position):
        marker, position = found.group()[1], found.end()
        if marker == _END_OF_IMAGE:
            return
        if marker in _WITHOUT_LENGTH:
            continue
        end = position + int.from_bytes(data[position : position + 2], "big")
        if end > len(data):
            break
        yield marker, data[position + 2 : end]
        position = max(end, position + 2)
    raise _cut_off(path)


def _jpeg(path: Path, data: bytes) -> EncodedImage:
    """Follow the markers up to the end of the image; what cameras append behind it does not matter."""
    frame: tuple[int, int, int, int] | None = None
    scanned = False
    for marker, content in _segments(path, data):
        scanned |= marker == _START_OF_SCAN
        if marker in _FRAMES:
            if len(content) < 6:
                raise _damaged(path, "its header")
            frame = struct.unpack_from(">BHHB", content)
            if marker not in _FRAMES_READ or frame[0] != 8:
                raise InputError(
                    path, "", "is a JPEG of a rare kind (lossless, hierarchical or 12-bit), which is not read", "convert it to PNG or TIFF"
                )
    if frame is None or not scanned:
        raise _damaged(path, "no picture between its start and its end")
    _, height, width, components = frame
    if components == 4:
        raise _cmyk(path)
    return EncodedImage(data, width, height, luminance=True)


# ---------------------------------------------------------------- PNG

_PNG_START = b"\x89PNG\r\n\x1a\n"


def _png(path: Path, data: bytes) -> EncodedImage:
    """Check every chunk; keep those that hold the pixels as stored.

    The others would have the decoder turn, blend, animate or re-tone the picture (eXIf, tRNS, acTL, gAMA, iCCP).
    """
    kept = [_PNG_START]
    header = b""
    position = len(_PNG_START)
    kind = b""
    while kind != b"IEND":
        if position + 12 > len(data):
            raise _cut_off(path)
        length, kind = struct.unpack_from(">I4s", data, position)
        end = position + 12 + length
        if end > len(data):
            raise _cut_off(path)
        if kind[:1].isupper():  # critical
            if zlib.crc32(data[position + 4 : end - 4]) != int.from_bytes(data[end - 4 : end], "big"):
                raise _damaged(path, f"the checksum of chunk {kind.decode('ascii', 'replace')} is wrong")
            kept.append(data[position:end])
            header = header or data[position + 8 : end - 4]
        position = end
    if len(kept) < 4 or len(header) != 13 or kept[1][4:8] != b"IHDR":
        raise _damaged(path, "chunks are missing")
    width, height = struct.unpack_from(">II", header)
    return EncodedImage(b"".join(kept), width, height)


# ---------------------------------------------------------------- TIFF

_VALUE_FORMATS = {1: "B", 3: "H", 4: "I"}  # BYTE, SHORT, LONG: what the tags below are written in
_SUBFILE, _WIDTH, _HEIGHT, _BITS, _COMPRESSION, _PHOTOMETRIC, _ORIENTATION = 254, 256, 257, 258, 259, 262, 274
_SAMPLES, _PLANAR, _EXTRA_SAMPLES, _SAMPLE_FORMAT, _DNG_VERSION = 277, 284, 338, 339, 50706
_STRIPS, _TILES = (273, 279), (324, 325)  # offsets and byte counts
_WHITE_IS_ZERO, _BLACK_IS_ZERO, _RGB, _PALETTE, _SEPARATED, _YCBCR = 0, 1, 2, 3, 5, 6
_COLOUR_FILTER_ARRAY, _LINEAR_RAW = 32803, 34892
_SAMPLE_KINDS = {2: "signed integers", 3: "floating point", 5: "complex integers", 6: "complex numbers"}


class _Tags:
    """The tags of a TIFF's first image: their values, and where these lie in the file."""

    def __init__(self, path: Path, data: bytes) -> None:
        self.order = "<" if data[:2] == b"II" else ">"
        self.values: dict[int, tuple[int, ...]] = {}
        self.places: dict[int, tuple[int, str]] = {}
        try:
            (directory,) = struct.unpack_from(self.order + "I", data, 4)
            (count,) = struct.unpack_from(self.order + "H", data, directory)
            for entry in range(directory + 2, directory + 2 + 12 * count, 12):
                tag, kind, number = struct.unpack_from(self.order + "HHI", data, entry)
                if kind not in _VALUE_FORMATS:
                    continue
                code = f"{self.order}{number}{_VALUE_FORMATS[kind]}"
                place = entry + 8
                if struct.calcsize(code) > 4:
                    (place,) = struct.unpack_from(self.order + "I", data, place)
                self.values[tag] = struct.unpack_from(code, data, place)
                self.places[tag] = (place, self.order + _VALUE_FORMATS[kind])
        except (struct.error, MemoryError):  # pointers and lengths that lead out of the file
            raise _cut_off(path) from None

    def first(self, tag: int, default: int = 0) -> int:
        values = self.values.get(tag)
        return values[0] if values else default


def _tiff(path: Path, data: bytes) -> EncodedImage:
    """Check the first image's tags and that all its strips or tiles are there; set right what the decoder takes amiss."""
    if data[4:11] == b"\x10\0\0\0CR\2" or path.suffix.lower() in RAW_SUFFIXES:
        raise _raw(path)
    tags = _Tags(path, data)
    photometric = tags.first(_PHOTOMETRIC, _BLACK_IS_ZERO)
    # the first image of a RAW file is a small preview
    if _DNG_VERSION in tags.values or tags.first(_SUBFILE) & 1 or photometric in {_COLOUR_FILTER_ARRAY, _LINEAR_RAW}:
        raise _raw(path)
    width, height, samples = tags.first(_WIDTH), tags.first(_HEIGHT), tags.first(_SAMPLES, 1)
    bits = set(tags.values.get(_BITS, (1,)))
    _refuse_strange_samples(path, tags, photometric, samples, bits)
    least = 0 if photometric == _YCBCR else width * height * samples * min(bits) // 8  # bytes; YCbCr may be subsampled
    _refuse_missing_strips(path, tags, data, least)
    patched = bytearray()
    # the decoder turns the picture and multiplies colours by the transparency, both unasked: tell it there is nothing to do
    for tag, wanted in ((_ORIENTATION, 1), (_EXTRA_SAMPLES, 1)):
        if tags.first(tag, wanted) != wanted:
            patched = patched or bytearray(data)
            place, code = tags.places[tag]
            struct.pack_into(code, patched, place, wanted)
    # of 8 bits and less the decoder makes positives itself
    return EncodedImage(bytes(patched) or data, width, height, negative=photometric == _WHITE_IS_ZERO and bits == {16})


def _refuse_strange_samples(path: Path, tags: _Tags, photometric: int, samples: int, bits: set[int]) -> None:
    if photometric == _SEPARATED:
        raise _cmyk(path)
    kinds = set(tags.values.get(_SAMPLE_FORMAT, (1,)))
    for kind, name in _SAMPLE_KINDS.items():
        if kind in kinds:
            raise _depth(path, f"{max(bits)}-bit {name}")
    if len(bits) != 1 or not bits <= {1, 8, 16} or (bits == {1} and samples > 1):
        raise _depth(path, f"{' and '.join(map(str, sorted(bits)))} bits per value")
    if photometric not in {_WHITE_IS_ZERO, _BLACK_IS_ZERO, _RGB, _PALETTE, _YCBCR}:
        raise InputError(path, "", f"is a TIFF of a rare colour space (photometric interpretation {photometric})", REDUCE)
    fewest = 3 if photometric in {_RGB, _YCBCR} else 1
    if not fewest <= samples <= 4:
        raise InputError(path, "", f"is a TIFF of {samples} channels", REDUCE)
    if bits == {16} and (photometric in {_PALETTE, _YCBCR} or (samples > 1 and (fewest == 1 or tags.first(_PLANAR, 1) != 1))):
        raise InputError(
            path,
            "",
            "is a 16-bit TIFF with separate planes, a palette or transparent grey",
            "export it as 16-bit grey or RGB, without an alpha channel",
        )


def _refuse_missing_strips(path: Path, tags: _Tags, data: bytes, least: int) -> None:
    for offsets, counts in (_STRIPS, _TILES):
        if offsets not in tags.values:
            continue
        parts = list(zip(tags.values[offsets], tags.values.get(counts, ()), strict=False))
        if any(offset + count > len(data) for offset, count in parts) or max(tags.values[offsets], default=0) >= len(data):
            raise _cut_off(path)
        if parts and tags.first(_COMPRESSION, 1) == 1 and sum(count for _, count in parts) < least:
            raise _damaged(path, "strips are missing")
        return
    raise _damaged(path, "no picture in it")


# ---------------------------------------------------------------- BMP and PGM/PPM


def _bitmap(path: Path, data: bytes) -> EncodedImage:
    if len(data) < 26:
        raise _cut_off(path)
    if int.from_bytes(data[14:18], "little") == 12:  # the header of OS/2
        width, height = struct.unpack_from("<HH", data, 18)
    else:
        width, height = struct.unpack_from("<ii", data, 18)
    return EncodedImage(data, width, abs(height))


def _fields(data: bytes) -> Iterator[int]:
    """Yield the numbers of a portable anymap's header; between them are spaces and comments."""
    position = 2
    for _ in range(3):
        found = re.compile(rb"(?:\s|#[^\n]*\n)+(\d{1,9})").match(data, position)
        if not found:
            return
        position = found.end()
        yield int(found.group(1))
    yield position + 1  # one white space, then the values


def _anymap(path: Path, data: bytes) -> EncodedImage:
    fields = list(_fields(data))
    if len(fields) < 4:
        raise _damaged(path, "its header")
    width, height, largest, begin = fields
    if not 1 <= largest <= 65535:
        raise _depth(path, f"values up to {largest}")
    values = width * height * (3 if data.startswith(b"P6") else 1)
    if len(data) - begin < values * (1 if largest < 256 else 2):
        raise _cut_off(path)
    return EncodedImage(data, width, height)


LOOKS: tuple[tuple[bytes, Callable[[Path, bytes], EncodedImage]], ...] = (
    (b"\xff\xd8", _jpeg),
    (_PNG_START, _png),
    (b"II*\0", _tiff),
    (b"MM\0*", _tiff),
    (b"BM", _bitmap),
    (b"P5", _anymap),
    (b"P6", _anymap),
)
