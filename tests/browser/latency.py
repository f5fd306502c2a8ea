"""Measures how long the page takes from a save to its pictures."""
import pathlib
import re
import statistics
import time

import browser
from viewer import Page, Server, replace

CHANGES = 20

# Notes when the page first shows a version of the scene, in milliseconds since 1970.
WATCH = """
window.latency = {live: {}, picture: {}};
const watch = () => {
  const {live, pictureVersion} = window.fathomView;
  if (live) window.latency.live[live.version] ??= performance.timeOrigin + live.time;
  window.latency.picture[pictureVersion] ??= performance.timeOrigin + performance.now();
  requestAnimationFrame(watch);
};
watch();
"""


def compile_time(scene):
    """Returns the median seconds of `fathom check`."""
    times = []
    for _ in range(5):
        begin = time.monotonic()
        browser.fathom("check", scene)
        times.append(time.monotonic() - begin)
    return statistics.median(times)


def number_in(scene):
    """Returns the text around a number of the scene that may change a little: a radius, else a coordinate."""
    text = scene.read_text()
    for pattern in (r'("radius": *)(\d*\.?\d+)', r"(sphere\()(\d*\.?\d+)", r"(translate\(\[)(-?\d*\.?\d+)"):
        found = re.search(pattern, text)
        if found:
            return pattern, float(found[2])
    raise RuntimeError(f"{scene} has no number to change")


def delays(driver, scene):
    """Returns two lists of milliseconds from the save: to the live picture, and to the first true picture."""
    pattern, value = number_in(scene)
    server = Server(scene)
    live, true = [], []
    try:
        page = Page(driver, server)
        page.wait("a live frame", lambda: (page.facts()["live"] or 0) > 0)
        page.wait("a true picture", lambda: (page.facts()["picture"] or 0) > 0)
        page.run(WATCH)
        for i in range(CHANGES):
            time.sleep(1)
            version = page.facts()["version"] + 1
            changed = value * (1 + 0.002 * (i + 1))
            saved = time.time() * 1000
            replace(scene, pattern, rf"\g<1>{changed:.6f}")
            for kind, times in (("live", live), ("picture", true)):
                shown = f"return window.latency.{kind}[{version}]"
                page.wait(f"the {kind} of version {version}", lambda: page.run(shown))
                times.append(page.run(shown) - saved)
    finally:
        server.stop()
    return live, true


def measure(scenes, scratch):
    print(f"Median and most of {CHANGES} changes of a number, milliseconds from the save; software draws")
    print(f"{'scene':28} {'live picture':>16} {'true picture':>16} {'fathom check':>14}")
    driver = browser.start()
    for scene in scenes:
        copy = pathlib.Path(scratch) / scene.name
        copy.write_text(scene.read_text())
        columns = [f"{statistics.median(row):7.0f} {max(row):8.0f}" for row in delays(driver, copy)]
        print(f"{scene.name:28} {columns[0]:>16} {columns[1]:>16} {1000 * compile_time(copy):14.0f}", flush=True)
    driver.quit()
