# SPDX-License-Identifier: Apache-2.0
"""The generated reference lacks nothing that the code has."""

import re
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from functools import cache

import pytest
from paths import ROOT

sys.path.append(str(ROOT / "scripts"))

from reference import (
    PAGES,
    apis,
    commands,
    events,
    http,
    launching,
    messages,
    numbers,
    policies,
    topics,
)

SOURCES = [
    *ROOT.glob("src/*/nodes/*"),
    *ROOT.glob("src/*/python/**/*.py"),
    *ROOT.glob("src/kiva_plugin_cpp/src/ros/**/*.cpp"),
]
BACK = re.compile(r"sentence|(?i:correct the value)|what (?:is|was) (?:accepted|expected)")
MANY = 40  # refusals that one advice may be for
# No topic and no service: parameters, files, and beginnings of names.
OTHERS = {
    "/warehouse/checkpoints",
    "/warehouse/keyframe",
    "/warehouse/sizes",
    "/warehouse/building",
    "/gazebo/autosave",
}


def test_each_page_is_led_to():
    led = set()
    for index in (ROOT / "doc/reference").rglob("index.md"):
        for block in re.findall(r"```\{toctree\}(.*?)```", index.read_text(), re.S):
            names = [line for line in block.split() if not line.startswith(":")]
            folder = index.parent.relative_to(ROOT / "doc/reference")
            led |= {str(folder / name) for name in names}
    assert {page.removesuffix(".md") for page in PAGES} <= led


@pytest.mark.parametrize("title", messages.FOLDERS)
def test_each_message_service_and_action_says_what_it_is(title):
    written = messages.written(title)
    for file in (ROOT / "src").glob(f"*/{messages.FOLDERS[title]}/*.{messages.FOLDERS[title]}"):
        heading = f"## {file.parts[-3]}/{file.stem}"
        assert heading in written
        about = written.partition(heading)[2].partition("```")[0]
        assert about.strip() or "gazebo_msgs" in heading, f"{heading} has no comment"


def named():
    """Names of the ROS graph that stand in the code."""
    names = set()
    for source in SOURCES:
        if not source.is_file():
            continue
        text = source.read_text()
        pattern = r'"/?((?:warehouse|gazebo)/\w+(?:/\w+)*)"'
        names |= {f"/{name}" for name in re.findall(pattern, text)}
        names |= {
            f"/gazebo/{name}"
            for name in re.findall(r'node\.advertiseService(?:<[^>]*>)?\("(\w+)"', text)
        }
        names |= {f"/gazebo/{name}" for name in re.findall(r'node\.subscribe\("(\w+)"', text)}
        names |= {
            f"/warehouse/{name}" for name in re.findall(r'(?:_publisher|_queued)\("(\w+)"', text)
        }
        offered = re.findall(r'^ +\("(\w+)", srv\.\w+', text, re.M)
        names |= {f"/warehouse/{name}" for name in offered}
    return names - OTHERS


def test_names_are_relative_so_that_a_namespace_holds_them():
    makes = r"(?:Subscriber|Publisher|Service|ServiceProxy|advertise\w*|subscribe|follow|publish"
    makes += r"|wait_for_\w+|\w+_param|is_offered)(?:<[^>]*>)?"
    absolute = [
        (source.name, name)
        for source in SOURCES
        if source.is_file()
        for name in re.findall(makes + r'\((?:\w+, )?\s*f?"(/[^"]*)"', source.read_text())
    ]
    assert absolute == []


def test_each_topic_and_service_is_listed():
    parameters = {name for asked in launching.asked().values() for name in asked} | set(
        launching.SHARED
    )
    lacking = {name for name in named() - parameters if f"`{name}`" not in topics.written()}
    assert not lacking
    assert len(named()) > 60


@pytest.mark.parametrize(
    "kind",
    [*topics.names("published"), *topics.names("taken"), *topics.services()],
    ids=lambda kind: kind.name,
)
def test_each_listed_type_of_ours_exists(kind):
    package, name = kind.type.split("/")
    if package in messages.PACKAGES:
        kinds = [ROOT / "src" / package / folder / f"{name}.{folder}" for folder in ("msg", "srv")]
        assert any(path.exists() for path in kinds), kind.type


