"""The examples of documents run as they stand, and print what stands below them."""

import contextlib
import io
import os
import re
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
EXAMPLE = re.compile(r"```python\n(.*?)```\n(?:\n```text\n(.*?)```\n)?", re.DOTALL)


@pytest.mark.parametrize(("name", "least"), [("python", 6), ("operational-space", 6)])
def test_the_examples_run(name, least, tmp_path, monkeypatch):
    if name == "python":
        pytest.importorskip("polars")
    page = ROOT / f"docs/{name}.md"
    # what an example writes is no file of the repository
    (tmp_path / "docs").mkdir()
    for path in ROOT.glob("docs/desk_arm*"):
        shutil.copy(path, tmp_path / "docs")
    monkeypatch.chdir(tmp_path)
    text = page.read_text(encoding="utf-8")
    names, written = {}, text
    examples = list(EXAMPLE.finditer(text))
    assert len(examples) >= least
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
        page.write_text(written, encoding="utf-8")
