"""The static site in headless Chromium: do its pages open, and does a link open the exact view?

Usage: python site.py FOLDER     FOLDER is the site; `cargo xtask site --test` calls it.
"""

import pathlib
import sys
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

from page import SCREENS, awaited, browser, check, failures, narrow, quiet, seen_on


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    root = f"http://127.0.0.1:{server.server_port}/"
    driver = browser(*SCREENS["desk"])
    try:
        pages = sorted(path for path in folder.rglob("*.html") if path.relative_to(folder).parts[0] in ("docs", "index.html"))
        check(len(pages) > 30, f"the site has {len(pages)} documents")
        for screen, size in SCREENS.items():
            seen_on(driver, *size)
            for page in pages:
                name = page.relative_to(folder).as_posix()
                driver.get(root + name)
                words = len(driver.find_element("css selector", "main").text.split())
                check(driver.title and words > 20, f"{name} has the title {driver.title!r} and {words} words")
                narrow(driver, f"{name}, {screen}")
                quiet(driver, f"{name}, {screen}")
        seen_on(driver, *SCREENS["desk"])
        driver.get(root + "reports/planar2.html#q=0.6,1.3&cell=2.4")
        awaited(driver, 20, lambda driver: driver.execute_script("return document.documentElement.dataset.ready") == "1")
        view = driver.execute_script("return [rne.view().state.q, rne.view().cell]")
        check(view == [[0.6, 1.3], [2, 4]], f"a link to a report opens {view}")
        driver.get(root + "playground/index.html#robot=planar2&q=0.6,1.3&cell=2.4")
        awaited(driver, 60, lambda driver: driver.execute_script("return document.documentElement.dataset.is") == "good")
        awaited(driver, 20, lambda driver: "q=0.6,1.3&cell=2.4" in driver.current_url)
        driver.get(root + "api/rne/index.html")
        check("rne" in driver.title, f"the reference has the title {driver.title!r}")
        print(f"  {len(pages)} documents, a report, the playground and the reference open")
    finally:
        driver.quit()
        server.shutdown()
    print(f"{len(failures)} failures" if failures else "all of it holds")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
