"""``elemental`` as its users start it: a process."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

APP = Path(__file__).parents[2] / "app"


def elemental(
    *words: object, cwd: Path | None = None, timeout_s: float = 100, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run ``elemental WORDS`` and wait for it; ``environment`` is added to the test's own."""
    return python("-m", "elemental", *words, cwd=cwd, timeout_s=timeout_s, **environment)


def python(
    *words: object, cwd: Path | None = None, timeout_s: float = 100, **environment: str
) -> subprocess.CompletedProcess[str]:
    """The same of ``python WORDS`` with the program on its path."""
    return subprocess.run(
        [sys.executable, *map(str, words)],
        cwd=cwd,
        env=os.environ | {"PYTHONPATH": str(APP)} | environment,
        capture_output=True,
        text=True,
        timeout=timeout_s,
        check=False,
    )


def assert_refused(result: subprocess.CompletedProcess[str], *expected: str) -> None:
    """Exit code 2, nothing on stdout, exactly one line on stderr that holds the words."""
    assert result.returncode == 2, result
    assert result.stdout == ""
    assert result.stderr.startswith("elemental: error: "), result.stderr
    assert result.stderr.count("\n") == 1, result.stderr
    assert result.stderr.endswith("\n")
    for words in expected:
        assert words in result.stderr
