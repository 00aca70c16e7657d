"""The pages of all robots in headless Chromium: does each one open, at every size, and does it hold still under the mouse?

Usage: python every.py RNE FOLDER [ROBOT...]     RNE is the binary, pages go to FOLDER; `cargo xtask page` calls it.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import time

from selenium.common.exceptions import TimeoutException

from page import browser, check, failures, narrow, opened, quiet, seen_on

ROOT = pathlib.Path(__file__).parents[2]
SIZES = [(390, 844), (1280, 720), (1920, 1080)]
# arms of each kind, and a tree with a joint that follows another; half a second for each name of a page, so one in a sample
FIVE = ["planar1", "planar2", "puma560", "stanford", "gripper"]
POINTED = FIVE[: None if "CI_FULL" in os.environ else 1]
TREES = [ROOT / "robots", ROOT / "robots/trees", ROOT / "docs", ROOT / "docs/teaching/lecture"]


def written(rne, folder, names):
    """The pages of all robot files, by their names; a closed loop has no page, and the command says so."""
    folder.mkdir(parents=True, exist_ok=True)
    pages, refused = {}, []
    files = [file for tree in TREES for file in sorted(tree.glob("*.yaml")) if ".plan" not in file.name and (not names or file.stem in names)]
    for file in files:
        page = folder / f"{file.stem}.html"
        said = subprocess.run([rne, "report", str(file), "--force", "-o", str(page)], capture_output=True, text=True)
        if said.returncode == 0:
            pages[file.stem] = page
        elif check("a closed loop" in said.stderr, f"{file.name}: rne report fails: {said.stderr}"):
            refused.append(file.stem)
    print(f"{len(pages)} pages; of {', '.join(refused)} there is none, for they have closed loops")
    return pages


# what is cut off in its field
CUT = """
  const ink = document.createElement("canvas").getContext("2d");
  return [...document.querySelectorAll("input.number")].filter(of => {
    const { font, paddingLeft, paddingRight } = getComputedStyle(of);
    ink.font = font;
    return of.checkVisibility() && ink.measureText(of.value).width > of.clientWidth - parseFloat(paddingLeft) - parseFloat(paddingRight) + 0.5;
  }).map(of => `${of.getAttribute("aria-label")}: ${of.value}`);
"""
# every cell of every step: what its cards say where there is no code, and why terms are gone
WALK = """
  const texts = (of) => [...document.querySelectorAll(`#cell ${of}`)].map(found => found.textContent);
  const found = { code: new Set(), why: new Set() };
  const first = document.querySelector("#cell .component").className;
  for (const cell of document.querySelectorAll("[data-cell]:not(:disabled)")) {
    cell.click();
    for (const text of texts(".no-code")) found.code.add(text);
    for (const text of texts(".why")) found.why.add(text);
  }
  window.dispatchEvent(new Event("beforeprint"));
  return { first, code: [...found.code], why: [...found.why], vectors: document.querySelectorAll("#vectors p").length,
           rows: document.querySelectorAll("#table tbody tr").length, joints: document.querySelectorAll("#sliders tbody tr").length };
"""


def whole(driver, name, page, sizes):
    """A page at these sizes, in normal and in lecture mode: nothing to complain of, nothing beside the screen or cut off."""
    for size in sizes:
        seen_on(driver, *size)
        try:
            opened(driver, page)
        except TimeoutException:
            check(False, f"{name}, {size[0]}x{size[1]}: the page is blank")
            quiet(driver, name)
            return
        for mode in ("normal", "lecture"):
            where = f"{name}, {size[0]}x{size[1]}, {mode}"
            if mode == "lecture":
                driver.execute_script("document.querySelector('.head-buttons button').click()")
            narrow(driver, where)
            driver.execute_script("const of = document.getElementById('time'); of.value = 0.37; of.dispatchEvent(new Event('input'))")
            cut = driver.execute_script(CUT)
            check(not cut, f"{where}: during a motion fields cut off {cut[:3]}")
            driver.execute_script("document.getElementById('home').click()")
            cut = driver.execute_script(CUT)
            check(not cut, f"{where}: fields cut off {cut[:3]}")
            quiet(driver, where)
    opened(driver, page)
    found = driver.execute_script(WALK)
    check("constant" not in found["first"], f"{name}: the page opens at a component that is a number")
    for text in found["code"]:
        check(not text.rstrip().endswith(":"), f"{name}: where there is no code a card says {text!r} and no more")
    for why in found["why"]:
        names = re.findall(r"\b[a-z]+\d+(?:_\w+)?\b", why)
        check(why != "constants" and not names, f"{name}: the reason {why!r} has names of the code, or says nothing")
    check(found["vectors"] > 0 and found["rows"] >= found["joints"], f"{name}: on paper {found}")
    quiet(driver, f"{name}, its cells and its paper")


# every box but those of the picture, in which what is lit is drawn larger, of the box that tells what is pointed at, and
# inside a formula, whose own box moves with them
BOXES = """
  const outside = ":not(script, math *, #arm *, #plot *, [data-readout], [data-readout] *)";
  const all = [...document.body.querySelectorAll(`*${outside}`)];
  const boxes = () => all.map(of => { const { x, y, width, height } = of.getBoundingClientRect(); return [x, y, width, height]; });
  const differing = (before, after) => all.filter((_, at) => before[at].some((value, of) => value !== after[at][of]))
    .map(of => `${of.tagName.toLowerCase()}.${of.getAttribute("class") || of.id}`).slice(0, 3);
