"""Runs the examples of a page of the documents, and compares what they print with what stands below them."""

import contextlib
import io
import os
import re

EXAMPLE = re.compile(r"```python\n(.*?)```\n(?:\n```text\n(.*?)```\n)?", re.DOTALL)


def run_examples(page, part=lambda text: text):
    """The names that the examples of a part of the page define, in one namespace. With RNE_WRITE_DOCUMENTS the page gets
    what the examples print.
    """
    text = page.read_text(encoding="utf-8")
    names, written = {}, text
    for example in EXAMPLE.finditer(part(text)):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(example[1], names)  # noqa: S102
        block = f"```python\n{example[1]}```\n\n```text\n{printed.getvalue()}```\n"
        if "RNE_WRITE_DOCUMENTS" in os.environ:
            written = written.replace(example[0], block)
        else:
            assert example[0] == block
    if written != text:
        page.write_text(written, encoding="utf-8")
    return names
