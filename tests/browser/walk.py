"""A walk through the page of `fathom view`: everything that it offers, with what it must show."""
import pathlib
import time
import traceback

import browser
from viewer import Page, Server, replace

SCENE = """fathom 1
camera (position = [0, 1.4, 4], target = [0, 0.4, 0], fov = 45)
film (width = 320, height = 180)
render (spp = 64)
background [0.9, 0.95, 1]
light "sun" directional(direction = [-0.4, -1, -0.6], irradiance = [2, 2, 2])
param size(min = 0.2, max = 1.2) = 0.5
let red = diffuse(color = [0.8, 0.2, 0.1])
object "ball" sphere(size).translate([0, 0.5, 0]).material(red)
object "ground" plane([0, 1, 0])
"""

# Names and messages that would be markup if the page took them for it.
HOSTILE = """fathom 1
camera (position = [0, 1, 5], target = [0, 0, 0])
render (spp = 4)
background [1, 1, 1]
param k(min = 0, max = 1) = 0.5
object "<img src=x onerror='window.hacked=1'>" sphere(1)
object "</script><script>window.hacked=2</script>" sphere(k).translate([1, 0, 0])
object "<b id=injected>bold</b>" box([0.5, 0.5, 0.5]).translate([-1, 0, 0])
"""
HOSTILE_MISTAKE = "\nobject \"x\" <img src=x onerror=window.hacked=3>\n"

# Elements that only an injection makes: those of the scene's names.
COUNT_FOREIGN = "return document.querySelectorAll('#injected, img:not(#true), script:not([src]), b b').length"

COUNT_INSTRUCTIONS = "return document.querySelectorAll('#program [role=option]').length"


def opens(page, server):
    page.wait("a live frame", lambda: (page.facts()["live"] or 0) > 0)
    page.wait("a true picture", lambda: (page.facts()["picture"] or 0) > 0)
    assert page.is_shown("#live") and not page.is_shown("#problem")
    assert page.text("#name").endswith(server.scene.name)
    assert page.run("return document.querySelectorAll('#source [role=option]').length") == SCENE.count("\n")


def refines(page, _server):
    first = page.facts()["picture"]
    page.wait("a further true picture, or the last one",
              lambda: page.facts()["picture"] > first or "done" in page.text("#progress-text"))
    page.wait("samples in the progress", lambda: "samples" in page.text("#progress-text"))


def orbits(page, _server):
    live, facts = page.still(), page.facts()
    page.drag("#live", 120, 20)
    page.wait("another camera", lambda: page.facts()["position"] != facts["position"])
    assert page.still() != live, "the live picture stays"
    page.wait("a true picture of the new camera", lambda: page.facts()["picture"] > facts["picture"])
    restarted = page.facts()["picture"]
    page.wait("its refinement", lambda: page.facts()["picture"] > restarted or "done" in page.text("#progress-text"))


def shows_mistakes(page, server):
    live, facts = page.still(), page.facts()
    replace(server.scene, r"sphere\(size\)", "sphere(sized)")
    page.wait("the message", lambda: "error" in page.text("#messages"))
    message = page.text("#messages")
    assert "^" in message and "sized" in message, f"no caret in: {message}"
    assert page.is_shown("#messages")
    assert page.run("return document.querySelectorAll('#source .faulty').length") == 1
    assert page.still() == live, "the last good picture is gone"
    assert page.facts()["live"] == facts["live"]
    replace(server.scene, r"sphere\(sized\)", "sphere(1.3*size)")
    page.wait("a live frame of the mended scene", lambda: page.facts()["live"] > facts["live"])
    page.wait("no message", lambda: not page.is_shown("#messages") and page.text("#messages") == "")
    assert page.still() != live, "the mended scene looks like the old one"


def changes_parameters(page, server):
    page.tab("parameters")
    live, facts, text = page.still(), page.facts(), server.scene.read_text()
    page.drag("#parameters input[type=range]", 50, 0)
    page.wait("a live frame of the new value", lambda: page.facts()["live"] > facts["live"])
    assert page.still() != live, "the picture stays"
    assert server.scene.read_text() == text, "the file has changed without being asked"
    value = float(page.run("return document.querySelector('#parameters input[type=number]').value"))
    version = page.facts()["version"]
    page.element("#keep").click()
    page.wait("the value in the file", lambda: server.scene.read_text() != text)
    written = server.scene.read_text()
    assert f"= {value:g}\n" in written, f"{value:g} is not in: {written}"
    assert page.wait("the note", lambda: page.text("#parameters-note").startswith("written"))
    # A new version clears masks of instructions.
    page.wait("the file's new version", lambda: page.facts()["version"] > version)


def asks_pixels(page, _server):
    page.click_at("#live", 0, 0)
    page.wait("the object's name", lambda: "ball" in page.text("#pixel h2"))
    assert "red" in page.text("#pixel table")
    points = page.run("return document.querySelectorAll('#pixel svg circle').length || "
                      "(document.querySelector('#pixel svg polyline')?.points.numberOfItems ?? 0)")
    assert points > 2, f"{points} points in the plot"
    page.element("#pixel button[data-kind=run]").click()
    page.wait("the run's listing", lambda: "sphere" in page.text("#pixel pre"))


