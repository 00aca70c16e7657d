"""The page of `rne report` in headless Chromium: is what it shows right, and can everybody use it?

Usage: python page.py RNE FOLDER [PICTURES]     RNE is the binary, pages go to FOLDER; `cargo xtask page` calls it.
"""

import json
import math
import os
import pathlib
import random
import re
import shutil
import statistics
import subprocess
import sys

from axe_core_python import selenium as axe_selenium
from PIL import Image
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

IS_FULL = bool(os.environ.get("CI_FULL"))
# everything is tried of these; of the others torques and axes at a few states, unless CI_FULL is set
WHOLE = ["planar2", "puma560"]
ROBOTS = ["planar1", "planar2", "stanford", "puma560", "panda"]
STATES, FEW = 50, 5
TOLERANCE = 1e-12
LARGEST = 425_000  # bytes of the page of an arm with 7 joints
SCREENS = {"desk": (1400, 1000), "phone": (375, 812)}

failures = []


def check(holds, what):
    if not holds:
        failures.append(what)
        print(f"  FAILED: {what}")
    return holds


def browser(width, height, dark=False):
    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                     f"--window-size={width},{height}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    # named, so that nobody looks for them elsewhere
    options.binary_location = shutil.which("chromium")
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
    # of a busy machine, too
    driver.set_script_timeout(300)
    seen_on(driver, width, height, dark)
    return driver


def seen_on(driver, width, height, dark=False):
    """Another screen, and colours of day or night."""
    # a window has a smallest width, a phone has not
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500})
    scheme = "dark" if dark else "light"
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                           {"media": "", "features": [{"name": "prefers-color-scheme", "value": scheme}]})


def awaited(driver, seconds, what):
    # asked often: twice in a second, as is usual, would be most of a test's time
    return WebDriverWait(driver, seconds, poll_frequency=0.02).until(what)


def opened(driver, page, fragment=""):
    # the same page at another fragment would not be read anew
    if fragment:
        driver.get("about:blank")
    driver.get(page.as_uri() + fragment)
    ready = "return document.documentElement.dataset.ready"
    awaited(driver, 60, lambda driver: driver.execute_script(ready) == "1")


def lists(values):
    return ",".join(repr(value) for value in values)


def evaluated(rne, robot, state, *more):
    command = [rne, "eval", robot, "--json"] + [f"--{name}={lists(state[name])}" for name in ("q", "qd", "qdd")]
    return json.loads(subprocess.run(command + list(more), check=True, capture_output=True).stdout)


def torques_of_eval(rne, robot, state, *more):
    return evaluated(rne, robot, state, *more)["result"]


def pressed(driver, switch):
    driver.execute_script("document.querySelector(`[data-switch=\"${arguments[0]}\"]`).click()", switch)


def torques(driver, rne, robot, dof):
    chance = random.Random(13)
    worst, states = 0.0, STATES if IS_FULL or robot in WHOLE else FEW
    for _ in range(states):
        state = {name: [chance.uniform(-2, 2) for _ in range(dof)] for name in ("q", "qd", "qdd")}
        driver.execute_script("rne.setState(arguments[0])", state)
        shown = driver.execute_script("return rne.torques()")
        right = torques_of_eval(rne, robot, state)
        largest = max(1.0, max(abs(torque) for torque in right))
        worst = max(worst, max(abs(a - b) for a, b in zip(shown, right, strict=True)) / largest)
    check(worst <= TOLERANCE, f"{robot}: torques differ by {worst:.1e}")
    print(f"  torques at {states} states: worst difference {worst:.1e} of the largest")


# the quantities of a worksheet that the page knows by other names
QUANTITIES = {"next_force": "child_force", "next_moment": "child_moment"}


def axes(driver, rne, robot, inspection):
    """Components in each kind of axes are those of the worksheet, also as they are shown, and frames are drawn so."""
    chance, dof = random.Random(19), len(inspection["robot"]["joints"])
    names = {(of["quantity"], of["joint"], of.get("component") or ""): name
             for name, of in inspection["names"].items() if not of.get("part")}
    compared, worst = 0, 0.0
    for kind in ("joint", "base", "link"):
        pressed(driver, kind)
        state = {name: [chance.uniform(-2, 2) for _ in range(dof)] for name in ("q", "qd", "qdd")}
        rows = [(names.get((QUANTITIES.get(row["quantity"], row["quantity"]), row["joint"], row["component"])), row)
                for row in evaluated(rne, robot, state, "--trace", "--axes", kind)["trace"]["rows"] if row["frame"]]
        found = {row["quantity"] for name, row in rows if name}
        check({"omega", "acceleration", "gravity", "d", "inertia", "joint_force", "joint_moment"} <= found,
              f"{robot}: of vectors in {kind} axes only {sorted(found)} are compared")
        rows = [(name, row["value"]) for name, row in rows if name]
        told = driver.execute_script(
            "rne.setState(arguments[0]); return arguments[1].map(name => rne.told(name))",
            state, [name for name, _ in rows])
        for (name, right), value in zip(rows, told, strict=True):
            # what the code does not need has no number
            difference = abs(value - right) / max(1.0, abs(right)) if value is not None else 1.0
            worst = max(worst, difference)
            check(difference <= TOLERANCE, f"{robot}: {name} in {kind} axes is {value}, and of the worksheet {right}")
        compared += len(rows)
        of_row = dict(rows)
        joint = min(2, dof)
        driver.find_element(By.CSS_SELECTOR, f'[data-cell="{joint}-5"]').click()
        for axis in "xyz":
            shown = driver.execute_script(
                """
                const name = arguments[0];
                rne.select(name);
                const card = document.querySelector(`[data-component="${name}"]`);
                return [card.querySelector(".value").title, document.querySelector(".readout-value").title,
                        document.querySelector(".readout-meaning").textContent, card.textContent];
                """, f"g{joint}_{axis}")
            for text in shown[:2]:
                number = float(text.replace("−", "-"))
                check(abs(number - of_row[f"g{joint}_{axis}"]) <= 10 * TOLERANCE,
                      f"{robot}: g{joint}_{axis} in {kind} axes is shown as {text}")
            words = {"link": f"axes of link {joint}", "joint": "the lecture's axes", "base": "axes of the base"}[kind]
            check(words in shown[2], f"{robot}: of g{joint}_{axis} the readout says {shown[2]!r}, not {words!r}")
            check(("axes" in shown[3]) == (kind != "link"), f"{robot}: the card of g{joint}_{axis} says {shown[3]!r}")
        drawn_in(driver, robot, kind, dof)
    print(f"  {compared} components in three kinds of axes: worst difference {worst:.1e} of the largest")


def drawn_in(driver, robot, kind, dof):
    """The numbers of g, along the axes that are drawn, are its arrow; as nearly as the perspective lets them be."""
    seen = 0
    for joint in range(1, dof + 1):
        found = driver.execute_script(
            """
            const joint = arguments[0];
            rne.select(`g${joint}_z`);
            const way = (path) => {
              const [a, b, c, d] = path.getAttribute("d").match(/-?[0-9.]+/g).map(Number);
              return [c - a, d - b];
            };
            const axes = [...document.querySelectorAll(`#arm [data-frame="${joint}"]`)];
            return {
              hidden: axes.some(of => of.hasAttribute("hidden")),
              axes: axes.map(way),
              numbers: ["x", "y", "z"].map(axis => rne.told(`g${joint}_${axis}`)),
              arrow: way(document.querySelector(`[data-arrow="gravity-${joint}"] .hit`)),
            };
            """, joint)
        check(not found["hidden"], f"{robot}: the axes of g{joint}_z are not drawn")
        along = [sum(number * axis[at] for number, axis in zip(found["numbers"], found["axes"])) for at in (0, 1)]
        sizes = math.hypot(*along), math.hypot(*found["arrow"])
        # an arrow that points at the viewer has no direction
        if sizes[1] < 25 or sizes[0] < 1e-6:
            continue
        cosine = sum(a * b for a, b in zip(along, found["arrow"])) / (sizes[0] * sizes[1])
        check(cosine > 0.97, f"{robot}: the axes drawn for g{joint} in {kind} axes are not those of its numbers")
        seen += 1
    check(seen > 0, f"{robot}: no arrow is long enough to see its axes in {kind} axes")


