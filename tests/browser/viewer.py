"""A running `fathom view` and its page in the browser."""
import pathlib
import re
import secrets
import socket
import subprocess
import time

from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By

import browser

PATIENCE = 60  # seconds for anything that the page should show


class Server:
    """`fathom view` of a scene, at an address that stays the same when it is started again."""

    def __init__(self, scene):
        self.scene = pathlib.Path(scene)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.token = secrets.token_hex(16)
        self.address = f"http://127.0.0.1:{self.port}/{self.token}/"
        self.process = None
        self.start()

    def start(self):
        self.process = subprocess.Popen([browser.FATHOM, "view", str(self.scene), "--port", str(self.port), "--token",
                                         self.token, "--no-open", "--threads", "1"], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        end = time.monotonic() + PATIENCE
        while True:
            try:
                socket.create_connection(("127.0.0.1", self.port), timeout=1).close()
                return
            except OSError:
                if self.process.poll() is not None or time.monotonic() > end:
                    raise RuntimeError(f"fathom view {self.scene} does not start") from None
                time.sleep(0.05)

    def stop(self):
        self.process.terminate()
        self.process.wait()


class Page:
    """What a user does in the page, and what they see there."""

    def __init__(self, driver, server):
        self.driver = driver
        driver.get(server.address)

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def element(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def text(self, selector):
        return self.run("return document.querySelector(arguments[0])?.textContent ?? ''", selector)

    def is_shown(self, selector):
        return self.run("return document.querySelector(arguments[0])?.checkVisibility() ?? false", selector)

    def facts(self):
        """Returns the versions of the scene that the page knows and that the live picture shows, the true picture's
        number, the camera's position and the state of the connection."""
        return self.run("const {version, live, picture, camera, connection} = window.fathomView ?? {};"
                        "return {version, live: live?.version, picture, position: camera?.position, connection}")

    def live(self):
        """Returns the live picture as text that is equal for equal pictures."""
        return self.run("return document.getElementById('live').toDataURL()")

    def wait(self, what, condition):
        """Waits until `condition` holds, and returns its value."""
        end = time.monotonic() + PATIENCE
        while True:
            try:
                value = condition()
            except WebDriverException:
                value = None
            if value:
                return value
            if time.monotonic() > end:
                raise AssertionError(f"not within {PATIENCE} s: {what}")
            time.sleep(0.05)

    def still(self):
        """Waits until the live picture no longer changes, and returns it."""
        before = None
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            now = self.live()
            if now == before:
                return now
            before = now
            time.sleep(0.7)
        raise AssertionError("the live picture never comes to rest")

    def tab(self, name):
        self.element(f"#tab-{name}").click()

    def choose(self, selector, value):
        self.run("const at = document.querySelector(arguments[0]); at.value = arguments[1];"
                 "at.dispatchEvent(new Event('input', {bubbles: true}));"
                 "at.dispatchEvent(new Event('change', {bubbles: true}))", selector, str(value))

    def drag(self, selector, right, down, steps=5):
        actions = ActionChains(self.driver, duration=30).move_to_element(self.element(selector)).click_and_hold()
        for _ in range(steps):
            actions = actions.move_by_offset(right // steps, down // steps)
        actions.release().perform()

    def click_at(self, selector, right=0, down=0):
        """Clicks beside the middle of an element, pixels."""
        at = self.element(selector)
        ActionChains(self.driver, duration=30).move_to_element_with_offset(at, right, down).click().perform()

    def hover(self, selector):
        """Moves the pointer to an element, and again if the element has moved away meanwhile."""
        def is_there():
            ActionChains(self.driver, duration=30).move_to_element(self.element(selector)).perform()
            return self.run("return arguments[0].matches(':hover')", self.element(selector))
        self.wait(f"the pointer over {selector}", is_there)


def replace(path, pattern, replacement):
    """Changes a scene's file at once, as editors do."""
    text, count = re.subn(pattern, replacement, path.read_text(), count=1)
    assert count == 1, f"no {pattern} in {path}"
    beside = path.with_name(path.name + ".new")
    beside.write_text(text)
    beside.rename(path)
