"""The chapter of the guide on this package, as written."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

CHAPTER = Path(__file__).parents[2] / "guide" / "src" / "python.md"


def test_the_chapter_runs_as_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python,package\n(.*?)^```", CHAPTER.read_text(encoding="utf-8"), re.M | re.S)
    assert len(blocks) > 4
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(CHAPTER), "exec"), names)
    assert (tmp_path / "growth.png").stat().st_size > 10_000
    assert (tmp_path / "squeal.vtu").exists()