def wrench(driver, rne, robot, dof):
    """The sliders of force and moment at the tip give the torques of `rne eval --wrench`; reset takes them away."""
    chance = random.Random(23)
    state = {name: [chance.uniform(-2, 2) for _ in range(dof)] for name in ("q", "qd", "qdd")}
    given = [round(chance.uniform(-2, 2), 3) for _ in range(6)]
    shown = driver.execute_script(
        """
        rne.setState(arguments[0]);
        const inputs = [...document.querySelectorAll("[data-tip]")];
        inputs.forEach((input, at) => {
          input.value = arguments[1][at];
          input.dispatchEvent(new Event("input", { bubbles: true }));
        });
        return { of: inputs.map(input => input.dataset.tip), total: rne.total(), free: rne.torques(),
                 values: inputs.map(input => Number(input.value)),
                 arrows: document.querySelectorAll(".arrow.plain:not([hidden])").length };
        """, state, given)
    check(shown["of"] == ["fx", "fy", "fz", "nx", "ny", "nz"], f"{robot}: the sliders of the tip are {shown['of']}")
    right = torques_of_eval(rne, robot, state, f"--wrench={lists(shown['values'])}")
    largest = max(1.0, max(abs(torque) for torque in right))
    worst = max(abs(a - b) for a, b in zip(shown["total"], right, strict=True)) / largest
    check(worst <= TOLERANCE, f"{robot}: torques with a wrench at the tip differ by {worst:.1e}")
    check(shown["total"] != shown["free"] and shown["arrows"] >= 2, f"{robot}: force and moment at the tip do nothing")
    after = driver.execute_script("document.getElementById('home').click(); return [rne.total(), rne.torques()]")
    check(after[0] == after[1], f"{robot}: reset leaves a wrench at the tip")
    print(f"  with a wrench at the tip: worst difference {worst:.1e} of the largest")


def in_axes_of_base(rpy, vector):
    """R transposed times a vector of the world, with R = Rz(yaw) Ry(pitch) Rx(roll)."""
    def turned(angle, a, b):
        return math.cos(angle) * a + math.sin(angle) * b, math.cos(angle) * b - math.sin(angle) * a
    x, y, z = vector
    x, y = turned(rpy[2], x, y)
    z, x = turned(rpy[1], z, x)
    y, z = turned(rpy[0], y, z)
    return [x, y, z]


BASE = ("rpy", "omega", "omega_dot", "acceleration")
ON_BASE = "const of = rne.parts(); return { tau: of.total, wrench: of.onBase.total, weight: document.getElementById('weight').textContent }"


def floating(driver, rne, robot, page, tips):
    """A floating base: torques and what acts on the base are those of `rne eval`, by hands, keys and addresses."""
    opened(driver, page)
    name, chance = page.stem, random.Random(29)
    inspection = json.loads(subprocess.run([rne, "show", robot, "--json"], check=True, capture_output=True).stdout)
    dof, gravity = len(inspection["robot"]["joints"]), inspection["robot"]["gravity"]

    def right(state):
        base, wrenches = state["base"], state["wrench"]
        command = ["--function=inverse_dynamics_of_floating_base", f"--base-omega={lists(base['omega'])}",
                   f"--base-omega-dot={lists(base['omega_dot'])}", f"--base-acceleration={lists(base['acceleration'])}",
                   f"--gravity={lists(in_axes_of_base(base['rpy'], gravity))}"]
        command += [f"--tip-wrench={tip}={lists(wrenches['f'][3 * at:3 * at + 3] + wrenches['n'][3 * at:3 * at + 3])}"
                    for at, tip in enumerate(tips)]
        found = evaluated(rne, robot, state, *command)["result"]
        return found["wrench"]["force"] + found["wrench"]["moment"], found["tau"]

    def compare(shown, state, what):
        on_base, tau = right(state)
        largest = max(1.0, *map(abs, on_base + tau))
        pairs = zip(shown["wrench"] + shown["tau"], on_base + tau, strict=True)
        worst = max(abs(a - b) for a, b in pairs) / largest
        check(worst <= TOLERANCE, f"{name}, {what}: torques and what acts on the base differ by {worst:.1e}")
        return worst

    # it stands still: what acts on it is its weight
    zeros = [0.0] * dof
    rest = {"q": zeros, "qd": zeros, "qdd": zeros, "base": {of: [0.0] * 3 for of in BASE},
            "wrench": {"f": [0.0] * 3 * len(tips), "n": [0.0] * 3 * len(tips)}}
    driver.execute_script("rne.setState(arguments[0])", rest)
    shown = driver.execute_script(ON_BASE)
    compare(shown, rest, "at rest")
    weight = math.hypot(*right(rest)[0][:3])
    said = f"|F| = {weight:.1f} N. The robot stands still: F is its weight, {weight:.1f} N." if weight else "There is no gravity"
    check(said in shown["weight"], f"{name}: of a robot at rest the page says {shown['weight']!r}, not {said!r}")
    # everything moves, in each form
    worst = 0.0
    for form in ("folded", "unfolded", "reduced"):
        pressed(driver, form)
        state = {of: [round(chance.uniform(-2, 2), 3) for _ in range(dof)] for of in ("q", "qd", "qdd")}
        state["base"] = {of: [round(chance.uniform(-2, 2), 3) for _ in range(3)] for of in BASE}
        state["wrench"] = {of: [round(chance.uniform(-20, 20), 2) for _ in range(3 * len(tips))] for of in ("f", "n")}
        fragment = "#" + "&".join(f"{of}={lists(state[of])}" for of in ("q", "qd", "qdd"))
        fragment += "".join(f"&{of}={lists(state['base'][of])}" for of in BASE)
        fragment += "".join(f"&{of}={lists(state['wrench'][of])}" for of in ("f", "n")) + ("" if form == "folded" else f"&{form}")
        opened(driver, page, fragment)
        worst = max(worst, compare(driver.execute_script(ON_BASE), state, form))
        view, notice = driver.execute_script("return [rne.view(), document.getElementById('address-notice').textContent]")
        check(not notice and view["state"]["base"] == state["base"] and view["wrench"] == state["wrench"],
              f"{name}: an address shows {view['state']['base']} and says {notice!r}")
        again = driver.execute_script("return rne.address()")
        opened(driver, page, again)
        check(driver.execute_script("return [rne.view().state, rne.address()]") == [view["state"], again],
              f"{name}: a moved base does not come back by its address")
    if len(tips) > 1:
        parts = driver.execute_script(
            """
            document.querySelector(`[data-tip-name="${arguments[0]}"]`).click();
            const of = document.querySelector('[data-tip="fx"]');
            of.value = 7;
            of.dispatchEvent(new Event("input", { bubbles: true }));
            return [rne.view().wrench.f[3], Number(of.value)];
            """, tips[1])
        check(parts == [parts[1]] * 2, f"{name}: the sliders of {tips[1]} set {parts}")
    driver.execute_script("document.getElementById('rest').click()")
    held = driver.execute_script("return rne.view().state.base")
    check(held == {**state["base"], **{of: [0, 0, 0] for of in BASE[1:]}}, f"{name}: at rest the base has {held}")
    driver.execute_script("document.getElementById('home').click()")
    check(driver.execute_script("return rne.view().state.base") == rest["base"], f"{name}: reset leaves the base moved")
    # keys turn the trunk, and gravity with it
    box = "return document.querySelector('.solid.base .body').getAttribute('d')"
    before = driver.execute_script(box)
    driver.find_element(By.CSS_SELECTOR, '[data-base="rpy-0"]').send_keys(*[Keys.ARROW_RIGHT] * 5)
    roll = driver.execute_script("return rne.view().state.base.rpy[0]")
    check(abs(roll - math.pi / 10) < 1e-9, f"{name}: five keys on the roll make it {roll}")
    check(driver.execute_script(box) != before, f"{name}: the drawing of the base does not turn")
    field = driver.find_element(By.CSS_SELECTOR, '[data-base-degrees="1"]')
    field.clear()
    field.send_keys("-22,5", Keys.ENTER)
    pitch = driver.execute_script("return rne.view().state.base.rpy[1]")
    check(abs(pitch + math.pi / 8) < 1e-15, f"{name}: -22,5 degrees of pitch are {pitch} rad")
    shown, told = driver.execute_script("return ['x', 'y', 'z'].map(of => rne.value(`g0_${of}`))"), in_axes_of_base([roll, pitch, 0], gravity)
    check(all(abs(a - b) < 1e-12 for a, b in zip(shown, told, strict=True)), f"{name}: gravity in the base is {shown}")
    # the motion is that of the joints
    driver.execute_script("const of = document.getElementById('time'); of.value = 0.4; of.dispatchEvent(new Event('input'))")
    held = driver.execute_script("return rne.view().state.base")
    check(held == {**rest["base"], "rpy": [roll, pitch, 0]}, f"{name}: in a motion the base has {held}")
    # arrow keys go from cell to cell, over those that are empty
    driver.find_element(By.CSS_SELECTOR, '[data-cell="0-4"]').click()
    driver.find_element(By.CSS_SELECTOR, '[data-cell="0-4"]').send_keys(Keys.ARROW_RIGHT, Keys.ARROW_UP)
    at = driver.execute_script("return document.activeElement.dataset.cell")
    check(at == "1-2", f"{name}: keys go from the base's step 4 to the cell {at}")
    for component in ("ddcb0_x", "fb0_z", "nb0_y"):
        values = driver.execute_script("rne.select(arguments[0]); return document.querySelector('[data-readout]').textContent", component)
        check(component in values, f"{name}: {component} is not told")
    for where in ("desk", "phone"):
        seen_on(driver, *SCREENS[where])
        # one small cell, for the rules are slow
        opened(driver, page, "#cell=0.4&rpy=0.2,-0.3,0.4")
        narrow(driver, f"{name}, {where}")
        accessible(driver, f"{name}, {where}")
    seen_on(driver, *SCREENS["desk"])
    quiet(driver, name)
    print(f"  {name}: a floating base, worst difference {worst:.1e} of the largest")