def shows_instructions(page, _server):
    page.tab("program")
    page.wait("instructions", lambda: page.run(COUNT_INSTRUCTIONS) > 1)
    page.hover("#program [role=option]:nth-child(1)")
    page.wait("the mask", lambda: page.is_shown("#mask"))
    covered = page.run("const mask = document.getElementById('mask'), {width, height} = mask; return mask.getContext("
                       "'2d').getImageData(0, 0, width, height).data.some((value, i) => i % 4 === 3 && value > 0)")
    assert covered, "the mask is empty"
    page.choose("#program-kind", "passes")
    page.wait("what each pass changed", lambda: len(page.text("#passes")) > 40)
    page.choose("#program-kind", "check")
    page.wait("the check", lambda: "ball" in page.text("#passes"))
    page.choose("#program-kind", "")


def slices(page, _server):
    page.tab("slice")
    without = page.still()
    page.choose("#slice-axis", "2")
    first = page.still()
    assert first != without, "no slice"
    page.drag("#slice-at", 60, 0)
    assert page.still() != first, "the slice stays where it was"
    page.choose("#slice-axis", "-1")
    page.wait("no slice", lambda: page.still() == without)


def overlays(page, _server):
    seen = []
    for value in page.run("return [...document.getElementById('overlay').options].map(option => option.value)"):
        page.choose("#overlay", value)
        seen.append(page.still())
    assert len(set(seen)) >= 6, f"{len(set(seen))} different overlays"
    page.choose("#overlay", "light")
    page.still()


def reconnects(page, server):
    server.stop()
    page.wait("word that the connection is lost", lambda: page.facts()["connection"] != "connected")
    page.wait("how to go on", lambda: "fathom view" in page.text("#connection"))
    server.start()
    page.wait("the connection", lambda: page.facts()["connection"] == "connected")
    facts = page.facts()
    replace(server.scene, r"0\.8, 0\.2, 0\.1", "0.1, 0.2, 0.8")
    page.wait("a change after that", lambda: page.facts()["version"] != facts["version"])
    page.wait("its true picture", lambda: page.facts()["picture"] != facts["picture"])


WALK = [opens, refines, orbits, shows_mistakes, changes_parameters, asks_pixels, shows_instructions, slices, overlays,
        reconnects]


def resists(page, server):
    page.wait("a live frame", lambda: (page.facts()["live"] or 0) > 0)
    for name in ("source", "parameters", "pixel", "program", "slice"):
        page.tab(name)
    page.click_at("#live", 0, 0)
    page.wait("the hostile name as text", lambda: "<img src=x onerror" in page.text("#pixel h2"))
    page.tab("program")
    page.wait("instructions", lambda: page.run(COUNT_INSTRUCTIONS) > 1)
    for kind in ("passes", "graph", "check"):
        page.choose("#program-kind", kind)
        page.wait(kind, lambda: len(page.text("#passes")) > 40)
    server.scene.write_text(HOSTILE + HOSTILE_MISTAKE)
    page.wait("the message", lambda: "onerror" in page.text("#messages"))
    assert page.run(COUNT_FOREIGN) == 0, "an element of the scene's text is in the page"
    assert page.run("return window.hacked === undefined"), "a script of the scene has run"


def complaints(driver):
    """Returns what the page wrote to the console, except that it could not connect."""
    return [row["message"] for row in driver.get_log("browser")
            if row["level"] == "SEVERE" and "ERR_CONNECTION" not in row["message"] and "ERR_INCOMPLETE" not in
            row["message"] and "ERR_EMPTY" not in row["message"]]


def test(scratch, screenshots=None):
    """Prints a line for each step, and returns the number of failures."""
    failures = 0
    for file, text, steps in (("walk.fathom", SCENE, WALK), ("hostile.fathom", HOSTILE, [resists])):
        scene = pathlib.Path(scratch) / file
        scene.write_text(text)
        server, driver = Server(scene), browser.start(1000, 520)
        try:
            page = Page(driver, server)
            for step in steps:
                failures += not passes(step, page, server, screenshots)
            for message in complaints(driver):
                print(f"  FAILED: the page complains: {message}", flush=True)
                failures += 1
        finally:
            driver.quit()
            server.stop()
    return failures


def passes(step, page, server, screenshots):
    begin = time.monotonic()
    try:
        step(page, server)
        problem = ""
    except Exception as error:  # a failed step must not hide the others
        problem = f"  FAILED: {str(error).splitlines()[0] if str(error) else type(error).__name__}"
        if not isinstance(error, AssertionError):
            traceback.print_exc()
    print(f"{step.__name__.replace('_', ' '):24} {time.monotonic() - begin:6.1f} s{problem}", flush=True)
    if screenshots:
        page.driver.save_screenshot(str(screenshots / f"view-{step.__name__}.png"))
    return not problem
