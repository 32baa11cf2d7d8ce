# SPDX-License-Identifier: Apache-2.0
"""Maps of map_server become floors: askew, noisy, black on white or the other way."""

import math
import re

import numpy as np
import pytest
from scipy import ndimage

from warehouse_layout import convert as formats
from warehouse_layout.convert import FormatError
from warehouse_layout.place import placement

RESOLUTION = 0.05
ROOM = (12.0, 8.0)  # inner size [m]


def picture(degrees=0.0, noise=0.0, seed=1):
    """A room with a wall that ends in it and a pillar, seen by SLAM: (h, w) grey values.

    0 is occupied, 205 was never seen, 254 is free; row 0 is the highest.
    """
    rng = np.random.default_rng(seed)
    height, width = 260, 340
    rows, columns = np.indices((height, width))
    x, y = (columns - width / 2 + 0.5) * RESOLUTION, (height / 2 - rows - 0.5) * RESOLUTION
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y = c * x + s * y, c * y - s * x  # in the room's frame
    waver = rng.normal(0, noise, (height, width))
    inside = np.maximum(abs(x) - ROOM[0] / 2, abs(y) - ROOM[1] / 2)
    grey = np.where(inside < 0, 254, 205)
    thick = 2 * RESOLUTION
    walls = (inside + waver >= 0) & (inside + waver < thick)
    walls |= (abs(x + 0.5 + waver) < thick / 2) & (y > 0) & (inside < 0)
    walls |= (abs(x - 3.5) < 0.2) & (abs(y + 1.5) < 0.2)
    grey[walls] = 0
    if noise:
        grey[(rng.random(grey.shape) < 0.002) & (inside < 0)] = 0
        grey[(rng.random(grey.shape) < 0.01) & (inside > thick)] = 254
    return grey.astype(np.uint8)


def write_map(folder, grey, plain=False, **fields):
    height, width = grey.shape
    header = f"P{2 if plain else 5}\n# made by a test\n{width} {height}\n255\n"
    if plain:
        text = "\n".join(" ".join(map(str, row)) for row in grey.tolist())
        (folder / "m.pgm").write_text(header + text)
    else:
        (folder / "m.pgm").write_bytes(header.encode() + grey.tobytes())
    values = {
        "image": "m.pgm",
        "resolution": RESOLUTION,
        "origin": "[-3.0, -2.0, 0.0]",
        "negate": 0,
        "occupied_thresh": 0.65,
        "free_thresh": 0.196,
    } | fields
    path = folder / "map.yaml"
    path.write_text("".join(f"{k}: {v}\n" for k, v in values.items()))
    return path


def read(path, **options):
    """The layout, and what is no mere note."""
    file, notes = formats.read(path, **options)
    return file, [note for note in notes if not isinstance(note, formats.Note)]


EXPECTED = [
    "##############",
    "#.....#......#",
    "#.....#......#",
    "#.....#......#",
    "#.....#......#",
    "#............#",
    "#.........#..#",
    "#............#",
    "#............#",
    "##############",
]


@pytest.mark.parametrize("plain", [False, True])
def test_a_clean_map(tmp_path, plain):
    file, notes = read(write_map(tmp_path, picture(), plain))
    assert notes == []
    assert similar(file.floor) >= 0.97


def similar(floor):
    """The share of cells that are as they are in EXPECTED, whichever way the grid was laid."""
    best = 0.0
    for dy in range(-1, 2):
        for dx in range(-1, 2):
            same = 0
            for row, line in enumerate(EXPECTED):
                for column, character in enumerate(line):
                    i, j = len(EXPECTED) - 1 - row + dy, column + dx
                    inside = 0 <= i < floor.shape[0] and 0 <= j < floor.shape[1]
                    same += (floor[i, j] if inside else "?") == character
            best = max(best, same / (len(EXPECTED) * len(EXPECTED[0])))
    return best


@pytest.mark.parametrize("spacing", [0.5, 1.0, 2.0])
def test_a_wall_of_one_pixel_closes(tmp_path, spacing):
    grey = np.full((400, 400), 254, np.uint8)
    grey[[0, -1]] = grey[:, [0, -1]] = grey[:, 137] = 0
    file, _ = formats.read(write_map(tmp_path, grey), spacing=spacing)
    labels, parts = ndimage.label(file.floor == ".")
    assert parts == 2


@pytest.mark.parametrize("degrees", [2.0, -7.0, 31.0])
def test_a_slam_map_is_straightened(tmp_path, degrees):
    file, notes = formats.read(write_map(tmp_path, picture(degrees, noise=0.015)))
    turned = float(notes[0].split()[2])
    assert turned == pytest.approx(-degrees, abs=0.3)
    assert similar(file.floor) > 0.9
    assert any("of noise left out" in sentence for sentence in notes)


