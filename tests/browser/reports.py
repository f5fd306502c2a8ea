"""Opens the reports of docs/reports as files, without a server or a network, and looks at what they show."""
import time

import browser

SECTIONS = ["picture", "live", "source", "check", "layers", "cost", "profile", "operations", "program"]
PATIENCE = 120  # seconds for the live view
# Counts the colours of some of the canvas's pixels, right after a frame.
COLOURS = """
const done = arguments[arguments.length - 1], canvas = document.querySelector("canvas");
requestAnimationFrame(() => {
  const copy = Object.assign(document.createElement("canvas"), {width: 40, height: 20}), context = copy.getContext("2d");
  context.drawImage(canvas, 0, 0, 40, 20);
  done(new Set(new Uint32Array(context.getImageData(0, 0, 40, 20).data.buffer)).size);
});
"""


def check_page(driver, path):
    driver.get(path.as_uri())
    sections = driver.execute_script("return [...document.querySelectorAll('section')].map(each => each.id)")
    assert sections == SECTIONS, f"has the sections {sections}"
    broken = driver.execute_script("return [...document.images].filter(each => !each.naturalWidth).length")
    assert broken == 0, f"{broken} pictures do not show"
    assert driver.execute_script("return document.images.length") == 6
    outside = driver.execute_script("return performance.getEntriesByType('resource').map(each => each.name)"
                                    ".filter(name => !name.startsWith('data:'))")
    assert not outside, f"asks for {outside}"
    frame = driver.find_element("css selector", "iframe")
    driver.execute_script("arguments[0].scrollIntoView()", frame)
    driver.switch_to.frame(frame)
    end = time.monotonic() + PATIENCE
    while driver.execute_async_script(COLOURS) < 20:
        assert time.monotonic() < end, "its live view stays empty"
        time.sleep(0.5)
    driver.switch_to.default_content()


def test(paths):
    """Returns the number of reports that fail."""
    failures = 0
    driver = browser.start(1000, 800)
    for path in paths:
        try:
            check_page(driver, path)
            print(f"{path.name:33} shows all", flush=True)
        except AssertionError as problem:
            failures += 1
            print(f"{path.name:33} FAILED: {problem}", flush=True)
    driver.quit()
    return failures
