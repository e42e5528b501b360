# SPDX-License-Identifier: LGPL-2.1-or-later
"""Photographs as they are stored: every depth and colour that can be measured in, and what is refused."""

import struct

import cv2
import numpy as np
import pytest
from image_bytes import CMYK_JPEG, chunk, encoded, jpeg, jpeg_with_orientation, png, png_of, tiff

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Camera, OpenCVInterior
from pipeworkbench.recon.images import MOST_BYTES, read_grey, read_image
from pipeworkbench.recon.station import Station

WIDTH, HEIGHT = 64, 48
REC_601 = np.array([0.299, 0.587, 0.114])  # red first
DEPTHS = pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
random = np.random.default_rng(3)


def ramp(dtype=np.uint8):
    """Return a grey image whose four corners and two sides are different."""
    values = np.arange(WIDTH) + 2.5 * np.arange(HEIGHT)[:, None]
    return (values * (np.iinfo(dtype).max / values.max())).astype(dtype)


def noise(channels, dtype=np.uint8):
    return random.integers(0, np.iinfo(dtype).max, (HEIGHT, WIDTH, channels), endpoint=True).astype(dtype)


@pytest.fixture
def reading(tmp_path):
    """Give a function that writes bytes into a file and reads it as an image."""

    def read(data, name="photograph"):
        path = tmp_path / name
        path.write_bytes(data)
        return read_grey(path)

    return read


@pytest.fixture
def refusing(reading, tmp_path, capfd):
    """Give a function that checks that bytes are refused without a word from elsewhere and returns the error."""

    def refuse(data, match, name="photograph"):
        with pytest.raises(InputError, match=match) as error:
            reading(data, name)
        assert error.value.source == str(tmp_path / name)
        assert error.value.remedy
        printed = capfd.readouterr()
        assert printed.out + printed.err == ""
        return error.value

    return refuse


def is_luminance(read, colour):
    """Check grey values against a colour image (height, width, 3), red first."""
    assert read.dtype == colour.dtype
    assert read.shape == colour.shape[:2]
    tolerance = 1 if colour.dtype == np.uint8 else 4  # coefficients of 14 bits
    assert np.abs(read - colour.astype(float) @ REC_601).max() <= tolerance


# ---------------------------------------------------------------- what can be measured in


@DEPTHS
@pytest.mark.parametrize("ending", [".png", ".tiff", ".pgm"])
def test_grey_image_is_read_with_all_its_bits(reading, ending, dtype):
    image = ramp(dtype)
    read = reading(encoded(ending, image))
    assert read.dtype == dtype
    assert np.array_equal(read, image)


@DEPTHS
@pytest.mark.parametrize("ending", [".png", ".tiff", ".ppm"])
def test_colour_image_is_read_as_its_luminance_with_all_its_bits(reading, ending, dtype):
    colour = noise(3, dtype)
    is_luminance(reading(encoded(ending, colour[:, :, ::-1])), colour)


def test_windows_bitmap_is_read(reading):
    assert np.array_equal(reading(encoded(".bmp", ramp())), ramp())


@pytest.mark.parametrize(
    "options", [(), (cv2.IMWRITE_JPEG_PROGRESSIVE, 1), (cv2.IMWRITE_JPEG_RST_INTERVAL, 2)], ids=["baseline", "progressive", "restarts"]
)
def test_jpeg_is_read(reading, options):
    image = ramp()
    assert np.abs(reading(jpeg(image, *options)).astype(int) - image).max() <= 2


def test_jpegs_own_luminance_is_read(reading):
    colour = np.kron(random.integers(0, 256, (6, 8, 3)), np.ones((8, 8, 1))).astype(np.uint8)
    read = reading(jpeg(colour[:, :, ::-1]))
    assert np.abs(read - colour.astype(float) @ REC_601).max() <= 3


@DEPTHS
@pytest.mark.parametrize("channels", [2, 4], ids=["grey", "colour"])
def test_transparency_of_a_png_is_ignored(reading, channels, dtype):
    image = noise(channels, dtype)
    read = reading(png_of(image, 4 if channels == 2 else 6))
    is_luminance(read, np.repeat(image[:, :, :1], 3, axis=2) if channels == 2 else image[:, :, :3])


