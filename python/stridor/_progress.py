"""Progress of a run as bars."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Observe = Callable[[str, int, int | None], None]
"""A function of the stage, the steps done and how many there are (``None`` if unknown)."""


@contextmanager
def observed(progress: bool | Observe | None) -> Iterator[Observe | None]:
    """The function that shows the progress, or ``None``."""
    if progress is None:
        progress = sys.stderr.isatty() or "ipykernel" in sys.modules
    if isinstance(progress, bool):
        if not progress:
            yield None
            return
        bars = _Bars()
        try:
            yield bars
        finally:
            bars.close()
    else:
        yield progress


class _Bars:
    """One bar, of the stage under way."""

    def __init__(self) -> None:
        from tqdm.auto import tqdm

        self._bar = tqdm(leave=False, delay=0.3)
        self._stage = ""

    def __call__(self, stage: str, done: int, total: int | None) -> None:
        if stage != self._stage:
            self._stage = stage
            self._bar.reset(total)
            self._bar.set_description(stage)
        self._bar.update(done - self._bar.n)

    def close(self) -> None:
        self._bar.close()