def views(driver, page):
    """What a reader has chosen comes back on another page of the same arm."""
    opened(driver, page)
    driver.execute_script(
        """
        for (const of of ["unfolded", "c", "joint", "dark"]) document.querySelector(`[data-switch="${of}"]`).click();
        for (const of of ["frames", "masses"]) document.querySelector(`[data-shows="${of}"]`).click();
        for (const [of, value] of [["fx", 3], ["nz", -1.5]]) {
          const input = document.querySelector(`[data-tip="${of}"]`);
          input.value = value;
          input.dispatchEvent(new Event("input", { bubbles: true }));
        }
        document.querySelector(".tip-force").open = true;
        document.querySelector('[data-cell="1-6"]').click();
        """)
    view = driver.execute_script("return rne.view()")
    for what, right in (("axes", "joint"), ("frames", True), ("masses", False), ("tip", True), ("form", "unfolded"),
                        ("wrench", {"f": [3, 0, 0], "n": [0, 0, -1.5]}), ("cell", [1, 6]), ("theme", "dark")):
        check(view[what] == right, f"{page.stem}: a view has {view[what]} as {what}, chosen was {right}")
    shown = "return ['[data-switch]', '[data-shows]'].map(of => [...document.querySelectorAll(of)]" \
            ".map(of => of.getAttribute('aria-pressed')).join()).concat(rne.total().join())"
    right = driver.execute_script(shown)
    opened(driver, page)
    check(driver.execute_script(shown) != right, f"{page.stem}: the choices change nothing")
    driver.execute_script("rne.show(arguments[0])", view)
    check(driver.execute_script("return rne.view()") == view, f"{page.stem}: a view does not come back")
    check(driver.execute_script(shown) == right, f"{page.stem}: a view is not shown as it was")
    print("  a view comes back on another page")


# of the pendulum with two links: an exact state, a cell and settings
ADDRESS = "#q=0.6,1.3&qd=-0.7,0.25&qdd=1.5,0&f=3,0,-1.5&cell=2.4&look=3D&unfolded&c&joint&dark&exercise&lecture&frames&no-masses"


def address(driver, page):
    """An address opens the exact view, and a view has an address that opens it."""
    def at(fragment):
        opened(driver, page, fragment)

    at(ADDRESS)
    view = driver.execute_script("return rne.view()")
    right = {"state": {"q": [0.6, 1.3], "qd": [-0.7, 0.25], "qdd": [1.5, 0]}, "wrench": {"f": [3, 0, -1.5], "n": [0, 0, 0]},
             "cell": [2, 4], "form": "unfolded", "language": "c", "axes": "joint", "theme": "dark", "exercise": True,
             "lecture": True, "frames": True, "masses": False, "layers": ["acceleration"]}
    for what, value in right.items():
        check(view[what] == value, f"address: {what} is {view[what]}, and {value} is asked for")
    check(driver.execute_script("return rne.address()") == ADDRESS, "address: a view has another one than it was opened by")
    fields = driver.execute_script("return [...document.querySelectorAll('[data-field=q]')].map(of => of.value)")
    check(fields == ["0.6", "1.3"], f"address: the fields of q have {fields}")
    # typed as well as slid, in degrees too, with a comma
    field = driver.find_element(By.CSS_SELECTOR, '[data-degrees="2"]')
    field.clear()
    field.send_keys("-22,5", Keys.ENTER)
    angle = driver.execute_script("return rne.view().state.q[1]")
    check(abs(angle + math.pi / 8) < 1e-15, f"address: -22,5 degrees are {angle} rad")
    field = driver.find_element(By.CSS_SELECTOR, '[data-field="q"][data-name="q1"]')
    for typed, value in (("pi/4", math.pi / 4), ("-2pi/3", -2 * math.pi / 3), ("30deg", math.pi / 6), ("pie", math.pi / 6),
                         ("-deg(22.5)", -math.pi / 8), ("45 °", math.pi / 4)):
        field.clear()
        field.send_keys(typed, Keys.ENTER)
        angle = driver.execute_script("return rne.view().state.q[0]")
        check(abs(angle - value) < 1e-15, f"address: {typed} typed for the angle of joint 1 makes it {angle}")
    field = driver.find_element(By.CSS_SELECTOR, '[data-field="qd"][data-name="qd1"]')
    for typed, value in (("nothing", -0.7), ("12.5", 12.5)):
        field.clear()
        field.send_keys(typed, Keys.ENTER)
        found = driver.execute_script("return rne.view().state.qd[0]")
        check(found == value, f"address: {typed} typed for the rate of joint 1 makes it {found}")
    driver.execute_script("document.querySelector('[data-view=front]').click()")
    awaited(driver, 5, lambda driver: driver.execute_script("return location.hash === rne.address()"))
    view = driver.execute_script("return { ...rne.view(), scrolled: 0 }")
    at(driver.execute_script("return location.hash"))
    check(driver.execute_script("return { ...rne.view(), scrolled: 0 }") == view, "address: a view does not come back")
    # what is wrong is said, and the rest is shown
    at("#q=1,2,3&qd=1,x&qdd=0.5,0.25&cell=7.1&nonsense=3")
    said, state = driver.execute_script("return [document.getElementById('address-notice').textContent, rne.view().state]")
    for part in ("q has 3 numbers; 2 are needed", "“x” in qd is no number", "there is no cell 7.1"):
        check(part in said, f"address: {part!r} is not said: {said!r}")
    check(state["qdd"] == [0.5, 0.25], f"address: q̈ is {state['qdd']}")
    # what a part of a state leaves open is said, until it changes
    note = "const of = document.getElementById('state-note'); return of.hidden ? '' : of.textContent"
    for fragment, parts in (("#cell=2.4", []), ("#q=0.6,1.3&qd=1,0&qdd=0,0", []),
                            ("#q=0.6,1.3&qd=1,-0.5", ["does not give qdd, so", "q̈ = (1, −1.5)", "add qdd=0,0 to"]),
                            ("#q=0.6,1.3", ["qd and qdd", "q̇ = (0.5, 0.8) and q̈ = (1, −1.5)", "qd=0,0&qdd=0,0"])):
        at(fragment)
        said = driver.execute_script(note)
        check(bool(said) == bool(parts) and all(part in said for part in parts), f"address: {fragment}: the state says {said!r}")
    driver.execute_script("document.getElementById('rest').click()")
    check(driver.execute_script(note) == "", "address: the note on q̈ stays when q̈ has changed")
    quiet(driver, "address")
    print("  an address opens the exact view")