@DEPTHS
@pytest.mark.parametrize("meaning", [0, 1, 2], ids=["unspecified", "associated", "unassociated"])
def test_transparency_of_a_tiff_is_ignored(reading, meaning, dtype):
    image = noise(4, dtype)
    is_luminance(reading(tiff(image, 2, t338=meaning)), image[:, :, :3])


@pytest.mark.parametrize("big", [False, True], ids=["little-endian", "big-endian"])
@DEPTHS
def test_tiff_that_counts_from_white_is_read_as_a_positive(reading, dtype, big):
    image = ramp(dtype)
    assert np.array_equal(reading(tiff(image, 0, big=big)), np.iinfo(dtype).max - image)


def test_palette_is_looked_up(reading):
    palette = random.integers(0, 256, (256, 3)).astype(np.uint8)
    index = ramp()
    is_luminance(reading(png_of(index[:, :, None], 3, [chunk(b"PLTE", palette.tobytes())])), palette[index])


def test_picture_of_one_bit_is_black_and_white(reading):
    bits = random.integers(0, 2, (HEIGHT, WIDTH)).astype(np.uint8)
    assert np.array_equal(reading(png(np.packbits(bits, axis=1), WIDTH, 1, 0)), bits * 255)


@pytest.mark.parametrize("bits", [2, 4])
def test_grey_of_few_bits_is_spread_over_eight(reading, bits):
    values = random.integers(0, 2**bits, (HEIGHT, WIDTH))
    per_byte = 8 // bits
    packed = sum(values[:, i::per_byte] << (bits * (per_byte - 1 - i)) for i in range(per_byte)).astype(np.uint8)
    assert np.array_equal(reading(png(packed, WIDTH, bits, 0)), values * 255 // (2**bits - 1))


def test_one_pixel_and_constant_images_are_images(reading):
    assert reading(encoded(".png", np.full((1, 1), 77, np.uint8))).tolist() == [[77]]
    constant = np.full((HEIGHT, WIDTH), 12345, np.uint16)
    assert np.array_equal(reading(encoded(".tiff", constant)), constant)


# ---------------------------------------------------------------- the sensor's pixels as stored


@pytest.mark.parametrize("orientation", range(1, 9))
def test_rotation_flag_of_a_jpeg_does_not_turn_it(reading, orientation):
    turned = cv2.imdecode(np.frombuffer(jpeg_with_orientation(ramp(), orientation), np.uint8), cv2.IMREAD_GRAYSCALE)
    if orientation > 1:  # the flag is a real one: a viewer would turn the picture
        assert turned.shape != (HEIGHT, WIDTH) or np.abs(turned.astype(int) - ramp()).max() > 50
    assert np.abs(reading(jpeg_with_orientation(ramp(), orientation)).astype(int) - ramp()).max() <= 2


@DEPTHS
@pytest.mark.parametrize("big", [False, True], ids=["little-endian", "big-endian"])
@pytest.mark.parametrize("orientation", range(1, 9))
def test_rotation_flag_of_a_tiff_does_not_turn_it(reading, orientation, big, dtype):
    assert np.array_equal(reading(tiff(ramp(dtype), 1, big=big, t274=orientation)), ramp(dtype))


def test_rotation_flag_of_a_png_does_not_turn_it(reading):
    flag = chunk(b"eXIf", b"II*\0" + struct.pack("<IHHHIHHI", 8, 1, 274, 3, 1, 6, 0, 0))
    assert np.array_equal(reading(png_of(ramp()[:, :, None], 0, [flag])), ramp())


def test_tone_curves_and_transparent_colours_of_a_png_are_ignored(reading, capfd):
    colour = noise(3)
    chunks = [
        chunk(b"gAMA", struct.pack(">I", 100000)),
        chunk(b"iCCP", b"bad\0\0nonsense"),
        chunk(b"tRNS", struct.pack(">HHH", *colour[0, 0].tolist())),
    ]
    is_luminance(reading(png_of(colour, 2, chunks)), colour)
    assert capfd.readouterr().err == ""


def test_of_an_animated_png_the_picture_that_every_viewer_shows_is_read(reading):
    control = chunk(b"acTL", struct.pack(">II", 2, 0))
    frame = chunk(b"fcTL", struct.pack(">IIIIIHHBB", 0, WIDTH, HEIGHT, 0, 0, 1, 10, 0, 0))
    data = png_of(ramp()[:, :, None], 0, [control, frame])
    second = chunk(b"fcTL", struct.pack(">IIIIIHHBB", 1, WIDTH, HEIGHT, 0, 0, 1, 10, 0, 0)) + chunk(b"fdAT", bytes(4) + b"x")
    end = chunk(b"IEND", b"")
    assert np.array_equal(reading(data.removesuffix(end) + second + end), ramp())


@pytest.mark.parametrize("tail", [b"\0" * 5000, jpeg(np.zeros((8, 8), np.uint8)), b"\xff\xff\xd0" * 9], ids=["zeros", "preview", "anything"])
def test_what_a_camera_appends_to_a_jpeg_does_not_matter(reading, tail):
    assert np.abs(reading(jpeg(ramp()) + tail).astype(int) - ramp()).max() <= 2


def test_opencv_logs_as_before(reading):
    before = cv2.getLogLevel()
    try:
        cv2.setLogLevel(4)
        reading(encoded(".png", ramp()))
        assert cv2.getLogLevel() == 4
    finally:
        cv2.setLogLevel(before)


# ---------------------------------------------------------------- incomplete files

WHOLE = {
    "jpeg": jpeg(noise(3)),
    "progressive jpeg": jpeg(noise(3), cv2.IMWRITE_JPEG_PROGRESSIVE, 1),
    "jpeg with restarts": jpeg(noise(1), cv2.IMWRITE_JPEG_RST_INTERVAL, 1),
    "jpeg with exif": jpeg_with_orientation(noise(1), 6),
    "png": encoded(".png", noise(3)),
    "tiff": encoded(".tiff", noise(3)),
    "plain tiff": tiff(noise(3), 2),
    "pgm": encoded(".pgm", noise(1)),
}


@pytest.mark.parametrize("share", [0.02, 0.3, 0.7, 0.99])
@pytest.mark.parametrize("data", WHOLE.values(), ids=WHOLE)
def test_file_that_is_cut_off_is_refused(refusing, reading, data, share):
    assert reading(data).shape == (HEIGHT, WIDTH)
    error = refusing(data[: int(len(data) * share)], "photograph: is (cut off|damaged)")
    assert error.remedy == "copy it again from the camera"


@pytest.mark.parametrize("data", WHOLE.values(), ids=WHOLE)
def test_file_whose_end_was_copied_as_zeros_is_refused(refusing, data):
    half = len(data) // 2
    if not data.startswith((b"II", b"P5")):  # raw pixels: zeros are black
        refusing(data[:half] + bytes(len(data) - half), "is (cut off|damaged)")


@pytest.mark.parametrize("missing", [1, 2])
def test_jpeg_without_its_last_bytes_is_refused(refusing, missing):
    refusing(jpeg(ramp())[:-missing], "is cut off: its end is missing; copy it again from the camera")


def test_bitmap_that_is_cut_off_is_refused(refusing):
    data = encoded(".bmp", ramp())
    refusing(data[:-500], "cannot be decoded.*copy it again")
    refusing(data[:20], "is cut off")


def test_png_with_a_wrong_checksum_is_refused(refusing):
    data = bytearray(encoded(".png", noise(1)))
    data[len(data) // 2] ^= 1
    refusing(bytes(data), "checksum of chunk IDAT is wrong")


def test_png_with_too_few_pixels_is_refused(reading):
    with pytest.raises(InputError, match="cannot be decoded"):
        reading(png(ramp()[:20], WIDTH, 8, 0, height=HEIGHT))


def test_tiff_with_too_few_strips_is_refused(refusing):
    refusing(tiff(ramp(), 1, t279=100), "strips are missing")
    refusing(tiff(ramp(), 1, t273=10**9), "is cut off")


@pytest.mark.parametrize("start", [b"\x89PNG\r\n\x1a\n", b"\xff\xd8", b"\xff\xd8\xff", b"II*\0", b"MM\0*\0\0\0\x08", b"BM", b"P5", b"P5\n4 4\n"])
def test_beginnings_of_files_are_refused(refusing, start):
    refusing(start, "is (cut off|damaged)")


def test_jpegs_without_a_picture_are_refused(refusing):
    refusing(b"\xff\xd8\xff\xd9", "no picture between its start and its end")
    refusing(b"\xff\xd8\xff\xc0\0\x04\x08\0\xff\xd9", "is damaged")
    refusing(b"\xff\xd8\xff\xe0\0\0\xff\xd9", "no picture")


def test_noise_behind_every_magic_number_is_refused_without_a_traceback(reading):
    for seed in range(60):
        tail = np.random.default_rng(seed).integers(0, 256, 400).astype(np.uint8).tobytes()
        for start in (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"II*\0\x08\0\0\0", b"MM\0*\0\0\0\x08", b"BM", b"P6 ", b"P5\n8 8\n255\n"):
            try:
                grey = reading(start + tail)
            except InputError:
                continue
            assert start.startswith(b"P5\n8 8")
            assert grey.shape == (8, 8)


# ---------------------------------------------------------------- what cannot be measured in


def test_cmyk_is_refused(refusing):
    assert "grey or RGB" in refusing(CMYK_JPEG, "is a CMYK picture").remedy
    refusing(tiff(noise(4), 5), "is a CMYK picture")


@pytest.mark.parametrize(
    ("image", "tags", "named"),
    [
        (np.zeros((HEIGHT, WIDTH), np.float32), {"t339": 3}, "32-bit floating point"),
        (np.full((HEIGHT, WIDTH), np.nan, np.float32), {"t339": 3}, "32-bit floating point"),
        (np.zeros((HEIGHT, WIDTH), np.float64), {"t339": 3}, "64-bit floating point"),
        (np.zeros((HEIGHT, WIDTH, 3), np.float16), {"t339": [3, 3, 3]}, "16-bit floating point"),
        (np.zeros((HEIGHT, WIDTH), np.uint32), {}, "32 bits per value"),
        (np.zeros((HEIGHT, WIDTH), np.int32), {"t339": 2}, "32-bit signed integers"),
        (np.zeros((HEIGHT, WIDTH), np.int16), {"t339": 2}, "16-bit signed integers"),
        (np.zeros((HEIGHT, WIDTH), np.uint16), {"t258": 12}, "12 bits per value"),
        (np.zeros((HEIGHT, WIDTH, 3), np.uint8), {"t258": [5, 6, 5]}, "5 and 6 bits per value"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_tiff_of_other_depths_is_refused_and_told_how_to_get_one(refusing, image, tags, named):
    error = refusing(tiff(image, 1 if image.ndim == 2 else 2, **tags), f"not an 8- or 16-bit image \\({named}\\)")
    assert "16 bit integer" in error.remedy


def test_floating_point_tiff_of_opencv_is_refused(refusing):
    refusing(encoded(".tiff", ramp().astype(np.float32)), "not an 8- or 16-bit image")


def test_tiffs_that_the_decoder_would_take_amiss_are_refused(refusing):
    refusing(tiff(noise(3, np.uint16), 2, planar=True), "separate planes")
    refusing(tiff(noise(2, np.uint16), 1), "transparent grey")
    refusing(tiff(noise(5), 2), "5 channels")
    refusing(tiff(noise(1), 2), "1 channels")
    refusing(tiff(noise(3), 8), "rare colour space")


def test_eight_bit_planes_are_put_together(reading):
    colour = noise(3)
    is_luminance(reading(tiff(colour, 2, planar=True)), colour)


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.cr2", b"II*\0\x10\0\0\0CR\x02\0" + bytes(99)),
        ("renamed.tif", b"II*\0\x10\0\0\0CR\x02\0" + bytes(99)),
        ("a.CR3", b"\0\0\0\x18ftypcrx \0\0\0\x01crx isom" + bytes(99)),
        ("a.nef", tiff(ramp(), 1)),
        ("preview.tif", tiff(ramp(), 1, t254=1)),
        ("a.dng", tiff(ramp(), 1)),
        ("mosaic.tif", tiff(ramp(np.uint16), 32803)),
        ("a.arw", b"whatever"),
        ("fuji", b"FUJIFILMCCD-RAW 0201" + bytes(99)),
    ],
)
def test_raw_file_is_refused_and_told_to_develop_it(refusing, name, data):
    assert "without lens correction" in refusing(data, "RAW file", name).remedy


def test_pixels_that_begin_like_a_raw_file_are_no_raw_file(reading):
    image = ramp()
    image[0, :4] = list(b"CR\x02\0")
    assert np.array_equal(reading(tiff(image, 1)), image)


@pytest.mark.parametrize("brand", [b"heic", b"mif1", b"avif"])
def test_pictures_of_telephones_are_refused_and_told_to_develop_them(refusing, brand):
    assert "without lens correction" in refusing(b"\0\0\0\x18ftyp" + brand + bytes(99), "HEIC or AVIF").remedy


@pytest.mark.parametrize(
    ("data", "named"),
    [
        (b"", "is an empty file"),
        (b"this is no photograph", "is not an image file that is known"),
        (b"GIF89a" + bytes(99), "is a GIF file"),
        (b"RIFF\x10\0\0\0WEBPVP8 " + bytes(99), "is a WebP file"),
        (b"\0\0\0\x18ftypmp42" + bytes(99), "is a film"),
        (b"%PDF-1.7", "is a PDF file"),
        (b"II+\0\x08\0\0\0" + bytes(99), "is a BigTIFF file"),
        (b"Pf\n4 4\n-1.0\n" + bytes(64), "is not an image file that is known"),
    ],
)
def test_other_files_are_refused_by_their_names(refusing, data, named):
    refusing(data, named)


def test_jpeg_of_a_rare_kind_is_refused(refusing):
    data = jpeg(ramp())
    at = data.index(b"\xff\xc0")
    refusing(data[: at + 1] + b"\xc3" + data[at + 2 :], "lossless")
    refusing(data[: at + 4] + b"\x0c" + data[at + 5 :], "12-bit")


@pytest.mark.parametrize("size", [(100_001, 8), (8, 100_001), (99_999, 99_999), (0, 8), (2**31, 2**31)])
def test_sizes_beyond_reason_are_refused_before_memory_is_taken(refusing, size):
    data = png([bytes(8)] * 8, 8, 8, 0)
    header = struct.pack(">IIBBBBB", *size, 8, 0, 0, 0, 0)
    refusing(data[:8] + chunk(b"IHDR", header) + data[33:], f"says it has {size[0]} x {size[1]} pixels")
    if max(size) < 2**31:
        refusing(f"P5\n{size[0]} {size[1]}\n255\n".encode(), "cut off" if min(size) else "pixels")


def test_file_beyond_two_gigabytes_is_refused_unread(tmp_path):
    path = tmp_path / "film.png"
    with path.open("wb") as file:
        file.truncate(MOST_BYTES + 1)  # a hole: takes no space
    with pytest.raises(InputError, match="larger than 2 GB"):
        read_grey(path)


def test_folder_and_missing_file_are_refused(tmp_path):
    for path in (tmp_path, tmp_path / "gone.png"):
        with pytest.raises(InputError, match="cannot be read"):
            read_grey(path)


# ---------------------------------------------------------------- a station's photographs


@pytest.fixture
def station(tmp_path):
    """A station of two cameras of 64 x 48 pixels; the first one's photograph is a ramp."""
    interior = OpenCVInterior(WIDTH, HEIGHT, 100.0, 100.0, 31.5, 23.5)
    cameras = tuple(Camera(f"camera{i}", interior, np.eye(3), np.array([600.0 * i, 0, 0])) for i in range(2))
    images = tuple(tmp_path / f"image{i}.png" for i in range(2))
    for image in images:
        image.write_bytes(encoded(".png", ramp()))
    return Station("small", cameras, images, tmp_path / "station.json")


def test_photograph_of_a_station_is_read(station):
    assert np.array_equal(read_image(station, 1), ramp())


def test_image_of_another_size_is_refused_with_both_sizes(station):
    station.images[1].write_bytes(encoded(".png", ramp().T))
    with pytest.raises(InputError, match="48 x 64 pixels, the calibration is for 64 x 48") as error:
        read_image(station, 1)
    assert (error.value.source, error.value.key) == (str(station.source), "cameras[1].image")


@pytest.mark.parametrize("content", [b"", b"no image", b"\x89PNG\r\n\x1a\n"], ids=["empty", "text", "torn"])
def test_photograph_that_is_refused_is_named_with_its_place_in_the_station(station, content):
    station.images[0].write_bytes(content)
    with pytest.raises(InputError, match=r"station\.json: cameras\[0\]\.image: .*image0\.png is ") as error:
        read_image(station, 0)
    assert error.value.key == "cameras[0].image"
