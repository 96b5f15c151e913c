"""Hook of hatchling: with SOLEPATH_COMPILED=1 in the environment, the wheel has its hot modules compiled.

Without it, which is the default, the wheel is pure (py3-none-any), and this hook does nothing."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

NEEDED = ["attrs>=23.2", "construct>=2.10.70", "construct-typing>=0.7", "mypy[mypyc]>=2.4,<3", "setuptools>=77"]
"""What the build needs: mypyc and what it calls, and packages whose types it reads."""


def is_chosen() -> bool:
    """Return whether compiled modules are chosen."""
    return os.environ.get("SOLEPATH_COMPILED", "") not in ("", "0")


class CompiledBuildHook(BuildHookInterface[Any]):
    """Adds the compiled modules to a wheel."""

    def dependencies(self) -> list[str]:
        return NEEDED if is_chosen() and self.target_name == "wheel" else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        if not is_chosen() or self.target_name != "wheel" or version == "editable":
            return
        self.folder = tempfile.mkdtemp()
        subprocess.run([sys.executable, Path(__file__).with_name("build.py"), self.folder], check=True)
        build_data["pure_python"], build_data["infer_tag"] = False, True
        for pattern in ("**/*.so", "**/*.pyd", "solepath/_compiled.py"):
            for file in Path(self.folder).glob(pattern):
                build_data["force_include"][str(file)] = file.relative_to(self.folder).as_posix()

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        shutil.rmtree(getattr(self, "folder", ""), ignore_errors=True)
