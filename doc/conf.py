# SPDX-License-Identifier: Apache-2.0
"""How Sphinx builds the documentation; scripts/docs prepares its sources and calls it."""

import re

project = "Kiva warehouse"
author = "the authors of Kiva warehouse"
copyright = "the authors of Kiva warehouse, Apache License 2.0"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton", "breathe"]
html_theme = "furo"
html_title = "Kiva warehouse"
html_static_path = ["_static"]
html_css_files = ["tables.css"]
html_favicon = "_static/icon.svg"
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {"navigation_with_keys": True}
templates_path = []
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["pictures"]
highlight_language = "none"  # a block without a language is a terminal, a drawing or a formula
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence", "deflist"]
copybutton_prompt_text = r"\$ "
copybutton_prompt_is_regexp = True

breathe_projects = {"kiva": "xml"}
breathe_default_project = "kiva"
breathe_default_members = ("members",)
cpp_id_attributes = []

# Classes of two packages may have one name; an annotation leads to either.
suppress_warnings = ["ref.python"]
# Not in Debian; only annotations and base classes need them.
autodoc_mock_imports = ["gymnasium", "pettingzoo", "networkx", "ray", "torch", "stable_baselines3"]
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_class_signature = "mixed"


def plain(app, what, name, obj, options, lines):
    """Turns a docstring, which is prose with `names` and indented blocks, into reStructuredText."""
    out, block, listed = [], False, False
    for line in lines:
        if line.startswith("  ") and not block and listed:
            line = line.strip()  # of an item, which goes on
        listed = line.startswith("- ") or (listed and bool(line.strip()))
        indented = line.startswith(" ") or (block and not line.strip())
        if indented and not block:
            out += ["", "::", ""]
        elif block and not indented:
            out.append("")
        out.append(line if indented else _escaped(line))
        block = indented
    lines[:] = [*out, ""]


def _escaped(line):
    """A line of prose: `name` is code, and no other character has a meaning."""
    parts = re.split(r"`([^`]*)`", line)
    words = [re.sub(r"([\\*_|<>:#.\-+=~^])", r"\\\1", part) for part in parts[::2]]
    codes = [f"\\ ``{code}``\\ " if code.strip() == code and code else code for code in parts[1::2]]
    return "".join(word + code for word, code in zip(words, [*codes, ""]))


def adopt(app, doctree):
    """Has all nodes of a page know its document alone.

    A block of eval-rst has one of its own, with the whole environment: 100 MB for a page that is
    kept, which takes minutes to write and to read.
    """
    for node in doctree.findall():
        node.document = doctree


def setup(app):
    """Connects what reads docstrings and pages."""
    app.connect("autodoc-process-docstring", plain)
    app.connect("doctree-read", adopt)
