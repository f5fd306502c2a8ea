"""A headless Chromium that draws by the processor, and the program under test."""
import os
import pathlib
import subprocess

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FATHOM = os.environ.get("FATHOM", str(ROOT / "build/release/fathom"))

PATIENCE = 300  # seconds for an answer of the browser

# Software draws a frame of a large scene in tens of seconds, for which the watchdog ends Chromium's graphics process.
FLAGS = ["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--disable-gpu-watchdog", "--force-device-scale-factor=1", "--hide-scrollbars", "--disable-dev-shm-usage",
         "--disable-background-networking"]


def start(width=900, height=640):
    """Returns a driver, whose quit() ends its browser."""
    options = Options()
    for flag in FLAGS + [f"--window-size={width},{height}"]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.set_page_load_timeout(PATIENCE)
    driver.set_script_timeout(PATIENCE)
    return driver


def fathom(*arguments):
    """Runs the program and returns what it prints. Raises CalledProcessError if it fails."""
    command = [FATHOM, *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout
