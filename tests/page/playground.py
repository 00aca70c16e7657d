"""The playground in headless Chromium: does it say what the compiler says, and show what the compiler makes?

Usage: python playground.py RNE PAGE     RNE is the binary; `cargo xtask playground --test` calls it.
"""

import base64
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile
import threading
import zlib
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

import page as report
from page import SCREENS, TOLERANCE, awaited, browser, check, failures, narrow, picture, quiet, seen_on, torques_of_eval

STATES = 10
TIMES = 5


def settled(driver):
    """Until the compiler has answered, and what it made is shown."""
    awaited(driver, 60, lambda driver: driver.execute_script(
        "return window.playground && !playground.compiler.asked && !playground.next && "
        "['good', 'wrong'].includes(document.documentElement.dataset.is)"))
    return driver.execute_script("return document.documentElement.dataset.is")


def opened(driver, address):
    driver.get("about:blank")
    driver.get(address)
    return settled(driver)


def accessible(driver, where):
    # the page inside is looked at by page.py; axe would wait for itself there
    report.accessible(driver, where, "{iframes: false}")


def status(driver):
    return driver.find_element(By.ID, "status").text


def text(driver):
    return driver.execute_script("return document.getElementById('text').value")


def typed(driver, new):
    """Puts a text as a paste does; what the page then does is awaited."""
    driver.execute_script(
        """
        document.documentElement.dataset.is = "typed";
        const area = document.getElementById("text");
        area.value = arguments[0];
        area.dispatchEvent(new InputEvent("input", { bubbles: true }));
        """, new)
    return settled(driver)


def chosen(driver, robot):
    driver.execute_script(
        """
        const menu = document.getElementById("robots");
        menu.value = arguments[0];
        menu.dispatchEvent(new Event("change"));
        """, robot)
    return settled(driver)


def inner(driver, script, *given):
    """Runs a script in the page of the arm."""
    driver.switch_to.frame(driver.find_element(By.CSS_SELECTOR, "#shown iframe"))
    try:
        return driver.execute_script(script, *given)
    finally:
        driver.switch_to.default_content()


def torques(driver, rne, file, dof, where):
    """The torques of the page beside those of the recursion on the same file."""
    chance, worst = random.Random(17), 0.0
    for _ in range(STATES):
        state = {name: [chance.uniform(-2, 2) for _ in range(dof)] for name in ("q", "qd", "qdd")}
        shown = inner(driver, "rne.setState(arguments[0]); return rne.torques()", state)
        right = torques_of_eval(rne, file, state)
        size = max(abs(value) for value in right)
        worst = max(worst, max(abs(a - b) for a, b in zip(shown, right, strict=True)) / size)
    check(worst <= TOLERANCE, f"{where}: torques differ by {worst:.1e}")
    print(f"  {where}: torques at {STATES} states, worst difference {worst:.1e} of the largest")


