# SPDX-License-Identifier: LGPL-2.1-or-later
"""Image files for tests, written byte by byte: no library is asked what it makes of them."""

import base64
import struct
import zlib

import cv2
import numpy as np

# 16 x 8 pixels of one colour, four components with Adobe's marker, as print programs write them
CMYK_JPEG = base64.b85decode(
    "|JeWT01iQ9Z(?NtWB>pF0095n07C#95)>B{5gQj47aklNASgmBC?zE*Q93;^LSR*8WM5TXTWWZjfogG(b6Z`7wT6(MqpPi}XMnuPx~9jOsH>#^zyK5o00;mO1Va%3O%VWD5dcdO"
    "0RO}Q761VO0RR910000000000000052LHqW6c7Ob00000000000000000030+5ip&LjX+xSpZ7_06zfHq^`7p5C7Q"
)

SHORT, LONG = 3, 4
FORMATS = {SHORT: "H", LONG: "I"}


def encoded(ending, image, *options):
    good, data = cv2.imencode(ending, image, options)
    assert good
    return data.tobytes()


# ---------------------------------------------------------------- JPEG


def jpeg(image, *options):
    return encoded(".jpg", image, cv2.IMWRITE_JPEG_QUALITY, 100, *options)


def jpeg_with_orientation(image, orientation):
    """Return a JPEG whose EXIF block says how a viewer is to turn it."""
    tags = b"Exif\0\0" + b"II*\0" + struct.pack("<IHHHIHHI", 8, 1, 274, SHORT, 1, orientation, 0, 0)
    data = jpeg(image)
    return data[:2] + b"\xff\xe1" + struct.pack(">H", len(tags) + 2) + tags + data[2:]


# ---------------------------------------------------------------- PNG


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def png(rows, width, bits, colour_type, before=(), height=None):
    """Return a PNG of packed rows of bytes; ``before`` are chunks that come before the pixels, ``height`` the header's."""
    header = struct.pack(">IIBBBBB", width, len(rows) if height is None else height, bits, colour_type, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows))
    parts = [chunk(b"IHDR", header), *before, chunk(b"IDAT", pixels), chunk(b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


def png_of(image, colour_type, before=()):
    """Return a PNG of an image (height, width, channels) in the channels' order of the format, red first."""
    rows = image.astype(image.dtype.newbyteorder(">")).reshape(len(image), -1)
    return png([row.tobytes() for row in rows], image.shape[1], image.dtype.itemsize * 8, colour_type, before)


# ---------------------------------------------------------------- TIFF


def tiff(image, photometric, *, big=False, planar=False, **tags):
    """Return an uncompressed TIFF of an image (height, width[, channels]); ``tags`` by number, such as t274=6, change its tags."""
    order = ">" if big else "<"
    image = image.reshape(*image.shape[:2], -1)
    height, width, channels = image.shape
    planes = np.moveaxis(image, 2, 0) if planar else image[None]
    pixels = [plane.astype(plane.dtype.newbyteorder(order)).tobytes() for plane in planes]
    starts = np.cumsum([8] + [len(plane) for plane in pixels]).tolist()
    entries = {
        256: (LONG, [width]),
        257: (LONG, [height]),
        258: (SHORT, [image.dtype.itemsize * 8] * channels),
        259: (SHORT, [1]),
        262: (SHORT, [photometric]),
        273: (LONG, starts[:-1]),
        277: (SHORT, [channels]),
        278: (LONG, [height]),
        279: (LONG, [len(plane) for plane in pixels]),
        284: (SHORT, [2 if planar else 1]),
    }
    for name, value in tags.items():
        number = int(name[1:])
        entries[number] = (entries.get(number, (SHORT,))[0], value if isinstance(value, list) else [value])
    directory = starts[-1]
    behind = directory + 2 + 12 * len(entries) + 4
    listed, appended = b"", b""
    for number, (kind, values) in sorted(entries.items()):
        content = struct.pack(f"{order}{len(values)}{FORMATS[kind]}", *values)
        if len(content) > 4:
            place = struct.pack(order + "I", behind + len(appended))
            appended += content
        else:
            place = content.ljust(4, b"\0")
        listed += struct.pack(order + "HHI", number, kind, len(values)) + place
    start = (b"MM\0*" if big else b"II*\0") + struct.pack(order + "I", directory)
    return start + b"".join(pixels) + struct.pack(order + "H", len(entries)) + listed + bytes(4) + appended