# the torques of the bars, and those of the curve at the cursor; whether the cursor is shown
CURSOR = """
  const ends = (of) => document.querySelector(of).getAttribute("d").match(/-?[0-9.]+/g).map(Number);
  const hand = document.querySelector("#plot .hand"), curve = ends("#plot .curve.total");
  const [x] = ends("#plot .hand");
  const at = curve.findIndex((value, index) => index % 2 === 0 && value >= x - 0.02);
  const marks = [...document.querySelectorAll("#plot .plot-axes text.end")].filter(of => of.textContent !== "time, s");
  const [low, high] = [marks[0], marks.at(-1)].map(of => [Number(of.textContent.replace("−", "-")), Number(of.getAttribute("y")) - 4]);
  const read = low[0] + (curve[at + 1] - low[1]) * (high[0] - low[0]) / (high[1] - low[1]);
  return { shown: !hand.hasAttribute("hidden"), read, span: high[0] - low[0], words: document.getElementById("plot-words").textContent,
           bar: rne.total()[Number(document.querySelector("#joints [aria-pressed=true]").dataset.plot) - 1] };
"""


def cursor(driver, page):
    """Where the cursor of the plot is shown, its curve has the torque of the bar, also with a force at the tip."""
    opened(driver, page)
    where = page.stem

    def moved(of, value):
        driver.execute_script("const of = document.querySelector(arguments[0]); of.value = arguments[1];"
                              "of.dispatchEvent(new Event('input', { bubbles: true }))", of, value)

    def agrees(shown, what):
        found = driver.execute_script(CURSOR)
        check(found["shown"] == shown, f"{where}: the cursor is {'not ' if shown else ''}shown {what}")
        check(("not on this motion" in found["words"]) != shown, f"{where}: {what} the plot says {found['words']!r}")
        if shown:
            check(abs(found["read"] - found["bar"]) <= 0.01 * found["span"], f"{where}: {what} the curve has {found['read']} and the bar {found['bar']}")

    agrees(False, "at first, where the arm moves at the start")
    for time in (0.3, 0.7):
        moved("#time", time)
        agrees(True, f"at {time} of the motion")
    moved("#duration", -0.3)
    agrees(True, "with another duration")
    moved('[data-tip="fy"]', 7)
    agrees(True, "with a force at the tip")
    moved('input[data-of="qd"][data-joint="1"]', 0.9)
    agrees(False, "with another velocity")
    moved("#time", 1)
    agrees(True, "at the end")
    driver.execute_script("document.getElementById('home').click()")
    agrees(False, "after a reset")
    quiet(driver, where)
    print("  the cursor of the plot stands where the bars are")


def headings(driver, page, inspection):
    """No heading of a cell says what the title, the formula or the letter before it has said."""
    opened(driver, page)
    plain = lambda text: re.sub(r"[ ()\xa0]", "", text)
    seen = 0
    for cell in inspection["cells"]:
        heads = driver.execute_script(
            "document.querySelector(`[data-cell=\"${arguments[0]}\"]`).click();"
            "return [...document.querySelectorAll('#cell h4')].map(of => "
            "  [of.firstChild.textContent, of.querySelector('.group-meaning').textContent])",
            f"{cell['joint']}-{cell['step']}")
        for sign, words in heads:
            seen += bool(words)
            isFormula = "=" in sign
            told = words.split(";")[0]
            check(told != cell["title"] and not (isFormula and re.match(r"^[fn] = ", told))
                  and not (plain(told) and (plain(told) == plain(sign) or told.startswith(f"{plain(sign)} "))),
                  f"{page.stem}: step {cell['step']} says {words!r} twice, behind {sign!r}")
    check(seen > 0, f"{page.stem}: no heading says what its quantity is")
    print("  headings say nothing twice")


def teaching(driver, rne, page, folder):
    """What a lecturer and a student use: the figure, large equations, cells that are not needed, a text to hand in."""
    def at(fragment):
        opened(driver, page, fragment)

    at("#q=0.6,-0.9")
    words = driver.execute_script(
        "return [...document.querySelectorAll('.drawn-text')].filter(of => getComputedStyle(of).display !== 'none').map(of => of.textContent)")
    right = ["θ1 = 34.4°", "a1 = 0.5 m", "com 0.25 m", "θ2 = −51.6°", "a2 = 0.4 m", "com 0.2 m"]
    check(sorted(words) == sorted(right), f"figure: it says {words}")
    bent = driver.execute_script(
        """
        const way = (of) => of.getAttribute("d").match(/-?[0-9.]+/g).map(Number);
        return ["1", "2"].map(joint => {
          const arc = way(document.querySelector(`[data-drawing="${joint}"] .arc`));
          const [x, y] = way(document.querySelector(`[data-drawing="${joint}"] .reference`));
          const angle = (a, b) => Math.atan2(y - b, a - x);
          return angle(...arc.slice(-2)) - angle(...arc.slice(0, 2));
        });
        """)
    check(all(abs(a - b) < 0.02 for a, b in zip(bent, (0.6, -0.9))), f"figure: its arcs are {bent} rad")
    driver.execute_script("document.querySelector('[data-view=\"3D\"]').click()")
    check(not driver.execute_script("return getComputedStyle(document.querySelector('[data-drawing]')).display !== 'none'"), "figure: it is drawn obliquely")
    needless = driver.execute_script(
        "return [...document.querySelectorAll('[data-cell]')].filter(of => of.textContent === 'not needed').map(of => of.dataset.cell)")
    check(needless == ["1-3", "2-3"], f"cells: not needed are {needless}")
    at("#reduced&equations")
    sides = driver.execute_script(
        "return [...document.querySelectorAll('.listing .statement')].map(of => of.innerText.trim())")
    check(sides and all(re.match(r"^[a-z]\w* += ", side) for side in sides), f"equations only: {sides[:2]}")
    before = "const of = document.querySelector('.component math'); return [parseFloat(getComputedStyle(of).fontSize), " \
             "document.getElementById('cell').clientWidth, document.getElementById('settings').open]"
    at("#cell=2.4")
    small = driver.execute_script(before)
    driver.find_element(By.ID, "lecture-mode").click()
    large = driver.execute_script(before)
    check(large[0] >= 1.49 * small[0], f"lecture: letters have {large[0]} pixels, before {small[0]}")
    check(large[1] > 1.3 * small[1] and small[2] and not large[2], f"lecture: {large}, before {small}")
    narrow(driver, "lecture")
    # the arm and the equations on one screen of a projector
    seen_on(driver, 1280, 720)
    at("#cell=2.4&lecture")
    for of in ("arm", "grid", "cell"):
        box = driver.execute_script("const { left, top, right, bottom, height } = document.getElementById(arguments[0])"
                                    ".getBoundingClientRect(); return { left, top, right, bottom, height }", of)
        check(box["top"] >= 0 and box["bottom"] <= 720 and box["height"] > 200, f"lecture: {of} is at {box}")
        check(box["left"] >= 0 and box["right"] <= (1280 if of == "cell" else 500), f"lecture: {of} is at {box}")
    # numbers in other axes than those of the equations say so, also to the last row
    at("#cell=2.3&lecture&joint")
    hint = driver.execute_script("const of = document.querySelector('[data-axes-hint]'); return of?.checkVisibility() ? of.textContent : ''")
    check("equations and code have them in the axes of link 2" in hint, f"lecture: of the axes is said {hint!r}")
    at("#cell=2.4")
    crossed = driver.execute_script("return [document.querySelectorAll('.struck').length, document.querySelectorAll('.struck .struck').length]")
    check(crossed[0] > 0 and crossed[1] == 0, f"cells: of {crossed[0]} strokes {crossed[1]} are on others")
    # what an exercise asks for is not the number beside it
    at("#cell=2.7&exercise")
    asked, card = driver.execute_script("return [rne.value('tau2').toPrecision(4), document.querySelector('[data-component=tau2]').textContent]")
    check(asked not in card and "= ? = ?" in card, f"exercise: the card of tau2 says {card!r}")
    # a slip is told in the letters of the lecture
    at("#cell=2.4&exercise")
    slip = driver.execute_script("return rne.value('ddc2_x') + rne.value('w2_z') * rne.value('wxd2_y')")
    driver.find_element(By.CSS_SELECTOR, '[data-exercise="ddc2_x"]').send_keys(f"{slip:.6f}", Keys.ENTER)
    told = driver.execute_script("return document.querySelector('[data-component=ddc2_x] .answer').textContent")
    check("The term ω₂z · (ω×d)₂y is left out" in told, f"exercise: a term that is left out is told as {told!r}")
    # a phone shows the cell of the address
    seen_on(driver, 390, 844)
    at("#cell=2.4")
    top = driver.execute_script("return document.getElementById('cell').getBoundingClientRect().top")
    check(-1 <= top <= 200, f"address: a phone has the cell {top} pixels below its upper edge")
    seen_on(driver, *SCREENS["desk"])
    # a worksheet: one answer that is right, one that is not
    at("#q=0.6,-0.9&qd=0.5,0.8&qdd=1,-1.5&cell=2.4&exercise")
    acceleration = driver.execute_script("return ['ddc2_x', 'ddc2_y'].map(name => rne.value(name))")
    for name, typed in (("ddc2_x", acceleration[0]), ("ddc2_y", -acceleration[1]), ("ddc2_y", acceleration[1] + 1)):
        field = driver.find_element(By.CSS_SELECTOR, f'[data-exercise="{name}"]')
        field.clear()
        field.send_keys(f"{typed:.5f}".replace(".", ","), Keys.ENTER)
    driver.execute_script("document.getElementById('hand-in').open = true")
    driver.find_element(By.ID, "student").send_keys("Ada, L.")
    text = driver.execute_script("return document.getElementById('answers').value")
    check("robot planar2, cells 2.4, student Ada  L.\n" in text, f"exercise: the text does not say what is asked: {text!r}")
    check("score: 1 of 2 right, 1 at the first attempt; attempts: 3" in text, f"exercise: the text has no score: {text!r}")
    sheet, key = folder / "answers.csv", folder / "key.csv"
    sheet.write_text(text)
    key.write_text("q1,q2,qd1,qd2,qdd1,qdd2\n0.6,-0.9,0.5,0.8,1,-1.5\n")
    marks = json.loads(subprocess.run([rne, "mark", "planar2", "--states", str(key), str(sheet), "--json"],
                                      check=True, capture_output=True).stdout)["marks"]
    first = marks[0].get("first_error") or {}
    check([marks[0]["student"], marks[0].get("points"), marks[0].get("of"), first.get("quantity"), first.get("component")]
          == ["Ada  L.", 1, 2, "acceleration", "y"], f"exercise: its text is marked {marks}")
    quiet(driver, "teaching")
    print("  figure, lecture, cells and a text to hand in")


