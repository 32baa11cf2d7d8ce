# SPDX-License-Identifier: Apache-2.0
"""Checks, draws, converts and makes layout files of warehouses.

A layout file, NAME.layout.yaml, is a drawing of the floor with a character a cell, and what stands
on it: see doc/reference/layouts.md. Cells are named [column, row]: columns from the left, rows
from the bottom, both from 0.
"""

import argparse
import math
import re
import sys
from collections.abc import Sequence
from pathlib import Path

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.file.request import (
    LIMITS,
    PRESETS,
    Request,
    RequestError,
    check_stations,
    items_for,
    resolve,
)
from warehouse_layout.generate import compact, generated, generator
from warehouse_layout.place import file_check, placement

BAD_FILE, WRONG_USAGE = 1, 2  # exit codes
EMPTY = "empty"


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the program; returns its exit code."""
    args = _parser().parse_args(arguments)
    try:
        code: int = args.run(args)
        return code
    except RequestError as error:
        print(f"layout: {error}", file=sys.stderr)
        return WRONG_USAGE
    except (ValueError, OSError) as error:  # errors of files, of whatever format
        print(f"layout: {error}", file=sys.stderr)
        return BAD_FILE


def _check(args: argparse.Namespace) -> int:
    file = lf.read(args.file)
    faults = file_check.faults(file) or file_check.lacks(file)
    for fault in faults:
        print(f"{args.file}: {fault.text}")
    if not faults:
        print(f"{args.file}: a fleet can work on it: {_summary(file)}")
        for remark in file_check.remarks(file):
            print(f"{args.file}: {remark}")
        if all(station.kind == "replenish" for station in file.stations):
            print(f"{args.file}: no order can be picked: there is no picking station")
    return BAD_FILE if faults else 0


def _draw(args: argparse.Namespace) -> int:
    from warehouse_layout.drawing import draw

    draw.draw(lf.read(args.file), args.out)
    print(args.out)
    return 0


def _world(args: argparse.Namespace) -> int:
    from warehouse_layout.models import world_export

    world_export.write(lf.read(args.file), args.out)
    print(args.out)
    return 0


def _convert(args: argparse.Namespace) -> int:
    from warehouse_layout import convert as formats

    angle = None if args.angle is None else math.radians(args.angle)
    source, target = Path(args.source), Path(args.target)
    notes = formats.convert(source, target, args.layers, spacing=args.spacing, angle=angle)
    for sentence in notes:
        print(sentence)
    lost = [sentence for sentence in notes if not isinstance(sentence, formats.Note)]
    return BAD_FILE if lost and not args.lenient else 0


def _new(args: argparse.Namespace) -> int:
    file = _generated(args)
    lf.write(file, args.out)
    print(f"{args.out}: {_summary(file)}")
    return 0


# --- new


def _generated(args: argparse.Namespace) -> LayoutFile:
    """Returns the file that `new` asks for. Raises RequestError."""
    name = Path(args.out).name.removesuffix(lf.SUFFIX)
    style = _style(args)
    if args.preset and style is None and args.replenish is None and not _has_counts(args):
        return _preset(args.preset)
    request = _request(args)
    like_preset = generated.file_of(request, name) if style is None else None
    if like_preset and args.replenish in (None, _replenishments(like_preset)):
        return like_preset
    replenish = generated.replenishing(request) if args.replenish is None else args.replenish
    default = compact.Style() if generated.is_regular(request) else generated.STYLE
    return compact.of_request(request, replenish, style or default, name)


def _preset(name: str) -> LayoutFile:
    if name == EMPTY:
        raise RequestError("the preset 'empty' has nothing to draw; give counts")
    return generator.of_request(PRESETS[name], name)


def _has_counts(args: argparse.Namespace) -> bool:
    return any(n is not None for n in (args.robots, args.units, args.stations, args.items))


def _request(args: argparse.Namespace) -> Request:
    """Returns the counts: those of the preset, replaced by what is given."""
    base = PRESETS[args.preset] if args.preset else Request()
    robots = base.robots if args.robots is None else args.robots
    units = base.shelves if args.units is None else args.units
    if not args.preset and (args.robots is None or args.units is None):
        raise RequestError("--robots and --units are needed, or the name of a preset")
    if not robots + units:
        raise RequestError("0 robots and 0 storage units; at least one of either was expected")
    items = args.items
    if items is None:
        items = min(items_for(units), base.items or LIMITS["items"])
    checked = resolve("", robots, items, units)
    belts = args.stations if args.stations is not None else base.belts or checked.belts
    check_stations(belts, args.replenish or 0)
    return Request(robots, units, items, belts)


def _style(args: argparse.Namespace) -> compact.Style | None:
    """Returns the Style of a compact floor; None for one like those of the presets."""
    chosen = (args.sides, args.depth, args.aisles, args.block)
    if all(value is None for value in chosen):
        return None
    default = compact.Style()
    block = args.block or (args.depth or default.block[0], default.block[1])
    if args.depth and args.depth != block[0]:
        raise RequestError(
            f"--depth {args.depth} and --block {block[0]}x{block[1]} contradict each other: a block"
            " is depth x length"
        )
    sides = default.sides if args.sides is None else args.sides
    style = compact.Style(sides, block, args.aisles != "two-way")
    style.check()
    return style


def _replenishments(file: LayoutFile) -> int:
    return sum(station.kind == "replenish" for station in file.stations)


# --- words


def _summary(file: LayoutFile) -> str:
    layout = placement.place(file)
    height, width = file.shape
    picks = len(file.stations) - _replenishments(file)
    counts = (
        (len(layout.robots), "robot"),
        (len(layout.units), "storage unit"),
        (picks, "picking station"),
        (_replenishments(file), "replenishment station"),
    )
    words = (f"{n} {noun}{'' if n == 1 else 's'}" for n, noun in counts)
    size = f"{width} x {height} cells of {file.spacing:g} m"
    return f"{', '.join(words)} on {size}"


def _block(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,4})x(\d{1,4})", text)
    if not match:
        raise argparse.ArgumentTypeError(f"'{text}': DEPTHxLENGTH was expected, as 2x8")
    return int(match[1]), int(match[2])


def _suffixed(*suffixes: str) -> "_Suffixed":
    return _Suffixed(suffixes)


class _Suffixed:
    """Takes names of files that end in one of the suffixes."""

    def __init__(self, suffixes: Sequence[str]) -> None:
        self._suffixes = tuple(suffixes)

    def __call__(self, text: str) -> str:
        if not text.lower().endswith(self._suffixes):
            raise argparse.ArgumentTypeError(
                f"'{text}' should end in {' or '.join(self._suffixes)}"
            )
        return text


# --- arguments


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="layout", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    _add(
        commands, "check", _check, "check whether a fleet can work there, and list what hinders it"
    )
    drawing = _add(commands, "draw", _draw, "draw a plan with dimensions and a legend")
    drawing.add_argument(
        "--out", metavar="F.svg|F.png", type=_suffixed(".svg", ".png"), required=True
    )
    world = _add(commands, "world", _world, "write an SDF world in which all of it stands")
    world.add_argument("--out", metavar="F.sdf", type=_suffixed(".sdf", ".world"), required=True)
    _add_convert(commands)
    _add_new(commands)
    return parser


def _add(
    commands: "argparse._SubParsersAction[argparse.ArgumentParser]",
    name: str,
    run: object,
    text: str,
    description: str = "",
) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        help=text,
        description=description or f"{text[0].upper()}{text[1:]}.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    if name in ("check", "draw", "world"):
        parser.add_argument("file", metavar="FILE", help="NAME.layout.yaml")
    parser.set_defaults(run=run)
    return parser


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text}; a number was expected")
    return value


def _positive(text: str) -> float:
    value = _finite(text)
    if value <= 0:
        raise argparse.ArgumentTypeError(f"{text}; a number above 0 was expected")
    return value


def _add_convert(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = _add(commands, "convert", _convert, "write a layout in another format", CONVERT)
    parser.add_argument("source", metavar="IN")
    parser.add_argument("target", metavar="OUT")
    parser.add_argument(
        "--layers", metavar="FILE", type=Path, help="what the layers of a .dxf mean, as YAML"
    )
    parser.add_argument(
        "--spacing", metavar="M", type=_positive, help="edge of a cell of a map or a .dxf [m] (1)"
    )
    parser.add_argument(
        "--angle",
        metavar="DEGREES",
        type=_finite,
        help="turn a map or a .dxf by that (by default so that its walls lie along the axes)",
    )
    parser.add_argument(
        "--lenient", action="store_true", help="exit 0 though something is not carried over"
    )


def _add_new(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = _add(
        commands, "new", _new, "make a layout for a number of robots and storage units", NEW
    )
    presets = [name for name in PRESETS if name != EMPTY]
    parser.add_argument(
        "preset", nargs="?", metavar="PRESET", choices=presets, help=", ".join(presets)
    )
    counts = parser.add_argument_group("what stands there")
    counts.add_argument("--robots", metavar="N", type=int)
    counts.add_argument("--units", metavar="N", type=int, help="storage units")
    counts.add_argument("--stations", metavar="N", type=int, help="picking stations")
    counts.add_argument(
        "--replenish", metavar="N", type=int, help="replenishment stations (half of --stations)"
    )
    counts.add_argument("--items", metavar="N", type=int, help="items (4 a storage unit)")
    style = parser.add_argument_group("a compact floor, instead of one as the presets have")
    style.add_argument(
        "--sides", metavar="1..4", type=int, help="with stations: +x, -x, +y, -y (1)"
    )
    style.add_argument("--depth", metavar="N", type=int, help="storage places between streets (2)")
    style.add_argument("--aisles", choices=("one-way", "two-way"), help="streets (one-way)")
    style.add_argument(
        "--block",
        metavar="DxL",
        type=_block,
        help="storage places of a block, depth x length (2x8)",
    )
    parser.add_argument("--out", metavar="F", type=_suffixed(lf.SUFFIX), required=True)


CONVERT = """Write a layout in another format. The format of IN is detected from its content; the
end of the name of OUT selects the format to write.

in   .layout.yaml .sdf .world .xinst .xlayo .map map.yaml .lif.json .dxf .xml .csv .xlsx
out  .layout.yaml .sdf .map .lif.json .svg .png

What can't be carried over is listed, a line each; then the exit code is 1, unless --lenient."""

NEW = """Make a layout file: a preset, or by counts. Any of the last four options makes a compact
floor: blocks of storage between streets, stations on as many sides as asked.

  layout new medium --out medium.layout.yaml
  layout new --robots 30 --units 400 --stations 8 --sides 2 --out north.layout.yaml"""