def complaints(rne, wrong):
    """What `rne check` says of a text: severity, line, column and message of each."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "robot.yaml"
        file.write_text(wrong, encoding="utf-8")
        said = subprocess.run([rne, "check", str(file)], capture_output=True, encoding="utf-8")
    pattern = re.compile(r"^(error|warning|note): (.*)\n *--> .*:(\d+):(\d+)$", re.M)
    return [(kind, int(line), int(column), told) for kind, told, line, column
            in pattern.findall(said.stdout + said.stderr)]


def messages(driver):
    told = []
    for item in driver.find_elements(By.CSS_SELECTOR, "#messages li"):
        part = lambda name: "".join(of.text for of in item.find_elements(By.CLASS_NAME, name))
        line, column = part("place").strip().split(":")
        told.append((part("severity"), int(line), int(column), part("message"), part("help")))
    return told


def underlined(driver):
    """What is underlined as a mistake: where its first character is, the text, and how."""
    return driver.execute_script(
        """
        const marks = [...document.querySelectorAll("#ink .mark.error")];
        const before = (of) => {
          const range = document.createRange();
          range.setStart(document.getElementById("ink"), 0);
          range.setEndBefore(of);
          return range.toString().length;
        };
        return marks.map(of => [before(of), of.textContent, getComputedStyle(of).textDecorationLine]);
        """)


def mistakes(driver, rne, puma):
    """A wrong key is underlined, told as `rne check` tells it, and the page stays; mended, the page follows."""
    at = puma.index("mass:")
    wrong = puma.replace("mass:", "masss:", 1)
    shown = driver.execute_script("return document.documentElement.dataset.shown")
    check(typed(driver, wrong) == "wrong", "`masss` is taken")
    said, right = messages(driver), complaints(rne, wrong)
    check(right and [of[:4] for of in said] == right, f"`masss`: the page says {said}, `rne check` {right}")
    check(any("did you mean `mass`?" in of[4] for of in said), f"`masss`: no `did you mean`: {said}")
    marked = underlined(driver)
    check([at, "masss", "underline"] in marked, f"`masss` at {at} is not underlined: {marked}")
    check(driver.find_element(By.ID, "shown").get_attribute("data-state") == "stale", "the last good page is not dimmed")
    check("shown is the last text without" in status(driver), f"the status is {status(driver)!r}")
    check(inner(driver, "return rne.torques().length") == 6, "the last good page does not compute any more")
    line = driver.execute_script("const box = (of) => of.getBoundingClientRect(), at = box(document.querySelector('#ink .mark.error'));"
                                 "const of = box(document.getElementById('scroller')); return at.top >= of.top && at.bottom <= of.bottom")
    check(line, "the messages hide the line of the mistake")
    driver.find_element(By.CSS_SELECTOR, "#messages button").click()
    selected = driver.execute_script("const of = document.getElementById('text'); return [document.activeElement === of,"
                                     " of.value.slice(of.selectionStart, of.selectionEnd)]")
    check(selected == [True, "masss"], f"a click on the message leads to {selected}")
    # a hand mends it: behind the selection one letter goes
    driver.find_element(By.ID, "text").send_keys(Keys.ARROW_RIGHT, Keys.BACKSPACE)
    awaited(driver, 30, lambda driver: driver.execute_script("return document.documentElement.dataset.shown") != shown)
    settled(driver)
    check(text(driver) == puma, "the text is not as it was")
    check(driver.find_element(By.ID, "shown").get_attribute("data-state") == "good", "the page stays dimmed")
    check(not driver.find_elements(By.CSS_SELECTOR, "#ink .mark.error"), "what is mended stays underlined")
    # characters beyond ASCII and beyond the first plane before the mistake, in its line and above
    odd = ("format: 1\nname: odd\nsource: \U0001f916 ä\nconvention: standard\ngravity: [0, -9.81, 0]\njoints:\n"
           '  - {name: "\U0001f916 ä", tpye: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mass: 1}}\n')
    for wrong in (odd, puma.replace("format: 1", "format: 1\n\tname"), "", "joints: [", puma + "\nnames: 3\n"):
        typed(driver, wrong)
        said, right = messages(driver), complaints(rne, wrong)
        check(right and [of[:4] for of in said] == right, f"{wrong[:30]!r}…: the page says {said}, `rne check` {right}")
        if wrong == odd:
            # the page counts in units of UTF-16, of which the first letter has two
            at = len(odd[:odd.index("tpye")].encode("utf-16-le")) // 2
            marked = underlined(driver)
            check([at, "tpye", "underline"] in marked, f"`tpye` at {at} is not underlined: {marked}")
    print("  mistakes: underlined, told as `rne check` tells them, mended")


def edited(driver, rne, puma):
    """Other numbers: the page follows, as it was looked at."""
    chosen(driver, "puma560")
    state = {"q": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6], "qd": [1, 2, 3, 4, 5, 6], "qdd": [0] * 6}
    inner(driver, "rne.setState(arguments[0]); document.querySelector('[data-switch=c]').click();"
                  "for (const of of ['[data-switch=base]', '[data-shows=frames]', '[data-shows=masses]'])"
                  "  document.querySelector(of).click();"
                  "document.querySelector('[data-cell=\"3-4\"]').click()", state)
    heavier = re.sub(r"^title: .*$", "title: A heavier one", puma, count=1, flags=re.M)
    heavier = heavier.replace("mass: ", "mass: 1 + ", 2)
    check(typed(driver, heavier) == "good", f"other masses are refused: {messages(driver)}")
    check(driver.title.startswith("A heavier one"), f"the title is {driver.title!r}")
    view = inner(driver, "return rne.view()")
    check(view["state"] == state and view["language"] == "c" and view["cell"] == [3, 4],
          f"after an edit the page is looked at as {view}")
    shown = inner(driver, "return ['[data-switch=base]', '[data-shows=frames]', '[data-shows=masses]'].map("
                          "of => document.querySelector(of).getAttribute('aria-pressed'))")
    check(shown == ["true", "true", "false"] and [view["axes"], view["frames"], view["masses"]] == ["base", True, False],
          f"after an edit axes, frames and masses are {shown}")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "heavier.yaml"
        file.write_text(heavier, encoding="utf-8")
        torques(driver, rne, str(file), 6, "puma560 with other masses")
    return heavier


def links(driver, address, heavier):
    """What is in the address comes back, also where the text has odd letters, and a damaged one says so."""
    odd = heavier.replace("A heavier one", "Ärm \U0001f916 <b>&amp;")
    typed(driver, odd)
    awaited(driver, 10, lambda driver: "#text=" in driver.current_url)
    link = driver.current_url
    check(re.search(r"#text=[\w-]+(&[\w=.,-]+)*$", link), f"the link has letters that are none of an address: {link[-80:]}")
    opened(driver, link)
    check(text(driver) == odd, "the text of a link is another one")
    check("Ärm" in driver.title, f"the title of a link is {driver.title!r}")
    chosen(driver, "ur5")
    driver.back()
    awaited(driver, 30, lambda driver: text(driver) == odd)
    settled(driver)
    print(f"  a link of {len(odd)} characters has {len(link)}")
    opened(driver, address + "#robot=planar2")
    check(driver.find_element(By.ID, "robots").get_attribute("value") == "planar2", "#robot=planar2 opens another one")
    # the view follows the robot
    opened(driver, address + "#robot=planar2&q=0.6,1.3&qd=-0.7,0.25&cell=2.4&exercise")
    shown = "const view = rne.view(); return [view.state.q, view.state.qd, view.cell, view.exercise]"
    right = [[0.6, 1.3], [-0.7, 0.25], [2, 4], True]
    awaited(driver, 10, lambda driver: inner(driver, shown) == right)
    inner(driver, "rne.setState({ q: [0.5, -0.25] })")
    awaited(driver, 10, lambda driver: "#robot=planar2&q=0.5,-0.25&qd=-0.7,0.25&cell=2.4&exercise" in driver.current_url)
    driver.execute_script("location.hash = '#robot=stanford'")
    awaited(driver, 30, lambda driver: "stanford" in text(driver))
    settled(driver)
    # `format: 2`, deflated by another program
    deflated = zlib.compress(b"format: 2", wbits=-15)
    opened(driver, address + "#text=" + base64.urlsafe_b64encode(deflated).decode().rstrip("="))
    check(text(driver) == "format: 2", f"a link made elsewhere is {text(driver)!r}")
    check(len(messages(driver)) > 0 and "1 mistake" in status(driver), f"a link to a mistake: {status(driver)!r}")
    for damaged in ("#text=AAAA", "#text=%%%", "#robot=nobody"):
        opened(driver, address + damaged)
        check(re.search("damaged|is shipped", status(driver)), f"{damaged}: {status(driver)!r}")
    # 64 MB in a link of 85 kB
    bomb = zlib.compress(bytes(64 << 20), 9, wbits=-15)
    opened(driver, address + "#text=" + base64.urlsafe_b64encode(bomb).decode().rstrip("="))
    check("more than 1048576 bytes" in status(driver), f"a link that inflates: {status(driver)!r}")


def apart(driver):
    """The page of the arm has an origin of its own: nothing of the playground is in its reach, or the other way."""
    frame = "document.querySelector('#shown iframe')"
    sandbox, document = driver.execute_script(f"return [{frame}.getAttribute('sandbox'), {frame}.contentDocument]")
    check((sandbox, document) == ("allow-scripts", None), f"the frame has the sandbox {sandbox!r}")
    reached = inner(driver, "try { return parent.document.title } catch (error) { return error.name }")
    check(reached == "SecurityError", f"the frame reaches the playground: {reached!r}")


def every_robot(driver):
    """All of the menu compile, and how long those with seven joints take."""
    names = driver.execute_script("return playground.robots.map(of => of.name)")
    folder = pathlib.Path(__file__).parents[2] / "robots"
    there = sorted(of.stem for of in folder.glob("*.yaml") if "." not in of.stem)
    check(names == there, f"the menu has {names}")
    of_seven = []
    for name in names:
        is_good = chosen(driver, name) == "good" and "compiled in" in status(driver)
        check(is_good, f"{name}: {status(driver)!r}, {messages(driver)}")
        if is_good and inner(driver, "return rne.torques().length") == 7:
            of_seven.append(name)
    print(f"  {len(names)} robots compile")
    for name in of_seven[:3]:
        times = []
        for turn in range(TIMES):
            typed(driver, text(driver) + "#\n") if turn else chosen(driver, name)
            times.append(driver.execute_script("return playground.milliseconds"))
        print(f"  {name}, 7 joints: compiled in {min(times):.0f} ms at best, {statistics.median(times):.0f} ms in the "
              f"median of {TIMES}")


def served(page):
    """The page at an address of http."""
    class Quiet(SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(page.parent)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}/{page.name}"


def main():
    rne, page = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    driver = browser(*SCREENS["desk"])
    try:
        opened(driver, page.as_uri())
        puma = text(driver)
        check("name: puma560" in puma, "it does not begin with the PUMA 560")
        print(f"from a file: {status(driver)}")
        torques(driver, rne, "puma560", 6, "puma560")
        apart(driver)
        accessible(driver, "playground, light")
        mistakes(driver, rne, puma)
        accessible(driver, "playground with mistakes")
        heavier = edited(driver, rne, puma)
        links(driver, page.as_uri(), heavier)
        every_robot(driver)
        narrow(driver, "playground, desk")
        quiet(driver, "playground from a file")
        opened(driver, served(page) + "#robot=panda")
        print(f"by http: {status(driver)}")
        torques(driver, rne, "panda", 7, "panda by http")
        quiet(driver, "playground by http")
    finally:
        driver.quit()
    driver = browser(*SCREENS["desk"])
    try:
        for screen, size in SCREENS.items():
            for dark in (False, True):
                seen_on(driver, *size, dark=dark)
                where = f"playground, {screen}, {'dark' if dark else 'light'}"
                opened(driver, page.as_uri())
                narrow(driver, where)
                accessible(driver, where)
                name = f"{screen}{'-dark' if dark else ''}"
                picture(driver, page.parent / f"{name}.png", 200_000)
                typed(driver, puma.replace("mass:", "masss:", 1))
                driver.find_element(By.CSS_SELECTOR, "#messages button").click()
                picture(driver, page.parent / f"{name}-mistake.png", 200_000)
                accessible(driver, f"{where}, mistake")
                quiet(driver, where)
    finally:
        driver.quit()
    print(f"{len(failures)} failures" if failures else "all of it holds")
    sys.exit(1 if failures else 0)


main()
