# SPDX-License-Identifier: Apache-2.0
"""Pages on which autodoc and breathe write the APIs of Python and C++."""

from reference.pages import ROOT

ABOUT = {
    "kiva_plugin_cpp": "The world in a Python process.",
    "warehouse_layout": "Floors, layout files, formats of other programs.",
    "warehouse_client": "What programs that talk to the world share.",
    "warehouse_fleet": "Planning for a fleet, and driving it.",
    "warehouse_operations": "Orders, stock, stations, shifts, policies.",
    "warehouse_vda5050": "VDA 5050: vehicles, master, drivers.",
    "warehouse_learning": "Environments to learn in.",
    "warehouse_viewer": "Pages, HTTP API, recordings, markers for RViz, pictures.",
    "warehouse_sim": "What the nodes of a launch share.",
}

# It has an environment of its own, and is called by the Model Context Protocol, not from Python.
WITHOUT_API = {"warehouse_assistant"}

OPTIONS = {
    "kiva_plugin_cpp": [":imported-members:"],
    "warehouse_fleet": [":exclude-members: Floor, FloorError"],  # of warehouse_layout
}


def modules(package: str) -> list[str]:
    """Returns a package's public modules, the package itself first."""
    top = ROOT / "src" / package / "python"
    names = []
    for file in sorted(top.rglob("*.py")):
        parts = file.relative_to(top).with_suffix("").parts
        if any(part.startswith("_") for part in parts if part != "__init__"):
            continue
        names.append(".".join(part for part in parts if part != "__init__"))
    return sorted(names)


def python(package: str) -> str:
    """Returns the page of a Python package."""
    parts = [f"# {package}", ABOUT[package]]
    for module in modules(package):
        options = [":members:", ":undoc-members:", ":show-inheritance:", *OPTIONS.get(module, [])]
        if "." in module:
            options.append(":ignore-module-all:")  # what is another's is described there
        lines = "\n".join(f"   {option}" for option in options)
        parts.append(f"## {module}\n\n```{{eval-rst}}\n.. automodule:: {module}\n{lines}\n```")
    return "\n\n".join(parts) + "\n"


NAMESPACES = {"kiva": "The world.", "fleet": "The planner.", "layout": "Floors and their check."}
LIBRARIES = (
    "Link `kiva_core` (the world), `kiva_world_file` (SDF, URDF), "
    "`warehouse_fleet_planner` (the planner) or `warehouse_layout` (floors)."
)


def cpp(namespace: str) -> str:
    """Returns the page of a C++ namespace."""
    directive = f".. doxygennamespace:: {namespace}\n   :content-only:\n   :members:"
    about = f"# C++: {namespace}\n\n{NAMESPACES[namespace]} {LIBRARIES}"
    return f"{about}\n\n```{{eval-rst}}\n{directive}\n```\n"
