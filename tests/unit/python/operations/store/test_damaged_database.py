# SPDX-License-Identifier: Apache-2.0
"""Databases that are none, of no version, or damaged: one sentence, with the file."""

import os
import random
import shutil
import sqlite3
import subprocess

import pytest
from operations_site import site
from sqlalchemy import text

from warehouse_operations import Operations
from warehouse_operations.store import check
from warehouse_operations.store.database import DatabaseError, open_engine
from warehouse_operations.store.engines import lock
from warehouse_operations.store.returning import SiteError

PAGE = 4096


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "run.db"
    with Operations(site=site(), database=path, orders="fill:40") as ops:
        ops.run(minutes=10)
    engine = open_engine(path)
    with engine.connect() as connection:
        connection.execute(text("PRAGMA wal_checkpoint(TRUNCATE)"))
    engine.dispose()
    return path


@pytest.fixture
def database(whole, tmp_path):
    return shutil.copy(whole, tmp_path / "run.db")


def change(path, *statements):
    engine = open_engine(path)
    with engine.begin() as connection:
        connection.execute(text("PRAGMA foreign_keys = OFF"))
        for statement in statements:
            connection.execute(text(statement))
    engine.dispose()


def refused(path):
    """What is said where it is opened."""
    with pytest.raises(DatabaseError) as error:
        Operations(site=site(), database=path)
    said = str(error.value)
    assert said.startswith(f"{path}: ") and "\n" not in said, said
    return said.removeprefix(f"{path}: ")


@pytest.mark.parametrize(
    "statement, message",
    [
        ("UPDATE schema_version SET version = 0", "the schema version is 0; 1 to 4 was expected"),
        ("DELETE FROM schema_version", "the schema version is none; 1 to 4 was expected"),
        ("INSERT INTO schema_version VALUES (1)", "the schema version is 1, 4; 1 to 4 was"),
        ("UPDATE schema_version SET version = 99", "the database is of schema version 99; this"),
        ("DROP TABLE event", "the table 'event' is missing"),
        ("ALTER TABLE heat DROP COLUMN maps", "the table 'heat' has no column maps"),
    ],
)
def test_tables_that_are_not_as_expected(database, statement, message):
    change(database, statement)
    assert refused(database).startswith(message)


@pytest.mark.parametrize(
    "content, message",
    [
        (b"reference,sku,quantity\n" * 100, "is not an SQLite database; another file was expected"),
        (b"\0" * 8192, "is not an SQLite database"),
        (b"SQLite format 3\0" + b"\xff" * 8192, ""),
        (b"SQLite format 3\0", ""),
    ],
)
def test_files_that_are_no_database(tmp_path, content, message):
    (tmp_path / "run.db").write_bytes(content)
    assert refused(tmp_path / "run.db").startswith(message)
    assert (tmp_path / "run.db").read_bytes() == content


def test_the_database_of_another_program_is_left_alone(tmp_path):
    path = tmp_path / "run.db"
    with sqlite3.connect(path) as connection:
        connection.execute("CREATE TABLE bookmarks (id INTEGER)")
    connection.close()
    assert refused(path) == "the database has tables of another program: bookmarks"
    (tmp_path / "empty.db").touch()
    with pytest.raises(DatabaseError, match="there is no warehouse in it"):
        open_engine(tmp_path / "empty.db", makes=False)


def test_a_folder_is_no_database(tmp_path):
    assert refused(tmp_path).startswith("is a folder; the path of an SQLite file was expected")


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE run SET layout = 'nonsense'",
        "UPDATE bin SET unit = 'somewhere' WHERE id = 3",
        "UPDATE bin SET quantity = 'many', reserved = 0 WHERE id = 3",
        "UPDATE sku SET popularity = 'high' WHERE number = 3",
        "UPDATE orders SET created = 'then', run = 77",
        "DELETE FROM order_line",
        "UPDATE order_line SET quantity = 'nine', picked = 0",
        "UPDATE order_line SET sku = x'ff'",
        "UPDATE orders SET reference = CAST(x'fffe' AS TEXT)",
    ],
)
def test_values_that_make_no_sense(database, statement):
    change(database, statement)
    try:
        said = refused(database)
    except SiteError as error:
        said = str(error)
    assert "can't be read" in said or "of its" in said, said


def test_random_pages(whole, tmp_path):
    """However it is damaged, it opens or a sentence says why not; so it does in the middle."""
    chance, size = random.Random(3), whole.stat().st_size
    opened = 0
    for attempt in range(30):
        path = tmp_path / f"{attempt}.db"
        shutil.copy(whole, path)
        with path.open("r+b") as file:
            for _ in range(chance.choice((1, 4, 20))):
                file.seek(chance.randrange(size // PAGE) * PAGE + chance.choice((0, 100, 2000)))
                file.write(chance.randbytes(chance.choice((1, 40, PAGE))))
        try:
            with Operations(site=site(), database=path, orders="fill:40") as ops:
                ops.run(seconds=30)
            check.faults(open_engine(path))
            opened += 1
        except (DatabaseError, SiteError) as error:
            assert str(error).startswith(str(path)), error
    assert opened < 30


@pytest.mark.parametrize("program", ["simulate", "check", "report"])
def test_programs_say_it_in_a_sentence(program, database):
    change(database, "UPDATE schema_version SET version = 0")
    options = ("--size", "small", "--no-physics", "--minutes", "1", "--database")
    options = options if program == "simulate" else ()
    done = subprocess.run(
        ["rosrun", "warehouse_operations", program, *options, str(database)],
        capture_output=True,
        text=True,
        cwd=database.parent,
        check=False,
    )
    assert done.returncode == 1 and "Traceback" not in done.stderr
    assert done.stderr.startswith(f"{program}: {database}") and done.stderr.count("\n") == 1


def test_a_new_database_is_its_owners_alone(tmp_path):
    path = tmp_path / "shift.db"
    before = os.umask(0o022)
    try:
        engine = open_engine(path)
        with lock(engine, path), engine.begin() as connection:
            connection.exec_driver_sql("CREATE TABLE other (number INTEGER)")
            modes = {file.name: file.stat().st_mode & 0o777 for file in tmp_path.iterdir()}
    finally:
        os.umask(before)
    assert len(modes) == 4, modes  # -wal, -shm and the lock beside it
    assert set(modes.values()) == {0o600}, modes


def test_a_database_with_two_names_is_refused(database, tmp_path):
    """Its lock goes by the name: two shifts could work in it."""
    os.link(database, tmp_path / "other.db")
    with pytest.raises(DatabaseError, match="has another name too"):
        open_engine(database)