# addresses at which words of a figure were cut at its edge
FIGURES = {
    "planar2": ["", "#lecture&cell=2.4", "#q=2.8,0.3&lecture", "#q=1.5,0&lecture", "#q=-1.6,0&lecture", "#q=3.1,0&lecture",
                "#q=0.6,1.3&lecture", "#q=0.6,1.3&qd=1,-0.5&qdd=0,0&cell=2.4&exercise"],
    "planar3": ["", "#q=0.4,-0.6,0.9&lecture", "#q=2.9,0.2,0.2&lecture", "#q=1.57,0,0&lecture"],
}


def figures(driver, pages):
    """The figure of a planar arm is whole, none of its words is on another, and at first no line is on a word."""
    for size in ((1280, 720), (390, 844)):
        seen_on(driver, *size)
        for robot, fragments in FIGURES.items():
            for fragment in fragments:
                opened(driver, pages[robot], fragment)
                cut, covered, struck = driver.execute_script(
                    """
                    const box = (of) => of.getBoundingClientRect();
                    const seen = (of) => [...document.querySelectorAll(of)].filter(at => at.checkVisibility() && box(at).width > 0);
                    const arm = box(document.getElementById("arm"));
                    const past = (at) => Math.max(arm.left - at.left, arm.top - at.top, at.right - arm.right, at.bottom - arm.bottom);
                    const words = seen("#arm text");
                    const cut = [...words, ...seen("#arm .solid .body, #arm .drawn")].filter(of => past(box(of)) > 0.5);
                    const isOn = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 2
                      && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 4;
                    const covered = words.flatMap((a, at) => words.slice(at + 1).filter(b => isOn(box(a), box(b)))
                      .map(b => [a.textContent, b.textContent]));
                    const points = (path) => Array.from({ length: path.getTotalLength() }, (_, at) => path.getPointAtLength(at));
                    const isIn = ({ x, y, width, height }, at) => at.x > x + 2 && at.x < x + width - 2 && at.y > y + 4 && at.y < y + height - 4;
                    const lines = seen("#arm .drawn").flatMap(points);
                    const struck = words.filter(of => of.closest(".drawing, .words, .arrow") && lines.some(at => isIn(of.getBBox(), at)));
                    return [cut.map(of => of.textContent || of.getAttribute("class")), covered, struck.map(of => of.textContent)];
                    """)
                where = f"{robot}{fragment} at {size[0]}x{size[1]}"
                check(not cut, f"figure: {where} cuts {cut}")
                check(not covered, f"figure: {where} writes on each other {covered}")
                check(fragment or not struck, f"figure: {where} draws lines through {struck}")
    seen_on(driver, *SCREENS["desk"])
    print("  figures are whole")


def dots(driver, page, media):
    """Dots stand above their letters, and do not lie on them."""
    opened(driver, page)
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": media})
    driver.execute_script("document.querySelector('[data-cell=\"2-4\"]').click()")
    gaps = driver.execute_script(
        """
        return [...document.querySelectorAll("#cell mover")].filter(of => of.checkVisibility({ contentVisibilityAuto: true })).map(of => {
          const [letter, dots] = [...of.children].map(part => part.getBoundingClientRect());
          return (letter.top - dots.bottom) / parseFloat(getComputedStyle(of).fontSize);
        });
        """)
    check(gaps and min(gaps) > 0.05, f"{page.stem}: dots stand {min(gaps, default=0):.2f} of a letter above it")
    struck = driver.execute_script("return getComputedStyle(document.querySelector('.struck')).printColorAdjust")
    check(media != "print" or struck == "exact", f"{page.stem}: on paper the lines of struck terms are {struck}")
    sliders = driver.execute_script("return [...document.querySelectorAll('input[type=range]')].filter(of => of.checkVisibility()).length")
    check((sliders == 0) == (media == "print"), f"{page.stem}: {sliders} sliders are shown on {media}")
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


def paper(driver, page):
    """Paper has the table and all vectors; headings stay with their cards, and the heads of numbers stand above them."""
    opened(driver, page, "#cell=2.4")
    driver.execute_script("window.dispatchEvent(new Event('beforeprint'))")
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    lines, kept, far = driver.execute_script(
        """
        const style = (of) => getComputedStyle(of);
        const seen = (of) => [...document.querySelectorAll(of)].filter(at => at.checkVisibility()).length;
        const lines = [seen("#table tbody tr"), seen("#vectors p"), seen("#cell details:not([open])")];
        // what is no block of ordinary flow does not break where it should
        const blocks = ["#steps", ".cell-area", "#cell"].every(of => style(document.querySelector(of)).display === "block");
        const heads = [...document.querySelectorAll("#cell .cell-head, #cell h4, #cell .on-the-way")];
        const right = (of) => { const range = document.createRange(); range.selectNodeContents(of); return range.getBoundingClientRect().right; };
        const far = [...document.querySelectorAll("#sliders thead th")].slice(2).map((head, at) => {
          const number = document.querySelectorAll("#sliders tbody tr:first-child td")[at + 1].querySelector(".number");
          return Math.abs(right(head) - number.getBoundingClientRect().right);
        });
        return [lines, blocks && heads.every(of => style(of).breakAfter === "avoid"), Math.max(...far)];
        """)
    # seven formulas for each link, and two more for its forces and moments
    dof = driver.execute_script("return rne.torques().length")
    check(lines == [dof, 9 * dof, 0], f"paper: rows of the table, vectors and folded parts are {lines}")
    check(kept, "paper: a heading may stand on another page than its cards")
    check(far < 8, f"paper: a head stands {far} pixels beside its numbers")
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    print("  paper keeps headings with their cards")


