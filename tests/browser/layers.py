"""Compares the live picture's base colours and normals with the layers that `fathom render` writes.

A pixel agrees if some native sample at most one pixel away agrees. The native layers have three times the size and
one sample per pixel, so that no sample is a mean over an edge. Only pixels count at which the live or the native
picture shows a surface.
"""
import base64
import io
import json
import re
import time

import numpy
from PIL import Image
from selenium.common.exceptions import WebDriverException

import browser

WIDTH = 320             # pixels, of the live picture
FINER = 3               # native samples per pixel along an axis
MAX_ANGLE = 10          # degrees between normals that agree
MAX_COLOR = 6           # of 255: mean difference of the channels of colours that agree
LEAST_SHARE = 0.99      # of the pixels that must agree
PATIENCE = 240          # seconds for the shader and two frames

# Follows the page's own script in its element, so that no frame comes between. Keeps the first frames of full size of
# base colours and of normals: their rays go through the middles of the pixels.
PROBE = """
window.probe = {started: performance.now(), pictures: []};
{
  const probe = window.probe, canvas = view.canvas, gl = canvas.getContext("webgl2");
  canvas.style.cssText = "position: fixed; left: 0; top: 0; width: WIDTHpx; height: HEIGHTpx";
  new MutationObserver(() => {
    probe.status = document.getElementById("status").textContent;
    probe.compiled ??= performance.now();
  }).observe(document.getElementById("status"), {childList: true, characterData: true, subtree: true});
  view.overlay = 1;
  // The view draws each sample beside the canvas and then copies it there.
  gl.blitFramebuffer = (...range) => {
    WebGL2RenderingContext.prototype.blitFramebuffer.apply(gl, range);
    if (canvas.width !== WIDTH || probe.pictures.length === 2) return;
    probe.pictures.push(canvas.toDataURL());
    probe.drawn ??= performance.now();
    if (probe.pictures.length === 2) window.requestAnimationFrame = () => 0;
    else view.overlay = 2;
  };
}
"""


def scene_of(page):
    return json.loads(re.search(r'<script type="application/json" id="scene">(.*?)</script>', page, re.S)[1])


def live_pictures(driver, page, size, scratch):
    """Returns the live pictures of colours and normals, and the seconds until the driver called the shader ready and
    until the first frame: a driver may compile the shader only when it first draws."""
    probe = PROBE.replace("WIDTH", str(size[0])).replace("HEIGHT", str(size[1]))
    path = scratch / "page.html"
    head, tail = page[:page.rindex("</script>")], page[page.rindex("</script>"):]
    path.write_text(head + probe + tail)
    driver.get(path.as_uri())
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        found = driver.execute_script("return window.probe")
        if len(found["pictures"]) == 2:
            pictures = [Image.open(io.BytesIO(base64.b64decode(url.split(",")[1]))) for url in found["pictures"]]
            pictures = [numpy.asarray(picture.convert("RGB"), dtype=float) for picture in pictures]
            driver.get("about:blank")
            return *pictures, *((found[event] - found["started"]) / 1000 for event in ("compiled", "drawn"))
        status = found.get("status") or ""
        if "refuses" in status or "given up" in status:
            raise RuntimeError(status[:300])
        time.sleep(0.2)
    raise RuntimeError(f"no picture after {PATIENCE} s")


def native_layers(scene, size, scratch):
    out = scratch / "native.png"
    browser.fathom("render", scene, "-o", out, "--size", f"{FINER * size[0]}x{FINER * size[1]}", "-s", 1, "-b", 1,
                   "--uniform", "--no-denoise", "-a", "-n", "-q")
    return [numpy.asarray(Image.open(scratch / f"native-{layer}.png").convert("RGB"), dtype=float)
            for layer in ("albedo", "normal")]


def normals_of(picture):
    """Returns unit vectors, 0 where the picture is black."""
    normals = picture / 127.5 - 1
    normals[picture.sum(axis=2) == 0] = 0
    length = numpy.linalg.norm(normals, axis=2, keepdims=True)
    return normals / numpy.where(length > 0, length, 1)


def normals_agree(a, b):
    a_misses, b_misses = (~picture.any(axis=2) for picture in (a, b))
    return numpy.where(a_misses | b_misses, a_misses & b_misses,
                       (a * b).sum(axis=2) >= numpy.cos(numpy.radians(MAX_ANGLE)))


