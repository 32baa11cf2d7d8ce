# SPDX-License-Identifier: Apache-2.0
"""Examples that need no warehouse run as they stand; `make docs-test` runs the others."""

import os
import subprocess
import sys

import pytest
from paths import ROOT

sys.path.append(str(ROOT / "scripts"))

from examples.blocks import SHOWN, SkippedError, check, examples, pages
from examples.shells import Session

from examples import links

KNOWN = {*SHOWN, "python", "yaml", "xml", "cpp", "json", "console", "bash"}


def run(*arguments):
    command = [sys.executable, ROOT / "scripts/docs_examples", *arguments]
    return subprocess.run(command, text=True, capture_output=True, check=False)


def test_python_and_yaml_run():
    quick = [page for page in pages() if page.name != "learning.md"]  # tests/learning has these
    done = run("--kind", "python", "yaml", "--", *quick)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count(": ran") > 12
    for line in done.stdout.splitlines():
        assert ": skipped:" not in line or line.split(": skipped: ")[1], line


def test_a_wrong_example_is_told(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# A page\n\n```python\n1 / 0\n```\n\n```yaml\norders: no such policy\n```\n")
    done = run(page)
    assert done.returncode == 1
    assert "ZeroDivisionError" in done.stdout and "there is no 'no such policy'" in done.stdout
    assert "2 failed" in done.stdout


def test_each_block_says_what_it_is():
    blocks = [*examples(pages())]
    assert len(blocks) > 150
    for example in blocks:
        assert example.language in KNOWN, f"{example.place}: {example.language or 'no language'}"
    commands = [example for example in blocks if example.language in ("console", "bash")]
    assert sum("skip" in example.notes for example in commands) < len(commands) / 2


def block(folder, text):
    page = folder / "page.md"
    page.write_text(text)
    (example,) = examples([page])
    return example


def test_notes_say_how_an_example_is_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    example = block(
        tmp_path,
        "<!-- example: file: a.txt -->\n<!-- example: stop: -->\n```bash\nls\n```\n",
    )
    assert example.notes == {"file": "a.txt", "stop": ""} and example.line == 3
    check(example)
    assert (tmp_path / "a.txt").read_text() == "ls\n"
    with pytest.raises(SkippedError, match="no_such_program is not installed"):
        check(block(tmp_path, "<!-- example: needs: no_such_program -->\n```bash\nls\n```\n"))
    with pytest.raises(ValueError, match="skipped: one of skip, needs"):
        block(tmp_path, "<!-- example: skipped: why -->\n```bash\nls\n```\n")


def test_addresses_elsewhere_are_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "[a](https://example.org/a#b) <https://example.org/c> [here](http://localhost:8080)\n"
        "`changes <https://example.org/d>`_ curl http://host:8080/ [on](page.md)\n"
    )
    places = links.addresses([page])
    assert [*places] == [f"https://example.org/{letter}" for letter in "acd"]


def test_an_address_that_is_not_reached_is_told(tmp_path):
    (answer,) = links.answers(["http://127.0.0.1:9/"], timeout=2)
    assert answer.status == 0 and "refused" in answer.text.lower()


@pytest.fixture
def session(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shell = Session(tmp_path)
    yield shell
    shell.end()


def test_a_session_keeps_what_a_block_exports(session):
    session.run("export GREETING=hello", "", 10)
    assert session.run("echo $GREETING", "", 10) == "hello\n"
    session.leave()
    assert session.run("echo $GREETING", "", 10) == "\n"


def test_a_command_that_fails_or_takes_too_long_is_told(session):
    with pytest.raises(ValueError, match="this failed: ls nowhere"):
        session.run("ls nowhere\necho never", "", 10)
    with pytest.raises(ValueError, match=r"it took longer than 0\.2 s"):
        session.run("sleep 9", "", 0.2)


def test_a_program_is_started_until_it_is_ready_and_ends_with_the_page(session, tmp_path):
    session.start('bash -c "sleep 0.3; echo $$ >pid; sleep 99"', "test -s pid", 10)
    number = int((tmp_path / "pid").read_text())
    os.kill(number, 0)
    session.leave()
    with pytest.raises(ProcessLookupError):
        os.kill(number, 0)
    with pytest.raises(ValueError, match="has ended with 3"):
        session.start('sh -c "exit 3"', "false", 10)


def test_a_launch_finds_a_master(session):
    session.start(
        "bash -c 'rosparam get /rosversion; sleep 99' warehouse.launch", "rosparam list", 60
    )
