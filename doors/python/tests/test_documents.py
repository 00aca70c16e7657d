"""The examples of documents run as they stand, and print what stands below them."""

import shutil
from pathlib import Path

import pytest
from pages import EXAMPLE, run_examples

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize(("name", "least"), [("python", 6), ("operational-space", 5)])
def test_the_examples_run(name, least, tmp_path, monkeypatch):
    if name == "python":
        pytest.importorskip("polars")
    page = ROOT / f"docs/control/{name}.md"
    # what an example writes is no file of the repository
    (tmp_path / "docs").mkdir()
    for path in ROOT.glob("docs/desk_arm*"):
        shutil.copy(path, tmp_path / "docs")
    monkeypatch.chdir(tmp_path)
    assert len(EXAMPLE.findall(page.read_text(encoding="utf-8"))) >= least
    run_examples(page)
