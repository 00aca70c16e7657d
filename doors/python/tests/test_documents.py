"""The examples of docs/python.md run as they stand, and print what stands below them."""

import contextlib
import io
import os
import re
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs/python.md"
EXAMPLE = re.compile(r"```python\n(.*?)```\n(?:\n```text\n(.*?)```\n)?", re.DOTALL)


def test_the_examples_run(tmp_path, monkeypatch):
    pytest.importorskip("polars")
    # what an example writes is no file of the repository
    (tmp_path / "docs").mkdir()
    for path in ROOT.glob("docs/desk_arm*"):
        shutil.copy(path, tmp_path / "docs")
    monkeypatch.chdir(tmp_path)
    text = PAGE.read_text(encoding="utf-8")
    names, written = {}, text
    examples = list(EXAMPLE.finditer(text))
    assert len(examples) >= 6
    for example in examples:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(example[1], names)  # noqa: S102
        block = f"```python\n{example[1]}```\n\n```text\n{printed.getvalue()}```\n"
        if "RNE_WRITE_DOCUMENTS" in os.environ:
            written = written.replace(example[0], block)
        else:
            assert example[0] == block
    if "RNE_WRITE_DOCUMENTS" in os.environ:
        PAGE.write_text(written, encoding="utf-8")
