"""A browser without a screen, driven through chromedriver by the WebDriver protocol; only the standard library is needed."""

import base64
import json
import os
import re
import subprocess
import tempfile
import urllib.error
import urllib.request

# Nothing but the pages asked for is to be loaded, or the check for requests would see it.
ARGUMENTS = [
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--window-size=1200,900",
]
SECONDS = 60
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"


class Browser:
    """One browser with a profile of its own, until `close`."""

    def __init__(self):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.driver = subprocess.Popen(
            [os.environ["CHROMEDRIVER"], "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self.opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            self.address = f"http://127.0.0.1:{self._port()}"
            options = {
                "binary": os.environ["CHROMIUM"],
                "args": [*ARGUMENTS, f"--user-data-dir={self.profile.name}"],
            }
            wanted = {"goog:chromeOptions": options, "goog:loggingPrefs": {"performance": "ALL", "browser": "ALL"}}
            session = self._send("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
            self.address += f"/session/{session['sessionId']}"
        except BaseException:
            self._end()
            raise

    def _port(self):
        said = []
        for line in self.driver.stdout:
            said.append(line)
            found = re.search(r"started successfully on port (\d+)", line)
            if found:
                return int(found[1])
        raise RuntimeError(f"chromedriver does not start: {''.join(said)}")

    def _send(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        headers = {"Content-Type": "application/json"}
        request = urllib.request.Request(self.address + path, data, headers, method=method)
        try:
            with self.opener.open(request, timeout=SECONDS) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(f"{method} {path}: {error.read().decode()}") from error

    def _end(self):
        self.driver.terminate()
        self.driver.wait(SECONDS)
        self.driver.stdout.close()
        self.profile.cleanup()

    def close(self):
        try:
            self._send("DELETE", "")
        finally:
            self._end()

    def open(self, path):
        self._send("POST", "/url", {"url": path.as_uri()})

    def script(self, text, *arguments):
        """What a function body returns in the page."""
        return self._send("POST", "/execute/sync", {"script": text, "args": list(arguments)})

    def devtools(self, command, **parameters):
        return self._send("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def log(self, kind):
        """Entries since the last call."""
        return self._send("POST", "/se/log", {"type": kind})

    def requests(self):
        """Addresses asked for since the last call."""
        messages = [json.loads(entry["message"])["message"] for entry in self.log("performance")]
        sent = (m["params"] for m in messages if m["method"] == "Network.requestWillBeSent")
        return [parameters["request"]["url"] for parameters in sent]

    def find_all(self, selector):
        found = self._send("POST", "/elements", {"using": "css selector", "value": selector})
        return [element[ELEMENT] for element in found]

    def label(self, element):
        """The name that a screen reader says."""
        return self._send("GET", f"/element/{element}/computedlabel")

    def role(self, element):
        return self._send("GET", f"/element/{element}/computedrole")

    def press(self, *keys):
        """Keys one after the other, where the focus is."""
        strokes = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        self._send("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": strokes}]})

    def drag(self, start, end):
        """The mouse pressed at a point of the window, moved to another in steps, and let go."""
        move = lambda x, y: {"type": "pointerMove", "duration": 20, "x": round(x), "y": round(y)}
        between = [tuple(a + (b - a) * k / 4 for a, b in zip(start, end)) for k in range(1, 5)]
        actions = [move(*start), {"type": "pointerDown", "button": 0}, *(move(*p) for p in between)]
        actions.append({"type": "pointerUp", "button": 0})
        mouse = {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": actions}
        self._send("POST", "/actions", {"actions": [mouse]})

    def media(self, medium="", scheme="light"):
        """Draws as for a medium (`print`), or for the screen, in a colour scheme."""
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self.devtools("Emulation.setEmulatedMedia", media=medium, features=features)

    def width(self, pixels):
        """The width of the window; 0 for its own."""
        if pixels == 0:
            self.devtools("Emulation.clearDeviceMetricsOverride")
        else:
            size = {"width": pixels, "height": 900}
            self.devtools("Emulation.setDeviceMetricsOverride", **size, deviceScaleFactor=0, mobile=False)

    def scripts(self, allowed):
        self.devtools("Emulation.setScriptExecutionDisabled", value=not allowed)

    def picture(self, path):
        """The whole page as a PNG."""
        shot = self.devtools("Page.captureScreenshot", format="png", captureBeyondViewport=True)
        path.write_bytes(base64.b64decode(shot["data"]))

    def pdf(self):
        return base64.b64decode(self.devtools("Page.printToPDF", printBackground=True)["data"])