def large(driver, pages):
    """The cells of a large tree have room for their numbers, and the state of its joints stays in its card."""
    for size in ((1280, 720), (390, 844)):
        seen_on(driver, *size)
        opened(driver, pages["baxter"])
        cut, outside, tall = driver.execute_script(
            """
            const box = (of) => of.getBoundingClientRect();
            const cut = [...document.querySelectorAll("#grid button")].filter(of => box(of.firstChild).width > of.clientWidth
              || of.firstChild.scrollWidth > of.clientWidth || of.scrollWidth > of.clientWidth).map(of => of.dataset.cell);
            const card = document.querySelector(".motion-panel");
            const outside = [...card.querySelectorAll("input")].filter(of => of.checkVisibility() && box(of).right > box(card).right);
            return [cut, outside.map(of => of.dataset.name || of.dataset.of), box(card).height];
            """)
        where = f"baxter at {size[0]}x{size[1]}"
        check(not cut, f"{where}: cells are too narrow for their numbers: {cut}")
        check(not outside, f"{where}: fields stand outside their card: {outside}")
        check(tall < 600, f"{where}: the state is {tall} pixels high")
        narrow(driver, where)
    seen_on(driver, 1280, 720)
    for robot, fragment in (("baxter", "#lecture&cell=17.6"), ("panda_hand", "#lecture&cell=9.4")):
        opened(driver, pages[robot], fragment)
        cell, seen, hidden, formulas = driver.execute_script(
            """
            const box = (of) => of.getBoundingClientRect();
            const cell = box(document.querySelector("#grid [aria-pressed=true]"));
            const names = box(document.querySelector("#grid tbody th")), wrap = box(document.querySelector(".grid-wrap"));
            const hidden = [...document.querySelectorAll("#grid tbody tr")].filter(of => box(of).bottom > box(document.getElementById("views")).top);
            return [[cell.left, cell.right], [names.right, wrap.right], hidden.length,
                    [...document.querySelectorAll("#cell .formula")].map(of => of.textContent)];
            """)
        check(seen[0] <= cell[0] and cell[1] <= seen[1] + 1, f"{robot}{fragment}: the open cell is at {cell}, seen is {seen}")
        check(not hidden, f"{robot}{fragment}: the arm lies on {hidden} rows of the table")
        check(formulas and not any("_" in of for of in formulas), f"{robot}{fragment}: formulas are {formulas}")
    # the angle and its constant part have letters of their own
    opened(driver, pages["baxter"], "#cell=2.1")
    pieces = driver.execute_script(
        "return [...document.querySelectorAll('[data-component=angle2] dd.general math')].map(of => of.textContent)")
    check(len(pieces) == 3 and pieces[0].strip("=") not in pieces[1], f"baxter: the angle of joint 2 is {pieces}")
    seen_on(driver, *SCREENS["desk"])
    print("  a large tree fits")


def thumbs(driver, page):
    """On a phone targets are large enough for a thumb, and settings are folded."""
    opened(driver, page)
    small = driver.execute_script(
        """
        const found = [];
        for (const of of document.querySelectorAll("button, summary, input")) {
          if (!of.checkVisibility()) continue;
          const { height } = of.getBoundingClientRect();
          if (height < 44) found.push([of.id || of.textContent || of.dataset.of || of.dataset.tip || of.tagName, height]);
        }
        return found;
        """)
    check(not small, f"{page.stem}, phone: targets below 44 pixels: {small}")
    check(not driver.execute_script("return document.getElementById('settings').open"), f"{page.stem}, phone: settings are open")


def touch(page):
    """Fingers turn and zoom the arm, choose what they tap, and scroll the page beside the arm."""
    driver = browser(*SCREENS["phone"])
    try:
        driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
        opened(driver, page)
        # the eye stands still while fingers are on the arm
        driver.execute_script("document.getElementById('arm').scrollIntoView({ block: 'center' })")
        look = "const { yaw, pitch, zoom } = rne.view().look; return [yaw, pitch, zoom, window.scrollY]"

        def fingers(kind, *points):
            driver.execute_cdp_cmd("Input.dispatchTouchEvent", {
                "type": kind, "touchPoints": [{"x": x, "y": y, "id": at} for at, (x, y) in enumerate(points)]})

        def dragged(*paths):
            fingers("touchStart", *(path[0] for path in paths))
            for step in range(1, 11):
                fingers("touchMove", *((a + (c - a) * step / 10, b + (d - b) * step / 10) for (a, b), (c, d) in paths))
            fingers("touchEnd")
            return driver.execute_script(look)

        box = driver.execute_script(
            "const of = document.getElementById('arm').getBoundingClientRect(); return [of.x, of.y, of.width, of.height]")
        middle = box[0] + box[2] / 2, box[1] + box[3] / 2
        on_link = driver.execute_script(
            """
            const on = (of) => of.closest?.(".solid");
            const box = document.getElementById("arm").getBoundingClientRect();
            for (let x = box.x + 40; x < box.right - 40; x += 3)
              for (let y = box.y + 40; y < box.bottom - 40; y += 3)
                if (on(document.elementFromPoint(x, y))) return [x, y];
            """)
        for where, (x, y) in (("the picture's corner", (box[0] + 12, box[1] + box[3] - 12)), ("a link", on_link)):
            before = driver.execute_script(look)
            after = dragged(((x, y), (x + 60, y - 40)))
            # 60 pixels are 0.6 rad; a browser keeps the first few to itself
            check(0.35 < before[0] - after[0] < 0.65, f"touch: from {where} the arm turns by {before[0] - after[0]:.2f}")
            check(0.15 < before[1] - after[1] < 0.45, f"touch: from {where} it tilts by {before[1] - after[1]:.2f}")
            check(before[2:] == after[2:], f"touch: from {where} a finger zooms or scrolls: {before} {after}")
            driver.execute_script("rne.show({ ...rne.view(), look: arguments[0] })",
                                  dict(zip(("yaw", "pitch", "zoom"), before)))
        before = driver.execute_script(look)
        after = dragged(((middle[0] - 30, middle[1]), (middle[0] - 90, middle[1])),
                        ((middle[0] + 30, middle[1]), (middle[0] + 90, middle[1])))
        check(2 < after[2] / before[2] < 3.6, f"touch: fingers three times as far apart zoom by {after[2] / before[2]:.2f}")
        check(before[:2] == after[:2] and before[3] == after[3], f"touch: two fingers turn or scroll: {before} {after}")
        # one finger after two turns the arm again, and does not jump
        again = dragged(((middle[0], box[1] + 20), (middle[0] + 60, box[1] + 20)))
        check(0.35 < after[0] - again[0] < 0.65, f"touch: after a pinch a finger turns by {after[0] - again[0]:.2f}")
        # beside the arm a finger scrolls
        top = driver.execute_script("window.scrollTo(0, document.getElementById('sliders').offsetTop); return scrollY")
        dragged(((20, 600), (20, 300)))
        awaited(driver, 5, lambda driver: driver.execute_script("return window.scrollY") > top + 100)
        # a tap while it glides would stop it, and choose nothing
        resting = "const done = arguments[0], at = scrollY; setTimeout(() => done(scrollY === at), 200)"
        awaited(driver, 5, lambda driver: driver.execute_async_script(resting))
        # what is tapped is chosen
        for of in ("[data-arrow]:not([hidden]) .hit", '[data-component="g2_x"] .own-name'):
            driver.execute_script(
                "rne.show({ ...rne.view(), pinned: null }); document.querySelector('[data-cell=\"2-5\"]').click();"
                "document.querySelector(arguments[0]).scrollIntoView({ block: 'center' })", of)
            x, y, right = driver.execute_script(
                """
                const node = document.querySelector(arguments[0]);
                const box = node.getBoundingClientRect();
                const way = node.getTotalLength && node.getPointAtLength(node.getTotalLength() * 0.7);
                const { x, y } = way ? way.matrixTransform(node.getScreenCTM())
                  : { x: box.x + box.width / 2, y: box.y + box.height / 2 };
                const at = document.elementFromPoint(x, y)?.closest("[data-arrow], [data-name]");
                return [x, y, at?.dataset.arrow || at?.dataset.name || null];
                """, of)
            fingers("touchStart", (x, y))
            fingers("touchEnd")
            awaited(driver, 5, lambda driver: driver.execute_script(
                "return document.querySelectorAll('.lit').length"))
            lit = driver.execute_script(
                "return [...document.querySelectorAll('.lit')].map(of => of.dataset.arrow || of.dataset.name)")
            check(right and right in lit, f"touch: a tap on {right} lights {lit}")
            told = driver.execute_script(
                """
                const box = document.querySelector("[data-readout]").getBoundingClientRect();
                const inSight = box.height > 0 && box.top >= 0 && box.bottom <= window.innerHeight + 1;
                document.querySelector(".let-go").click();
                return [inSight, document.querySelectorAll(".lit").length];
                """)
            check(told == [True, 0], f"touch: of {right} the readout is in sight, and let go: {told}")
        quiet(driver, "touch")
        print("  fingers turn, zoom, scroll and choose")
    finally:
        driver.quit()