def colors_agree(a, b):
    return numpy.abs(a - b).mean(axis=2) <= MAX_COLOR


def agreement(live, native, agree):
    """Returns for each pixel of `live` whether some sample of `native` at most a pixel away agrees."""
    height, width = live.shape[:2]
    padded = numpy.pad(native, ((FINER, FINER), (FINER, FINER), (0, 0)), mode="edge")
    result = numpy.zeros((height, width), dtype=bool)
    for y in range(3 * FINER):
        for x in range(3 * FINER):
            sample = padded[y:y + FINER * height:FINER, x:x + FINER * width:FINER]
            result |= agree(live, sample)
    return result


def compare(driver, scene, scratch, screenshots=None):
    """Returns the shares of pixels whose normals and colours agree, and the seconds of live_pictures()."""
    page_file = scratch / "emitted.html"
    browser.fathom("emit", "html", scene, "-o", page_file)
    page = page_file.read_text()
    half = scene_of(page)["camera"]["half"]
    size = WIDTH, max(1, round(WIDTH * half[1] / half[0]))
    *live, compiled, drawn = live_pictures(driver, page, size, scratch)
    native = native_layers(scene, size, scratch)
    pairs = [(live[0], native[0], colors_agree), (normals_of(live[1]), normals_of(native[1]), normals_agree)]
    middle = native[1][FINER // 2::FINER, FINER // 2::FINER]
    counts = live[1].any(axis=2) | middle.any(axis=2)
    masks = [agreement(*pair) | ~counts for pair in pairs]
    if screenshots:
        keep(screenshots, scene, live, native, masks)
    color, normal = (float(mask[counts].mean()) if counts.any() else 1.0 for mask in masks)
    return normal, color, compiled, drawn


def keep(folder, scene, live, native, masks):
    """Writes a sheet: live, native and where they differ; colours above, normals below."""
    rows = []
    for picture, layer, mask in zip(live, native, masks):
        coarse = layer[FINER // 2::FINER, FINER // 2::FINER]
        rows.append(numpy.hstack([picture, coarse, numpy.repeat(numpy.where(mask, 40, 255)[..., None], 3, axis=2)]))
    name = "-".join(scene.with_suffix("").parts[-2:])
    Image.fromarray(numpy.vstack(rows).astype(numpy.uint8)).save(folder / f"layers-{name}.png")


def test(scenes, exceptions, scratch, screenshots=None):
    """Prints the table, and returns the number of scenes that fail."""
    print(f"Share of the pixels that agree with `fathom render`: normals within {MAX_ANGLE} degrees, base colours "
          f"within {MAX_COLOR}/255, {LEAST_SHARE:.0%} wanted")
    print(f"{'scene':32} {'normals':>8} {'colours':>8} {'shader':>8} {'frame':>8}")
    failures, driver = 0, None
    for scene in scenes:
        name = str(scene.relative_to(browser.ROOT)) if scene.is_relative_to(browser.ROOT) else str(scene)
        excused = exceptions.get(name, {})
        if "all" in excused:
            print(f"{name:32} not drawn: {excused['all']}", flush=True)
            continue
        try:
            driver = driver or browser.start()
            normal, color, compiled, drawn = compare(driver, scene, scratch, screenshots)
        except (RuntimeError, WebDriverException) as problem:
            print(f"{name:32} FAILED: {str(problem).splitlines()[0]}", flush=True)
            failures += 1
            if driver:
                driver.quit()
            driver = None
            continue
        failed, remarks = [], []
        for row, share in (("normals", normal), ("colours", color)):
            reason, least = excused.get(row, ("", LEAST_SHARE))
            if share < least:
                failed.append(row)
            elif share < LEAST_SHARE:
                remarks.append(f"{row}: {reason}")
        failures += bool(failed)
        remarks += [f"FAILED: {', '.join(failed)}"] if failed else []
        print(f"{name:32} {normal:8.2%} {color:8.2%} {compiled:6.1f} s {drawn:6.1f} s  {'; '.join(remarks)}".rstrip(),
              flush=True)
    if driver:
        driver.quit()
    return failures
