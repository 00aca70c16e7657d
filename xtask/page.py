"""The page of `rne report` in headless Chromium: is what it shows right, and can everybody use it?

Usage: python page.py RNE FOLDER [PICTURES]     RNE is the binary, pages go to FOLDER; `cargo xtask page` calls it.
"""

import json
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

ROBOTS = ["planar1", "planar2", "stanford", "puma560", "panda"]
STATES = 50
TOLERANCE = 1e-12
LARGEST = 400_000  # bytes of the page of an arm with 7 joints
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
    # a window has a smallest width, a phone has not
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500})
    scheme = "dark" if dark else "light"
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                           {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
    return driver


def opened(driver, page):
    driver.get(page.as_uri())
    WebDriverWait(driver, 20).until(
        lambda driver: driver.execute_script("return document.documentElement.dataset.ready") == "1")


def lists(values):
    return ",".join(repr(value) for value in values)


def torques_of_eval(rne, robot, state):
    command = [rne, "eval", robot, "--json"] + [f"--{name}={lists(state[name])}" for name in ("q", "qd", "qdd")]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["result"]


def torques(driver, rne, robot, dof):
    chance = random.Random(13)
    worst = 0.0
    for _ in range(STATES):
        state = {name: [chance.uniform(-2, 2) for _ in range(dof)] for name in ("q", "qd", "qdd")}
        driver.execute_script("rne.setState(arguments[0])", state)
        shown = driver.execute_script("return rne.torques()")
        right = torques_of_eval(rne, robot, state)
        largest = max(1.0, max(abs(torque) for torque in right))
        worst = max(worst, max(abs(a - b) for a, b in zip(shown, right, strict=True)) / largest)
    check(worst <= TOLERANCE, f"{robot}: torques differ by {worst:.1e}")
    print(f"  torques at {STATES} states: worst difference {worst:.1e} of the largest")


def statements(driver, robot, inspection):
    """Every statement leads to its equation, value, unit and arrow."""
    walked = 0
    for statement in inspection["statements"]:
        name = statement["name"]
        found = driver.execute_script(
            """
            const name = arguments[0];
            rne.select(name);
            const lit = [...document.querySelectorAll(".lit")];
            const readout = document.querySelector("[data-readout]").textContent;
            return {
              name: lit.some(of => of.dataset.name === name),
              component: lit.some(of => of.closest("[data-component]")),
              arrow: lit.some(of => of.dataset.arrow !== undefined),
              value: Number.isFinite(rne.value(name)),
              readout,
            };
            """, name)
        known = inspection["names"][name]
        kind = inspection["robot"]["joints"][known["joint"] - 1]["kind"]
        unit = inspection["quantities"][known["quantity"]]["units"][kind == "prismatic"].replace(" ", "·")
        for what in ("name", "component", "arrow", "value"):
            check(found[what], f"{robot}: {name} leads to no {what}")
        check(name in found["readout"] and unit in found["readout"], f"{robot}: the readout has no {name} in {unit}")
        walked += 1
    print(f"  {walked} statements lead to equation, value, unit and arrow")
    arrows = driver.find_elements(By.CSS_SELECTOR, "[data-arrow]")
    check(len(arrows) > 0, f"{robot}: there are no arrows")
    back = 0
    for arrow in driver.execute_script("return [...document.querySelectorAll('[data-arrow]')].map(of => of.dataset.arrow)"):
        names = driver.execute_script(
            """
            const arrow = document.querySelector(`[data-arrow="${arguments[0]}"]`);
            arrow.focus();
            return [...document.querySelectorAll(".lit[data-name]")].map(of => of.dataset.name);
            """, arrow)
        check(names, f"{robot}: arrow {arrow} leads to no name")
        back += 1
    print(f"  {back} arrows lead back")


def reasons(driver, robot, inspection):
    """What a card calls gone, and what uses it, are what the inspection says of the component."""
    code = {of["name"]: re.findall(r"\w+", of["rust"].split("=", 1)[1]) for of in inspection["statements"]}
    told = used = 0
    for cell in inspection["cells"]:
        driver.find_element(By.CSS_SELECTOR, f'[data-cell="{cell["joint"]}-{cell["step"]}"]').click()
        cards = driver.execute_script(
            """
            const texts = (card, of) => [...card.querySelectorAll(of)].map(found => found.textContent);
            return Object.fromEntries([...document.querySelectorAll("[data-component]")].map(card =>
              [card.dataset.component, [texts(card, "dd.gone .why"), texts(card, "dd.users code")]]));
            """)
        for component in cell["components"]:
            name = component["name"]
            whys, users = cards[name]
            right = {of["why"] for of in component["folded"]}
            # `rne show` names products alone; a term that is one name stands on the page, too
            check(right <= set(whys), f"{robot}: {name} is gone because {sorted(right)}, on the page {whys}")
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
    for robot in ROBOTS:
        pages[robot] = folder / f"{robot}.html"
        pages[robot].unlink(missing_ok=True)
        subprocess.run([rne, "report", robot, "-o", str(pages[robot])], check=True, capture_output=True)
    driver = browser(*SCREENS["desk"])
    try:
        for robot, page in pages.items():
            print(f"{robot}: {page.stat().st_size} bytes")
            check(page.stat().st_size <= LARGEST, f"{robot}: more than {LARGEST} bytes")
            inspection = json.loads(
                subprocess.run([rne, "show", robot, "--json"], check=True, capture_output=True).stdout)
            opened(driver, page)
            torques(driver, rne, robot, len(inspection["robot"]["joints"]))
            sliders(driver, robot)
            statements(driver, robot, inspection)
            reasons(driver, robot, inspection)
            hover(driver, robot)
            keyboard(driver, robot)
            exercise(driver, robot)
            accessible(driver, f"{robot}, light")
            narrow(driver, f"{robot}, desk")
            quiet(driver, robot)
    finally:
        driver.quit()
    for robot in ("planar2", "puma560"):
        for screen, size in SCREENS.items():
            for dark in (False, True):
                driver = browser(*size, dark=dark)
                try:
                    where = f"{robot}, {screen}, {'dark' if dark else 'light'}"
                    opened(driver, pages[robot])
                    narrow(driver, where)
                    if dark or screen == "phone":
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
