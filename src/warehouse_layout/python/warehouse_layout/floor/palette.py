# SPDX-License-Identifier: Apache-2.0
"""The colours of a floor plan: on paper, on the floor of a world, in RViz and on the pages."""

# By what a cell is: in the light and in the dark. Robots and units stand out on each.
CELLS = {
    "nothing": ("#e8ecf1", "#0f1216"),  # where no floor is
    "floor": ("#f6f7f9", "#262c35"),
    "grid": ("#d9dee5", "#2f3640"),  # between cells
    "street": ("#dbe5f0", "#29343f"),  # left by some sides alone
    "arrow": ("#8793a0", "#6b7889"),
    "storage": ("#b7cce4", "#38506a"),
    "parking": ("#c3dfd0", "#2b4a3e"),
    "charging": ("#a3d6a8", "#2f6a40"),
    "keep_out": ("#e2e4e8", "#1c2026"),
    "queue": ("#f0e2b4", "#45402c"),
    "service": ("#eab558", "#8a6326"),
    "exit": ("#ebe6cd", "#36352a"),
    "elevator": ("#cfc0e2", "#4f4168"),
    "belt": ("#b8967a", "#8b6a4f"),
    "wall": ("#4a525d", "#aab3bf"),
}
# What a plan on paper has.
PLAN = {kind: light for kind, (light, _) in CELLS.items()} | {
    "paper": "#ffffff",
    "ink": "#2f3640",
    "faint": "#8a94a0",
    "unit": "#5b7fa6",
    "bolt": "#2f7d32",
    "stripe": "#c9c1b4",
    "replenish": "#7fb8d8",
    "lane": "#a8741a",
    "elevator": "#7a5ba6",
    "robot": "#d8502a",
    "fault": "#c2182b",
}


def rgb(kind: str) -> tuple[float, ...]:
    """Returns red, green and blue of a kind of cell in the light, 0…1; the floor's for others."""
    light, _ = CELLS.get(kind, CELLS["floor"])
    return tuple(int(light[i : i + 2], 16) / 255 for i in (1, 3, 5))


def css() -> str:
    """Returns the rules that set the variables --cell-KIND of a page."""
    light, dark = (
        "".join(f"--cell-{kind}:{colours[i]};" for kind, colours in CELLS.items()) for i in (0, 1)
    )
    return f':root{{{dark}}}:root[data-theme="light"]{{{light}}}'