"""
# all names of a cell by the events of a pointer, which is fast
TOLD = BOXES + """
  const moved = [];
  const rest = boxes();
  for (const of of document.querySelectorAll("#cell [data-name]")) {
    const { x, y, width, height } = of.getBoundingClientRect();
    of.dispatchEvent(new PointerEvent("pointerover", { bubbles: true, clientX: x + width / 2, clientY: y + height / 2 }));
    const found = differing(rest, boxes());
    if (found.length) moved.push([of.dataset.name, found]);
  }
  document.documentElement.dispatchEvent(new PointerEvent("pointerleave"));
  return moved;
"""
# one place of each name of a cell, for the mouse itself
NAMES = """
  const seen = new Set();
  window.names = [...document.querySelectorAll("#cell [data-name]")].filter(of =>
    of.checkVisibility() && !seen.has(of.dataset.name) && seen.add(of.dataset.name));
  return window.names.length;
"""
BEFORE = BOXES + """
  const [index, done] = arguments;
  const of = window.names[index];
  const high = of.getBoundingClientRect().top;
  of.scrollIntoView({ block: "nearest" });
  const frames = of.getBoundingClientRect().top === high ? 1 : 4;
  // what comes into sight is laid out frames later, and may bring more into sight
  const settled = (last, same, then) => requestAnimationFrame(() => {
    const now = boxes();
    const again = differing(last, now).length ? 0 : same + 1;
    again < frames ? settled(now, again, then) : then();
  });
  settled(boxes(), 0, () => {
    const box = of.getClientRects()[0];
    const at = [box.x + box.width / 2, box.y + box.height / 2];
    const hit = document.elementFromPoint(...at);
    Object.assign(window, { hit, rest: boxes(), boxes, differing });
    // what a later line or the edge of its panel hides is not pointed at
    done(hit && of.contains(hit) ? at : null);
  });
"""
AFTER = """
  const done = arguments[1];
  const [x, y] = arguments[0];
  requestAnimationFrame(() => setTimeout(() => {
    const box = document.querySelector("[data-readout]").getBoundingClientRect();
    const covered = x > box.left && x < box.right && y > box.top && y < box.bottom;
    done({ moved: differing(rest, boxes()), same: document.elementFromPoint(x, y) === hit, covered });
  }));