def statements(driver, robot, inspection):
    """Every statement leads to its equation, value, unit and arrow."""
    names = [statement["name"] for statement in inspection["statements"]]
    walked = driver.execute_script(
        """
        return arguments[0].map(name => {
          rne.select(name);
          const lit = [...document.querySelectorAll(".lit")];
          return {
            name: lit.some(of => of.dataset.name === name),
            component: lit.some(of => of.closest("[data-component]")),
            arrow: lit.some(of => of.dataset.arrow !== undefined),
            value: Number.isFinite(rne.value(name)),
            readout: document.querySelector("[data-readout]").textContent,
          };
        });
        """, names)
    for name, found in zip(names, walked, strict=True):
        known = inspection["names"][name]
        kind = inspection["robot"]["joints"][known["joint"] - 1]["kind"]
        unit = inspection["quantities"][known["quantity"]]["units"][kind == "prismatic"].replace(" ", "·")
        for what in ("name", "component", "arrow", "value"):
            check(found[what], f"{robot}: {name} leads to no {what}")
        check(name in found["readout"] and unit in found["readout"], f"{robot}: the readout has no {name} in {unit}")
    print(f"  {len(walked)} statements lead to equation, value, unit and arrow")
    back = driver.execute_script(
        """
        return [...document.querySelectorAll("[data-arrow]")].map(arrow => {
          arrow.focus();
          return [arrow.dataset.arrow, [...document.querySelectorAll(".lit[data-name]")].map(of => of.dataset.name)];
        });
        """)
    check(len(back) > 0, f"{robot}: there are no arrows")
    for arrow, lit in back:
        check(lit, f"{robot}: arrow {arrow} leads to no name")
    print(f"  {len(back)} arrows lead back")


def in_code(why):
    """A reason in the letters of the page or in names of the code, in one writing."""
    low = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789", "_")
    return why.translate(low).replace("α", "alpha").replace("θ", "theta").replace("\xa0", " ").lower()


def reasons(driver, robot, inspection):
    """What a card calls gone, and what uses it, are what the inspection says of the component."""
    code = {of["name"]: re.findall(r"\w+", of["rust"].split("=", 1)[1]) for of in inspection["statements"]}
    told = used = 0
    opened_cells = driver.execute_script(
        """
        const texts = (card, of) => [...card.querySelectorAll(of)].map(found => found.textContent);
        return arguments[0].map(cell => {
          document.querySelector(`[data-cell="${cell}"]`).click();
          return Object.fromEntries([...document.querySelectorAll("[data-component]")].map(card =>
            [card.dataset.component, [texts(card, "dd.gone .why"), texts(card, "dd.users code")]]));
        });
        """, [f"{cell['joint']}-{cell['step']}" for cell in inspection["cells"]])
    for cell, cards in zip(inspection["cells"], opened_cells, strict=True):
        for component in cell["components"]:
            name = component["name"]
            whys, users = cards[name]
            # the page has the letters of the lecture, and names the numbers that "constants" are
            right = {in_code(of["why"]) for of in component["folded"]} - {"constants"}
            whys = set(map(in_code, whys))
            # `rne show` names products alone; a term that is one name stands on the page, too
            check(right <= whys, f"{robot}: {name} is gone because {sorted(right)}, on the page {whys}")
            told += len(right)
            own = set(component["statements"])
            readers = [reader for reader, names in code.items() if reader not in own and own & set(names)]
            check(users == readers, f"{robot}: {name} is used by {readers}, on the page by {users}")
            used += bool(users)
    check(told > 0 and used > 0, f"{robot}: no card tells a reason or a user")
    print(f"  {told} reasons and the users of {used} components are those of the inspection")


def sliders(driver, robot):
    slider = driver.find_element(By.CSS_SELECTOR, 'input[type=range][data-joint="1"][data-of="qdd"]')
    torque = driver.find_element(By.CSS_SELECTOR, '[data-torque="1"]')
    before = torque.text
    slider.send_keys(*[Keys.ARROW_RIGHT] * 5)
    check(torque.text != before, f"{robot}: a key on a slider changes no torque")
    took = driver.execute_async_script(
        """
        const done = arguments[0];
        const slider = document.querySelector('input[type=range][data-joint="1"][data-of="q"]');
        const took = [];
        const once = () => {
          if (took.length === 60) { done(took); return; }
          const start = performance.now();
          slider.value = String(Number(slider.min) + (Number(slider.max) - Number(slider.min)) * took.length / 60);
          slider.dispatchEvent(new Event("input", { bubbles: true }));
          // what is left to do before the next frame is laid out and painted
          requestAnimationFrame(() => {
            document.body.getBoundingClientRect();
            took.push(performance.now() - start);
            setTimeout(once, 0);
          });
        };
        requestAnimationFrame(once);
        """)
    work = driver.execute_script(
        """
        const slider = document.querySelector('input[type=range][data-joint="1"][data-of="q"]');
        const took = [];
        for (let i = 0; i < 60; i++) {
          const start = performance.now();
          slider.value = String(i / 60);
          slider.dispatchEvent(new Event("input", { bubbles: true }));
          if (rne.paint) rne.paint();
          document.body.getBoundingClientRect();
          took.push(performance.now() - start);
        }
        return took;
        """)
    paint = driver.execute_script(
        "return performance.getEntriesByType('paint').filter(of => of.name === 'first-contentful-paint')[0]?.startTime")
    print(f"  first paint {paint or float('nan'):.0f} ms; slider to repaint: work {statistics.median(work):.1f} ms, "
          f"with the wait for the frame {statistics.median(took):.1f} ms (medians of 60)")


def hover(driver, robot):
    name = driver.find_elements(By.CSS_SELECTOR, "[data-component] [data-name]")
    shown = [of for of in name if of.is_displayed()]
    if check(shown, f"{robot}: no names are shown"):
        driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", shown[0])
        ActionChains(driver).move_to_element(shown[0]).perform()
        check("lit" in (shown[0].get_attribute("class") or ""), f"{robot}: what is hovered over is not lit")
    # what is pointed at stays where it is, however much there is to say of it
    tall = driver.execute_script(
        """
        const box = document.querySelector("[data-readout]");
        const names = [...document.querySelectorAll("[data-component]")].map(of => of.dataset.component);
        return [...names, "tau1", "n0_1_x", "c1"].map(name => { rne.select(name); return box.offsetHeight; });
        """)
    check(len(set(tall)) == 1, f"{robot}: the readout is {sorted(set(tall))} pixels high")


def keyboard(driver, robot):
    """Tab reaches sliders, switches, cells and names."""
    driver.execute_script("document.activeElement.blur(); window.scrollTo(0, 0)")
    reached = set()
    body = driver.find_element(By.TAG_NAME, "body")
    body.send_keys(Keys.TAB)
    for _ in range(400):
        kind = driver.execute_script(
            """
            const at = document.activeElement;
            if (!at || at === document.body) return "body";
            for (const kind of ["cell", "switch", "joint", "name", "arrow"]) if (kind in at.dataset) return kind;
            return at.tagName;
            """)
        reached.add(kind)
        driver.switch_to.active_element.send_keys(Keys.TAB)
        if {"cell", "switch", "joint", "name", "arrow"} <= reached:
            break
    for kind in ("cell", "switch", "joint", "name", "arrow"):
        check(kind in reached, f"{robot}: Tab reaches no {kind}: {sorted(reached)}")
    cell = driver.find_element(By.CSS_SELECTOR, '[data-cell="1-1"]')
    cell.send_keys(Keys.ENTER)
    check(driver.find_elements(By.CSS_SELECTOR, '[data-component="w1_z"]'), f"{robot}: Enter opens no cell")


