"""Takes a picture of a page with chromedriver and headless Chromium: photograph.py ADDRESS FILE SECONDS."""

import base64
import json
import re
import subprocess
import sys
import tempfile
import time
import urllib.request

WIDTH, HEIGHT = 1440, 1080


def main():
    address, file, seconds = sys.argv[1], sys.argv[2], float(sys.argv[3])
    driver = subprocess.Popen(
        ["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    try:
        port = next(found[1] for line in driver.stdout if (found := re.search(r"on port (\d+)\.", line)))
        with tempfile.TemporaryDirectory() as profile:
            photograph(f"http://127.0.0.1:{port}/session", profile, address, file, seconds)
    finally:
        driver.terminate()
        driver.wait()


def photograph(sessions, profile, address, file, seconds):
    options = [
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--enable-unsafe-swiftshader",
        f"--user-data-dir={profile}",
        f"--window-size={WIDTH},{HEIGHT}",
    ]
    session = post(sessions, {"capabilities": {"alwaysMatch": {"goog:chromeOptions": {"args": options}}}})
    session = f"{sessions}/{session['sessionId']}"
    try:
        post(f"{session}/url", {"url": address})
        # During this time, the plots of the page fill with data.
        time.sleep(seconds)
        with urllib.request.urlopen(f"{session}/screenshot") as answer:
            picture = base64.b64decode(json.load(answer)["value"])
        with open(file, "wb") as output:
            output.write(picture)
    finally:
        urllib.request.urlopen(urllib.request.Request(session, method="DELETE")).close()


def post(address, value):
    request = urllib.request.Request(address, json.dumps(value).encode(), {"Content-Type": "application/json"})
    with urllib.request.urlopen(request) as answer:
        return json.load(answer)["value"]


main()
