# SPDX-License-Identifier: Apache-2.0
"""A program that serves a page of its own, such as `edit`, `replay` and `whatif`."""

import contextlib
import re
import subprocess


@contextlib.contextmanager
def served(program, *arguments):
    """The address of the page; the program ends with the context."""
    command = ["/usr/bin/python3", program, *arguments, "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield re.search(r"http://\S+", process.stdout.readline())[0]
        finally:
            process.terminate()