def exercise(driver, robot):
    switch = driver.find_element(By.CSS_SELECTOR, '[data-switch="exercise"]')
    dof = driver.execute_script("return rne.torques().length")
    driver.execute_script("rne.setState(arguments[0])",
                          {"q": [0.4] * dof, "qd": [0.7] * dof, "qdd": [0.3] * dof})
    driver.find_element(By.CSS_SELECTOR, '[data-cell="1-1"]').click()
    driver.execute_script("arguments[0].click()", switch)
    fields = driver.find_elements(By.CSS_SELECTOR, '[data-exercise="w1_z"]')
    if not check(fields, f"{robot}: the exercise asks for no w1_z"):
        return
    shown = driver.find_element(By.CSS_SELECTOR, '[data-component="w1_z"]').text
    check("0.7" not in shown, f"{robot}: the exercise shows what it asks for: {shown!r}")
    if robot == "planar2":
        driver.find_element(By.CSS_SELECTOR, '[data-cell="2-1"]').click()
        driver.find_element(By.CSS_SELECTOR, '[data-component="w2_z"] .first-term').click()
        told = driver.find_element(By.CSS_SELECTOR, '[data-component="w2_z"] .answer').text
        check("The first term is" in told and "0.7" in told, f"{robot}: the first term of w2_z is told as {told!r}")
        driver.find_element(By.CSS_SELECTOR, '[data-cell="1-1"]').click()
    for typed, told in (("-0.7", "sign"), ("0.7", "")):
        field = driver.find_element(By.CSS_SELECTOR, '[data-exercise="w1_z"]')
        field.clear()
        field.send_keys(typed, Keys.ENTER)
        answer = driver.find_element(By.CSS_SELECTOR, '[data-component="w1_z"]').text.lower()
        check(told in answer, f"{robot}: {typed} for w1_z is answered without `{told}`: {answer!r}")
    if robot == "stanford":
        # q̇ ω × e of the slide, which counts twice
        driver.find_element(By.CSS_SELECTOR, '[data-cell="3-4"]').click()
        once = driver.execute_script("return rne.value('ddc3_x') - rne.value('w3_y') * rne.value('qd3')")
        driver.find_element(By.CSS_SELECTOR, '[data-exercise="ddc3_x"]').send_keys(f"{once:.6f}", Keys.ENTER)
        answer = driver.find_element(By.CSS_SELECTOR, '[data-component="ddc3_x"]').text
        check("lost its factor 2" in answer, f"{robot}: half a Coriolis term is answered by {answer!r}")
    driver.execute_script("arguments[0].click()", driver.find_element(By.CSS_SELECTOR, '[data-switch="exercise"]'))


def questions(driver, robot):
    """Where answers stand that students looked for: centres of mass, parts of a torque, a step's savings, reasons."""
    def readout(of):
        return driver.execute_script(
            """
            document.querySelector(arguments[0]).dispatchEvent(new MouseEvent("click", { bubbles: true }));
            return document.querySelector("[data-readout]").textContent;
            """, of)
    driver.execute_script("document.getElementById('home').click()")
    last = driver.execute_script("return Math.min(2, rne.torques().length)")
    said = readout(f'[data-com="{last}"]')
    check(f"d{last}_x" in said and f"centre of mass of link {last}, in the world" in said, f"{robot}: a centre of mass says {said!r}")
    readout('[data-cell="1-7"]')
    before = driver.execute_script("return rne.parts()")
    said = readout('[data-component="tau1"] .own-name')
    for part in ("gravity", "Coriolis and centrifugal", "inertia"):
        check(part in said, f"{robot}: the readout of tau1 has no {part}: {said!r}")
    driver.execute_script("document.getElementById('faster').click()")
    after = driver.execute_script("return rne.parts()")
    near = all(abs(4 * a - b) <= 1e-9 * max(1, abs(b)) for a, b in zip(before["velocity"], after["velocity"], strict=True))
    check(near and before["gravity"] == after["gravity"], f"{robot}: at twice the rates {before} becomes {after}")
    readout('[data-cell="1-5"]')
    head, products = driver.execute_script(
        """
        const of = JSON.parse(document.getElementById("data").textContent).cells.filter(({ step }) => step === 5);
        const sum = (which) => of.reduce((all, cell) => all + cell[which].products, 0);
        return [document.querySelector(".cell-head").textContent, [sum("before"), sum("after")]];
        """)
    saved = f"{products[1]} of {products[0]} products ({products[0] - products[1]} saved)"
    check(saved in head, f"{robot}: step 5 does not say {saved!r}: {head!r}")
    driver.execute_script("document.getElementById('home').click()")


def accessible(driver, where, options=None):
    found = axe_selenium.Axe().run(driver, options=options)
    grave = [of for of in found["violations"] if of["impact"] in ("serious", "critical")]
    for violation in grave:
        places = [node["target"] for node in violation["nodes"]][:3]
        check(False, f"{where}: axe: {violation['id']}: {violation['help']}: {places}")
    print(f"  axe, {where}: {len(found['violations'])} remarks, {len(grave)} of them serious")


def quiet(driver, where):
    for entry in driver.get_log("browser"):
        check(entry["level"] not in ("SEVERE", "WARNING"), f"{where}: the console says {entry['message']}")


def narrow(driver, where):
    wide = driver.execute_script("return document.documentElement.scrollWidth - window.innerWidth")
    check(wide <= 0, f"{where}: {wide} pixels do not fit the width")


def picture(driver, path, most):
    driver.save_screenshot(str(path))
    image = Image.open(path).convert("RGB").quantize(64, dither=Image.Dither.NONE)
    image.save(path, optimize=True)
    check(path.stat().st_size <= most, f"{path.name} has {path.stat().st_size} bytes, more than {most}")


def main():
    rne, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    pictures = pathlib.Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else folder
    pictures.mkdir(parents=True, exist_ok=True)
    pages = {}
    for robot in [*ROBOTS, "planar3", "panda_hand", "baxter"]:
        pages[robot] = folder / f"{robot}.html"
        pages[robot].unlink(missing_ok=True)
        subprocess.run([rne, "report", robot, "-o", str(pages[robot])], check=True, capture_output=True)
    floats = {"standing_hyq": ["lf_foot", "lh_foot", "rf_foot", "rh_foot"], "satellite": ["tip"]}
    for robot in floats:
        pages[robot] = folder / f"{robot}.html"
        subprocess.run([rne, "report", f"docs/{robot}.yaml", "--force", "-o", str(pages[robot])], check=True, capture_output=True)
    driver = browser(*SCREENS["desk"])
    try:
        for robot, tips in floats.items():
            floating(driver, rne, f"docs/{robot}.yaml", pages[robot], tips)
        figures(driver, pages)
        for media in ("screen", "print"):
            dots(driver, pages["puma560"], media)
        paper(driver, pages["puma560"])
        large(driver, pages)
        for robot in ROBOTS:
            page = pages[robot]
            print(f"{robot}: {page.stat().st_size} bytes")
            check(page.stat().st_size <= LARGEST, f"{robot}: more than {LARGEST} bytes")
            inspection = json.loads(
                subprocess.run([rne, "show", robot, "--json"], check=True, capture_output=True).stdout)
            opened(driver, page)
            dof = len(inspection["robot"]["joints"])
            torques(driver, rne, robot, dof)
            wrench(driver, rne, robot, dof)
            axes(driver, rne, robot, inspection)
            if robot not in WHOLE and not IS_FULL:
                quiet(driver, robot)
                continue
            sliders(driver, robot)
            statements(driver, robot, inspection)
            reasons(driver, robot, inspection)
            hover(driver, robot)
            keyboard(driver, robot)
            exercise(driver, robot)
            questions(driver, robot)
            accessible(driver, f"{robot}, light")
            narrow(driver, f"{robot}, desk")
            quiet(driver, robot)
            views(driver, page)
            cursor(driver, page)
            headings(driver, page, inspection)
            if robot == "planar2":
                address(driver, page)
                teaching(driver, rne, page, folder)
    finally:
        driver.quit()
    touch(pages["puma560"])
    driver = browser(*SCREENS["desk"])
    try:
        for robot in WHOLE:
            for screen, size in SCREENS.items():
                for dark in (False, True):
                    seen_on(driver, *size, dark=dark)
                    where = f"{robot}, {screen}, {'dark' if dark else 'light'}"
                    opened(driver, pages[robot])
                    narrow(driver, where)
                    if screen == "phone":
                        thumbs(driver, pages[robot])
                    # the pages of two arms differ in their data alone
                    if (dark or screen == "phone") and (IS_FULL or robot == WHOLE[-1]):
                        accessible(driver, where)
                    quiet(driver, where)
                    name = f"{robot}-{screen}{'-dark' if dark else ''}.png"
                    picture(driver, pictures / name, 150_000)
                    if screen == "desk" and not dark:
                        driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
                        picture(driver, pictures / f"{robot}-print.png", 150_000)
    finally:
        driver.quit()
    print(f"{len(failures)} failures" if failures else "all of it holds")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
