# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""A page in a Chromium without a window, asked by the DevTools protocol through pipes. Python's standard library alone.

PGDR_CHROMIUM names the browser; else it is looked for by its usual names.
"""
import base64
import itertools
import json
import os
import select
import shutil
import signal
import subprocess
import tempfile
import time

NAMES = ("chromium", "chromium-browser", "google-chrome")


def find():
    """The browser's path, or None."""
    return os.environ.get("PGDR_CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)


class Page:
    """One page of a browser of its own. A context manager: the browser ends with it."""

    def __init__(self, path, width=480, height=360, patience=120):
        self._patience, self._ids, self._buffer, self.messages = patience, itertools.count(1), b"", []
        self._profile = tempfile.mkdtemp(prefix="pgdr_browser_")
        from_browser, to_us = os.pipe()
        from_us, to_browser = os.pipe()
        os.set_blocking(from_browser, False)
        self._read, self._write = from_browser, to_browser

        def wire():  # the browser reads descriptor 3 and writes descriptor 4
            ours, theirs = os.dup(from_us), os.dup(to_us)
            os.dup2(ours, 3)
            os.dup2(theirs, 4)

        flags = ["--headless", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run",
                 "--disable-background-networking", "--disable-dev-shm-usage", "--force-device-scale-factor=1",
                 "--remote-debugging-pipe", f"--user-data-dir={self._profile}", f"--window-size={width},{height}", "about:blank"]
        self._process = subprocess.Popen([find(), *flags], preexec_fn=wire, close_fds=False, stdin=subprocess.DEVNULL,
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                         start_new_session=True)
        os.close(to_us)
        os.close(from_us)
        try:
            self._open(path, width, height)
        except Exception:
            self.__exit__()
            raise

    def _open(self, path, width, height):
        self._session = None
        target = self._ask("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self._ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self._ask("Runtime.enable")
        self._ask("Page.enable")
        self._ask("Page.navigate", url=path.resolve().as_uri())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.killpg(self._process.pid, signal.SIGKILL)  # with its children, which write into the profile
        self._process.wait()
        os.close(self._read)
        os.close(self._write)
        shutil.rmtree(self._profile, ignore_errors=True)

    def _ask(self, method, **parameters):
        number = next(self._ids)
        message = {"id": number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + self._patience
        while True:
            answer = self._next(end)
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            if answer.get("method") in ("Runtime.exceptionThrown", "Runtime.consoleAPICalled"):
                self.messages.append(answer["params"])

    def _next(self, end):
        while b"\0" not in self._buffer:
            if not select.select([self._read], [], [], max(0, end - time.monotonic()))[0]:
                raise TimeoutError(f"the browser has not answered within {self._patience} s")
            part = os.read(self._read, 1 << 20)
            if not part:
                raise RuntimeError("the browser has ended")
            self._buffer += part
        message, self._buffer = self._buffer.split(b"\0", 1)
        return json.loads(message)

    def value(self, expression):
        """Of JavaScript, as JSON can hold it."""
        result = self._ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait_for(self, expression):
        end = time.monotonic() + self._patience
        while not self.value(expression):
            if time.monotonic() > end:
                raise TimeoutError(f"{expression} has not become true within {self._patience} s: {self.messages}")
            time.sleep(0.05)

    def screenshot(self):
        """The bytes of a .png."""
        self.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        return base64.b64decode(self._ask("Page.captureScreenshot", format="png")["data"])

    def mouse(self, kind, x, y, **more):
        """kind: "mouseMoved", "mousePressed", "mouseReleased" or "mouseWheel"."""
        self._ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)