def test_an_angle_given_and_a_yaw(tmp_path):
    path = write_map(tmp_path, picture(10.0))
    file, notes = formats.read(path, angle=math.radians(-10))
    assert notes[0] == "turned by -10.00 degrees" and similar(file.floor) > 0.9
    # With the yaw in the file the map lies along the axes already.
    path = write_map(tmp_path, picture(10.0), origin=f"[0, 0, {math.radians(-10)}]")
    file, notes = read(path)
    assert not any("turned" in note for note in notes) and similar(file.floor) > 0.9


def test_negate_png_and_spacing(tmp_path):
    from PIL import Image

    path = write_map(tmp_path, picture(), negate=1, image="m.png", free_thresh=0.15)
    Image.fromarray(255 - picture()).save(tmp_path / "m.png")
    file, _ = formats.read(path, spacing=0.5)
    assert file.spacing == 0.5
    assert (file.floor == ".").sum() == pytest.approx(4 * 96, rel=0.12)


def test_a_thousand_cells_square(tmp_path):
    grey = np.full((1000, 1000), 254, np.uint8)
    grey[[0, -1]] = grey[:, [0, -1]] = 0
    path = write_map(tmp_path, grey, resolution=0.5)
    file, notes = read(path, spacing=0.5)
    assert file.shape == (1000, 1000)
    assert notes == ["poses of the map are moved by (-0.25, -0.25) m, to the middle of cells"]
    assert (file.floor == "#").sum() == 3996


@pytest.mark.parametrize(
    "fields, message",
    [
        ({"resolution": -1}, "map.yaml: resolution is -1; a number from"),
        ({"resolution": ".nan"}, "resolution is nan; a number from"),
        ({"resolution": "fine"}, "resolution is 'fine'"),
        ({"origin": "[1, 2]"}, "origin is .*; x, y .m. and yaw .rad. were expected"),
        ({"origin": "[1, 2, .nan]"}, "write nan as the yaw of a map that is not turned: make it 0"),
        ({"image": "none.pgm"}, "none.pgm: No such file"),
        ({"image": "map.yaml"}, "a PGM .*, BMP or PNG was expected"),
        ({"image": "[1"}, r"map.yaml:\d: is not YAML"),
        ({"mode": "grey"}, "mode is 'grey'; trinary"),
        ({"free_thresh": 0.0}, "no pixel is free"),
        ({"resolution": 9.9}, "1 to 4000000 cells were expected"),
    ],
)
def test_a_wrong_map_is_reported(tmp_path, fields, message):
    grey = np.full((900, 900), 254, np.uint8)
    with pytest.raises(FormatError, match=message):
        formats.read(write_map(tmp_path, grey, **fields))


@pytest.mark.parametrize(
    "data, message",
    [
        (b"P5\n4 4\n255\n123", "3 pixels; 4 x 4 were expected"),
        (b"P5\n99999 99999\n255\n", "99999 x 99999 pixels"),
        (b"P5\n4 x\n255\n", "height is 'x'"),
        (b"P2\n2 1\n255\n7 white", "a pixel is not a number"),
        (b"P5", "width is ''"),
        (b"\x89PNG\r\n\x1a\nabc", "the PNG can't be read"),
    ],
)
def test_a_broken_picture_is_reported(tmp_path, data, message):
    path = write_map(tmp_path, picture())
    (tmp_path / "m.pgm").write_bytes(data)
    with pytest.raises(FormatError, match=message) as error:
        formats.read(path)
    assert str(tmp_path / "m.pgm") in str(error.value)


def test_a_missing_file_is_reported(tmp_path):
    with pytest.raises(FormatError) as error:
        formats.read(tmp_path / "none.yaml")
    assert str(error.value) == f"{tmp_path}/none.yaml: No such file or directory"


def small(pixels, degrees):
    """A room of so many pixels by four fifths of that, turned: (h, w) grey values."""
    rows, columns = np.indices((2 * pixels + 6, 2 * pixels + 6)) - (pixels + 2.5)
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y = c * columns - s * rows, -c * rows - s * columns
    inside = np.maximum(abs(x) - pixels / 2, abs(y) - 0.4 * pixels)
    grey = np.where(inside < 0, 254, 205)
    grey[(inside >= 0) & (inside < 1.2)] = 0
    return grey.astype(np.uint8)


@pytest.mark.parametrize("pixels", [10, 20, 60])
def test_how_sure_the_angle_of_a_small_picture_is(tmp_path, pixels):
    for degrees in (-41.0, -29.5, -12.0, 7.0, 17.3, 32.7, 38.0):
        path = write_map(tmp_path, small(pixels, degrees), resolution=0.5)
        _, notes = formats.read(path, spacing=0.5)
        words = notes[0].split()
        assert words[:2] == ["turned", "by"] and words[3:7] == ["degrees,", "give", "or", "take"]
        assert "--angle sets it" in notes[0]
        off = (float(words[2]) + degrees + 45) % 90 - 45
        assert abs(off) <= float(words[7].rstrip(":")) <= math.degrees(1.6 / pixels)


