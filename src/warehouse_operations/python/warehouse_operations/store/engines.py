# SPDX-License-Identifier: Apache-2.0
"""Databases by their URL or path: opened, checked, and locked against a second program."""

import contextlib
import os
import time
from pathlib import Path
from typing import Any

from sqlalchemy import create_engine, event, select, text
from sqlalchemy.engine import Connection, Engine, make_url
from sqlalchemy.exc import SQLAlchemyError

from warehouse_layout.file import user_file
from warehouse_operations.store import schema
from warehouse_operations.store.locks import FileLock, InUseError, holder

MAGIC = b"SQLite format 3\0"
LOCK = 0x6B697661  # identifies this program's locks in a server's database
GIVEN_UP = 2.0  # by when a server has dropped the lock of a connection that was closed [s, wall]


class DatabaseError(Exception):
    """Raised where a database can't be opened or written; says why."""


def url_of(text: Any) -> str:
    """Returns a URL as it is; anything else is the path of an SQLite file."""
    return text if "://" in str(text) else f"sqlite:///{text}"


def shown(text: Any) -> str:
    """Returns a URL without its password, for messages."""
    with contextlib.suppress(SQLAlchemyError):
        return make_url(text).render_as_string() if "://" in str(text) else str(text)
    return "the database"


def open_engine(text: Any, makes: bool = True) -> Engine:
    """Opens a database, its tables ready; raises DatabaseError.

    makes: whether a database without tables gets them.
    """
    engine = make_engine(text)
    prepare(engine, text, makes)
    return engine


def make_engine(text: Any) -> Engine:
    """Returns an engine that has not read its database yet; raises DatabaseError."""
    try:
        url = make_url(url_of(text))
    except (SQLAlchemyError, ValueError) as error:
        kind = str(text).partition("://")[0]
        raise DatabaseError(f"{kind}://…: is not a URL of a database") from error
    try:
        is_file = url.get_backend_name() == "sqlite"
        options: dict[str, Any] = (
            {} if is_file else {"connect_args": {"application_name": holder()[:63]}}
        )
        engine = create_engine(url, future=True, **options)
    except (SQLAlchemyError, ImportError, KeyError, ValueError) as error:
        raise DatabaseError(f"{shown(text)}: {reason(error)}") from error
    if is_file:
        event.listen(engine, "connect", _sqlite)
    return engine


def prepare(engine: Engine, text: Any, makes: bool = True) -> None:
    """Checks that the database is whole, and creates its tables; raises DatabaseError."""
    path = path_of(engine)
    try:
        if path:
            _check_file(path)
            _make_private(path)
        with engine.begin() as connection:
            if path:
                _check_pages(connection)
            schema.prepare(connection, makes=makes)
    except (SQLAlchemyError, schema.SchemaError, OSError) as error:
        raise DatabaseError(f"{shown(text)}: {reason(error)}") from error


def path_of(engine: Engine) -> Path | None:
    """Returns the file of an SQLite database; None for another one, or one in memory."""
    name = engine.url.database
    if engine.dialect.name != "sqlite" or not name or name.startswith((":memory:", "file:")):
        return None
    return Path(name)


def reason(error: BaseException) -> str:
    """Returns the cause in one line, without SQLAlchemy's additions."""
    text = str(getattr(error, "orig", None) or getattr(error, "strerror", None) or error)
    return " ".join(text.split()) or type(error).__name__


def _sqlite(connection: Any, _record: Any) -> None:
    cursor = connection.cursor()
    cursor.execute("PRAGMA journal_mode=WAL")
    cursor.execute("PRAGMA synchronous=NORMAL")  # commits survive a killed program
    cursor.execute("PRAGMA foreign_keys=ON")
    cursor.execute("PRAGMA busy_timeout=30000")
    cursor.close()


def _check_file(path: Path) -> None:
    if path.is_dir():
        raise schema.SchemaError("is a folder; the path of an SQLite file was expected")
    if path.exists():
        # The lock and SQLite's companion files are named after it.
        if path.stat().st_nlink > 1:
            raise schema.SchemaError("has another name too (a hard link); a copy was expected")
        with user_file.opened(path, None) as file:
            begin = file.read(len(MAGIC))
        if begin and begin != MAGIC:
            raise schema.SchemaError("is not an SQLite database; another file was expected")


def _make_private(path: Path) -> None:
    """Creates a file that its owner alone can read; SQLite gives its companion files the same
    mode."""
    with contextlib.suppress(OSError):  # SQLite reports why it can't open the file
        os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))


def _check_pages(connection: Any) -> None:
    result = connection.execute(text("PRAGMA quick_check(1)")).scalar()
    if result != "ok":
        words = " ".join(str(result).replace("*", "").split())
        raise schema.SchemaError(f"is damaged ({words}); use another one, or a copy")


def lock(engine: Engine, text: Any) -> contextlib.AbstractContextManager[Any]:
    """Returns a context in which no other program may write the database; raises DatabaseError."""
    try:
        if path := path_of(engine):
            return FileLock(path)
        if engine.dialect.name == "postgresql":
            return _server_lock(engine, shown(text))
    except InUseError as error:
        raise DatabaseError(f"{error}; end that first, or choose another database") from error
    except OSError as error:
        raise DatabaseError(
            f"{shown(text)}: unable to open database file: {error.strerror}"
        ) from error
    except SQLAlchemyError as error:
        raise DatabaseError(f"{shown(text)}: {reason(error)}") from error
    return contextlib.nullcontext()


def _takes_lock(connection: Connection, keys: dict[str, int]) -> bool:
    """Returns whether an advisory lock could be taken. The server drops that of a connection which
    was closed a moment later, so a database that is opened at once again has to wait for it."""
    taken = select(text("pg_try_advisory_lock(:program, :place)")).params(keys)
    end = time.monotonic() + GIVEN_UP
    while not (is_taken := bool(connection.execute(taken).scalar())) and time.monotonic() < end:
        time.sleep(GIVEN_UP / 40)
    return is_taken


def _server_lock(engine: Engine, name: str) -> contextlib.AbstractContextManager[Any]:
    """Takes an advisory lock, which the server drops when this process or its connection ends."""
    connection = engine.connect().execution_options(isolation_level="AUTOCOMMIT")
    in_schema = connection.execute(
        text("SELECT oid::int FROM pg_namespace WHERE nspname = current_schema()")
    ).scalar()
    keys = {"program": LOCK, "place": in_schema or 0}
    if _takes_lock(connection, keys):
        return contextlib.closing(connection)
    by = connection.execute(
        text(
            """SELECT application_name, date_trunc('second', backend_start) FROM pg_locks l
               JOIN pg_stat_activity a ON a.pid = l.pid WHERE locktype = 'advisory' AND granted
               AND classid = :program AND objid = :place AND objsubid = 2
               AND l.database = (SELECT oid FROM pg_database WHERE datname = current_database())"""
        ).bindparams(**keys)
    ).first()
    connection.close()
    holder = (
        f"{by[0] or 'another program'}, since {by[1]:%Y-%m-%d %H:%M:%S}" if by else "another one"
    )
    raise DatabaseError(
        f"{name}: is in use by {holder}; end that first, or choose another database"
    )