@pytest.mark.parametrize("service", topics.services(), ids=lambda service: service.name)
def test_each_service_says_what_it_does(service):
    assert service.note or topics.about(service.type), service.name


def test_each_launch_argument_is_explained():
    written = launching.launches()
    for file in ROOT.glob("src/*/launch/*.launch"):
        for argument in ElementTree.parse(file).getroot().iter("arg"):
            if "default" in argument.attrib:
                assert f"`{argument.get('name')}`" in written and argument.get("doc"), (
                    f"{file.name}: {argument.get('name')}"
                )


def test_each_parameter_is_explained():
    known = launching.meanings()
    lacking = [
        (file, name)
        for file, names in launching.asked().items()
        for name in names
        if name.startswith("~") and not known.get(name)
    ]
    assert not lacking
    read = set(
        re.findall(
            r'(?:number|rate|flag|text|folders|path|whole)\w*\(node, "(\w+)"',
            (ROOT / "src/kiva_plugin_cpp/src/ros/settings.cpp").read_text(),
        )
    )
    assert {f"~{name}" for name in read} <= launching.settings().keys()
    for file, names in launching.asked().items():
        for name in names:
            assert f"`{name}`" in launching.parameters(), (file, name)


def test_each_request_is_described():
    written = http.written()
    for path, methods in http.described()["paths"].items():
        for method, operation in methods.items():
            assert f"### {method.upper()} {path}" in written
            assert operation.get("description") or operation.get("summary"), (method, path)
    for path in http.described()["x-websockets"]:
        assert f"### {path}" in written


def test_each_program_says_what_it_does():
    for program in commands.programs():
        if program.name in commands.NODES or not commands.is_command(program):
            assert commands.docstring(program), program
    assert {program.name for program in commands.programs() if commands.is_command(program)} >= {
        "simulate",
        "size",
        "sweep",
        "layout",
        "drive",
    }


def test_rosrun_finds_each_program():
    for program in filter(commands.is_command, commands.programs()):
        path = ROOT / "devel/lib" / commands.package(program) / program.name
        assert path.exists(), f"rosrun {commands.package(program)} {program.name}"


def test_each_module_that_is_called_says_what_it_does():
    modules = {*commands.modules()}
    assert {"warehouse_learning.marl.robots", "warehouse_learning.baselines"} <= modules
    for module in commands.modules():
        assert "usage: " in commands.helped(["-m", module])


def test_each_policy_is_listed():
    from warehouse_operations.policies import ROLES

    written = policies.written()
    for role, names in ROLES.items():
        section = written.partition(f"## {role}\n")[2].partition("\n## ")[0]
        for name, kind in names.items():
            assert f"`{name}`" in section
            assert policies.about(kind), f"{role}: {name} has no docstring"


def test_each_realism_number_is_listed_with_its_default():
    from kiva_plugin_cpp import World

    sections = dict.fromkeys(numbers.sections(), True)
    world = World.preset("empty", realism=sections)
    assert world.realism.keys() == sections.keys()
    written = numbers.realism()
    for section, values in world.realism.items():
        table = written.partition(f"## {section}\n")[2].partition("\n## ")[0]
        rows = {
            name: float(default) for name, default in re.findall(r"\| `(\w+)` \| (\S+) \|", table)
        }
        known = {name: value for name, value in values.items() if name != "enabled"}
        assert rows.keys() == known.keys(), section
        assert all(rows[name] == pytest.approx(value) for name, value in known.items()), section


def test_each_plugin_parameter_is_listed():
    written = numbers.plugins()
    for file in (ROOT / "src/kiva_plugin_cpp/src").rglob("*.cpp"):
        for name in re.findall(
            r'\bp\.(?:number|text|flag|whole|numbers)\("(\w+)"', file.read_text()
        ):
            assert f"`{name}`" in written, (file.name, name)
    assert len(numbers.tabled()) == (
        ROOT / "src/kiva_plugin_cpp/src/ros/gazebo_plugins/plugin_table.cpp"
    ).read_text().count('.so", maker<')