# --- pixels, as map_server reads them


def server(path, occupied=0.65, free=0.196, mode="trinary", negate=False):
    """What map_server publishes, pixel by pixel, as image_loader.cpp has it."""
    from PIL import Image

    picture = Image.open(path)
    deep = {"L": "L", "P": "RGB", "RGB": "RGB", "RGBA": "RGBA", "LA": "RGBA"}[picture.mode]
    pixels = np.asarray(picture.convert(deep)).reshape(picture.size[1], picture.size[0], -1)
    out = np.zeros(pixels.shape[:2], int)
    for at in np.ndindex(out.shape):
        channels = pixels[at].tolist()
        alpha = channels[3] / 255 if len(channels) == 4 else 1.0
        used = channels if mode == "trinary" or len(channels) < 4 else channels[:3]
        average = sum(used) / len(used)
        average = 255 - average if negate else average
        if mode == "raw":
            out[at] = round(average) if round(average) <= 100 else -1
            continue
        chance = (255 - average) / 255
        if chance > occupied:
            out[at] = 100
        elif chance < free:
            out[at] = 0
        elif mode == "trinary" or alpha < 1:
            out[at] = -1
        else:
            out[at] = int(99 * (chance - free) / (occupied - free))
    return out


@pytest.mark.parametrize("mode", ["trinary", "scale", "raw"])
@pytest.mark.parametrize("negate", [False, True])
@pytest.mark.parametrize("kind", ["L png", "RGB bmp", "RGBA png", "L bmp"])
def test_pixels_are_read_as_map_server_does(tmp_path, mode, negate, kind):
    from PIL import Image

    from warehouse_layout.convert.maps import images, ros_map

    colours, suffix = kind.split()
    shape = (16, 16) if colours == "L" else (16, 16, len(colours))
    grey = np.random.default_rng(4).integers(0, 256, shape).astype(np.uint8)
    grey.flat[:8] = [0, 100, 101, 205, 206, 254, 255, 89]
    path = tmp_path / f"m.{suffix}"
    Image.fromarray(grey, colours).save(path)
    values = ros_map.occupancy(images.read(path), mode, negate, ros_map.Thresholds(0.65, 0.25))
    assert (values == server(path, 0.65, 0.25, mode, negate)).all()


def test_what_was_never_seen_is_no_floor_whatever_the_thresholds(tmp_path):
    usual, _ = formats.read(write_map(tmp_path, picture()))
    file, notes = formats.read(write_map(tmp_path, picture(), free_thresh=0.25))
    assert (file.floor == usual.floor).all()
    unseen = int((picture() == 205).sum())
    assert notes[0].startswith(f"205 of a picture in 0, 205 and 254 is unknown: {unseen:,} pixels")
    free, walls = int((picture() == 254).sum()), int((picture() == 0).sum())
    assert notes[-1] == (
        f"of {340 * 260:,} pixels {free:,} are free, {walls:,} occupied, {unseen:,} unknown"
    )
    # Other greys beside them: the thresholds say what they are.
    grey = picture()
    grey[100, 100] = 230
    file, _ = formats.read(write_map(tmp_path, grey, free_thresh=0.25))
    assert (file.floor == ".").sum() > 1.5 * (usual.floor == ".").sum()


def test_a_raw_map(tmp_path):
    raw = np.select([picture() == 0, picture() == 254], [100, 0], 255).astype(np.uint8)
    file, _ = formats.read(write_map(tmp_path, raw, mode="raw"))
    assert similar(file.floor) >= 0.97


def test_poses_of_a_map_hold(tmp_path):
    """The pillar of the room is where the map has it."""
    for origin in ((-3.0, -2.0), (7.0, 11.0), (-3.3, 5.2)):
        path = write_map(tmp_path, picture(), origin=f"[{origin[0]}, {origin[1]}, 0]")
        file, notes = read(path)
        dx, dy = 0.0, 0.0
        for text in notes:
            dx, dy = map(float, re.search(r"moved by \((\S+), (\S+)\) m", text).groups())
        # The pillar's middle in the picture: 3.5 m right of its centre, 1.5 m below.
        pillar = np.add(origin, (17.0 / 2 + 3.5 + dx, 13.0 / 2 - 1.5 + dy))
        column, row = np.round((pillar - file.at) / file.spacing).astype(int)
        assert file.floor[row, column] == "#" and file.floor[row, column - 2] == "."
        assert max(abs(dx), abs(dy)) <= 0.5
        assert placement.origin(file) == file.at and not placement.place(file).units.size


def test_a_picture_of_another_computer_is_found_beside_the_map(tmp_path):
    for name in ("/home/them/maps/m.pgm", "C:\\\\maps\\\\m.pgm"):
        file, notes = formats.read(write_map(tmp_path, picture(), image=f'"{name}"'))
        plain = name.replace("\\\\", "\\")
        assert notes[0] == f"{plain} is not here: m.pgm beside map.yaml was read"