"""


def still(driver, name, page):
    """Nothing moves while the mouse rests on a name: by events on all names of all cells, by the mouse on those of a joint
    in a lecture, where the box that tells of them lies on the equations."""
    told = pointed = 0
    for size, lecture in ((SIZES[1], True), (SIZES[2], True), (SIZES[1], False)):
        seen_on(driver, *size)
        opened(driver, page, "#lecture" if lecture else "")
        where = f"{name}, {size[0]}x{size[1]}{', lecture' if lecture else ''}"
        cells = driver.execute_script("return [...document.querySelectorAll('[data-cell]:not(:disabled)')].map(of => of.dataset.cell)")
        joint = cells[-1].split("-")[0]
        by_hand = [cell for cell in cells if cell.split("-")[0] == joint]
        # a larger screen of the same shape has the same rules
        for cell in by_hand if size == SIZES[2] else cells:
            # opened without a click, as at first: a click ends the help, and with it the place of the box
            step = cell.replace("-", ".")
            driver.execute_script("rne.showAddress(arguments[0])", f"#cell={step}{'&lecture' if lecture else ''}")
            moved = driver.execute_script(TOLD)
            told += 1
            check(not moved, f"{where}: in cell {cell} {len(moved)} names move what they are in: {moved[:2]}")
            if cell not in by_hand or not lecture or size != SIZES[1]:
                continue
            for at in range(driver.execute_script(NAMES)):
                mouse(driver, 2, 2)
                place = driver.execute_async_script(BEFORE, at)
                if place is None:
                    continue
                mouse(driver, *place)
                found = driver.execute_async_script(AFTER, place)
                pointed += 1
                is_still = not found["moved"] and found["same"] and not found["covered"]
                if not check(is_still, f"{where}: under the mouse on name {at} of cell {cell}: {found}"):
                    break
        quiet(driver, where)
    check(pointed > 0, f"{name}: the mouse was on no name")
    print(f"  {name}: nothing moves in {told} cells, and under the mouse on {pointed} names")


def mouse(driver, x, y):
    driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseMoved", "x": x, "y": y})


def grows(driver, page):
    """In lecture mode letters keep their share of the screen."""
    sizes = []
    for height in (720, 1080, 2160):
        seen_on(driver, height * 16 // 9, height)
        opened(driver, page, "#cell=2.4&lecture")
        sizes.append(driver.execute_script(
            "return ['.component math', 'h1', '#grid button', '#arm .drawn-text'].map(of => parseFloat(getComputedStyle(document.querySelector(of)).fontSize))"))
        shares = [size / height for size in sizes[-1]]
        check(all(abs(share / (first / 720) - 1) < 0.02 for share, first in zip(shares, sizes[0])),
              f"lecture: at {height} lines letters have {sizes[-1]} pixels, and {sizes[0]} at 720")
    check(sizes[0][0] / 720 > 0.03, f"lecture: equations have {sizes[0][0]} pixels of 720")
    family = driver.execute_script("return getComputedStyle(document.querySelector('.component math')).fontFamily")
    check(all(font in family for font in ("Latin Modern Math", "STIX Two Math", "DejaVu Math TeX Gyre")), f"the fonts of mathematics are {family}")


def table(driver, rne, page):
    """The table of the page is that of the file, the open joint is marked, and arrows are in the address."""
    seen_on(driver, 1280, 720)
    opened(driver, page, "#cell=3.4&lecture")
    driver.execute_script("document.querySelector('[popovertarget]').click()")
    rows, is_open, shown = driver.execute_script(
        "const rows = [...document.querySelectorAll('#table tbody tr')]; return [rows.map(of => [...of.cells].map(cell => cell.textContent)),"
        " rows.map(of => of.classList.contains('open')), document.getElementById('table').checkVisibility()]")
    joints = json.loads(subprocess.run([rne, "show", page.stem, "--json"], check=True, capture_output=True).stdout)["robot"]["joints"]
    number = lambda text: float(text.replace("−", "-"))
    for row, joint in zip(rows, joints, strict=True):
        check([number(row[2]), number(row[3]), number(row[5])] == [joint["d"], joint["a"], joint["mass"]]
              and [number(of) for of in row[6].split(", ")] == joint["com"] and [number(of) for of in row[7].split(", ")] == joint["inertia"],
              f"table: {row} is shown for {joint}")
    check([row[4] for row in rows] == ["π/2", "0", "−π/2", "π/2", "−π/2", "0"], f"table: α is {[row[4] for row in rows]}")
    check(shown and [at for at, of in enumerate(is_open, 1) if of] == [3], f"table: shown {shown}, marked {is_open}")
    opened(driver, page, "#cell=3.4&arrows=gravity,torque")
    view, address = driver.execute_script("return [rne.view().layers, rne.address()]")
    check(view == ["gravity", "torque"] and "arrows=gravity,torque" in address, f"address: of two arrows it is {address}, shown are {view}")
    opened(driver, page, "#arrows=ghost")
    said = driver.execute_script("return document.getElementById('address-notice').textContent")
    check("ghost" in said and "omega_dot" in said, f"address: of an unknown arrow it says {said!r}")
    # what is wrong is said in the console of nobody
    quiet(driver, "table")


def main():
    rne, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve() / "every"
    start = time.monotonic()
    pages = written(rne, folder, sys.argv[3:])
    driver = browser(*SIZES[1])
    try:
        # five, and with CI_FULL all, at all sizes; each of the others at one
        everything = "CI_FULL" in os.environ
        opened_at = 0
        for place, (name, page) in enumerate(pages.items()):
            sizes = SIZES if everything or name in FIVE else [SIZES[place % len(SIZES)]]
            opened_at += len(sizes)
            whole(driver, name, page, sizes)
        print(f"{len(pages)} pages opened at {opened_at} sizes, in two modes")
        for name in [of for of in POINTED if of in pages]:
            still(driver, name, pages[name])
        if {"planar2", "puma560"} <= set(pages):
            grows(driver, pages["planar2"])
            table(driver, rne, pages["puma560"])
    finally:
        driver.quit()
    print(f"{len(failures)} failures" if failures else "all pages hold", f"after {time.monotonic() - start:.0f} s")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