def test_each_kind_of_event_is_listed():
    from warehouse_client import message_names

    written = events.written()
    for name in message_names.EVENT.values():
        assert f"`{name}`" in written
    assert "no robot can reach station … and return" in written
    assert "there is no world '…'; tried …" in written


def test_each_refusal_is_listed():
    written = re.sub(r"\\(.)", r"\1", events.written())
    for file in (ROOT / "src").glob("*/src/**/*.cpp"):
        for text in re.findall(r'throw [\w:]+\(\s*"([^"\\%]+)"', file.read_text()):
            if events.is_sentence(text):
                assert text.strip() in written, (file.name, text)
    assert "it carries nothing" in written and "is off the grid of … m" in written


def advised():
    """Counts the refusals of each advice."""
    return Counter(
        events.advice(package, sentence, place)
        for package, sentences in events.refusals().items()
        for sentence, place in sentences
    )


def test_each_refusal_says_what_to_do():
    lacking = [
        f"{package}/{place}: {sentence}"
        for package, sentences in events.refusals().items()
        for sentence, place in sentences
        if not events.advice(package, sentence, place)
    ]
    assert not lacking, "scripts/reference/advice.txt has no line for these"


def test_no_advice_is_general():
    """What only sends back to the sentence, or fits too many of them, tells nothing new."""
    assert [advice for advice in advised() if BACK.search(advice)] == []
    assert {advice: count for advice, count in advised().items() if count > MANY} == {}


def test_each_advice_is_of_use():
    assert {advice for *_, advice in events.advices()} <= set(advised())
    assert events.advice("warehouse_fleet", "green cheese", "elsewhere.py") == ""


@cache
def slugs(page):
    """Returns what links name the headings of a page of the reference by, as MyST does."""
    file = ROOT / "doc/reference" / page
    text = file.read_text() if file.is_file() else PAGES[page]()
    heads = re.findall(r"^#+ (.*)", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S), re.M)
    plain = [re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", head).strip().lower() for head in heads]
    return {re.sub(r"[^\w\- ]", "", head.replace(" ", "-")) for head in plain}


@pytest.mark.parametrize("advice", sorted({advice for *_, advice in events.advices()}))
def test_each_advice_leads_to_a_place(advice):
    for page, place in re.findall(r"\]\(([^)#]+)#?([^)]*)\)", advice):
        there = page in PAGES or (ROOT / "doc/reference" / page).is_file()
        assert there, page
        assert not place or place in slugs(page), f"{page} has {sorted(slugs(page))}"


def test_each_key_of_a_layout_file_is_listed():
    text = (ROOT / "doc/reference/layouts.md").read_text()
    from warehouse_layout.file import layout_reader

    for key in (*layout_reader._KEYS, *layout_reader._STATION_KEYS):
        assert f"`{key}`" in text or f"{{{key}:" in text, key


def test_each_package_has_its_python_api():
    have = {path.parent.parent.name for path in ROOT.glob("src/*/python/*/__init__.py")} - {
        "python"
    }
    packages = {path.parts[-2] for path in ROOT.glob("src/*/python")}
    assert packages == set(apis.ABOUT) | apis.WITHOUT_API, have
    for name in apis.ABOUT:
        page = apis.python(name)
        for module in apis.modules(name):
            assert f".. automodule:: {module}\n" in page


def test_each_public_header_is_in_a_listed_namespace():
    for package in ("kiva_plugin_cpp", "warehouse_fleet", "warehouse_layout"):
        for header in (ROOT / "src" / package / "include").rglob("*.h"):
            names = re.findall(r"^namespace (\w+)", header.read_text(), re.M)
            assert not names or set(names) & (set(apis.NAMESPACES) | {"py", "warehouse"}), header
