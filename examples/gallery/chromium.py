"""A headless Chromium, told what to do over a pipe by the DevTools protocol. Needs nothing but Python."""

import base64
import json
import os
import shutil
import subprocess
import tempfile

FLAGS = """--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking
    --disable-component-update --disable-sync --hide-scrollbars --remote-debugging-pipe""".split()


def program():
    """Where Chromium is, or nothing."""
    return next(filter(None, map(shutil.which, ["chromium", "chromium-browser", "google-chrome"])), None)


class Failed(Exception):
    """What went wrong in the page."""


class Browser:
    """One tab. What it complains of is in `complaints`."""

    def __init__(self):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        (read, told), (said, write) = os.pipe(), os.pipe()
        # The protocol is read from 3 and written to 4.
        command = 'exec "$@" 3<&"$TOLD" 4>&"$SAID"'
        flags = [*FLAGS, f"--user-data-dir={self.profile.name}"]
        self.process = subprocess.Popen(
            ["bash", "-c", command, "bash", program(), *flags],
            env={**os.environ, "TOLD": str(read), "SAID": str(write)},
            pass_fds=(read, write),
            stderr=subprocess.DEVNULL,
        )
        os.close(read)
        os.close(write)
        self.told, self.said = os.fdopen(told, "wb"), os.fdopen(said, "rb")
        self.count, self.rest, self.complaints, self.session = 0, b"", [], None
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log"]:
            self.ask(f"{domain}.enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.profile.cleanup()

    def ask(self, method, **params):
        """The answer to a command."""
        self.count += 1
        message = {"id": self.count, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        self.told.write(json.dumps(message).encode() + b"\0")
        self.told.flush()
        while True:
            answer = self.hear()
            if answer.get("id") == self.count:
                if "error" in answer:
                    raise Failed(f"{method}: {answer['error']}")
                return answer["result"]
            self.note(answer)

    def hear(self):
        """The next message."""
        while b"\0" not in self.rest:
            more = os.read(self.said.fileno(), 1 << 20)
            if not more:
                raise Failed("Chromium has gone")
            self.rest += more
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def note(self, event):
        """Keeps what is an error."""
        method, params = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.complaints.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
            self.complaints.append(" ".join(str(arg.get("value", arg.get("description"))) for arg in params["args"]))
        elif method == "Log.entryAdded" and params["entry"]["level"] in ("error", "warning"):
            self.complaints.append(params["entry"]["text"])

    def tell(self, expression):
        """The value of an expression in the page, waited for where it is a promise."""
        answer = self.ask("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise Failed(details.get("exception", {}).get("description", details["text"]))
        return answer["result"].get("value")

    def open(self, url, ready):
        """Goes there, and waits until this holds."""
        self.ask("Page.navigate", url="about:blank")
        self.ask("Page.navigate", url=url)
        wait = f"""new Promise((done, failed) => {{
            const begun = performance.now();
            const look = () => {{
                let holds = false;
                try {{ holds = {ready}; }} catch {{ }}
                if (holds) done(true);
                else if (performance.now() - begun > 60000) failed(new Error("it is not ready after a minute"));
                else setTimeout(look, 50);
            }};
            look();
        }})"""
        self.tell(wait)

    def resize(self, width, height, ratio=1, mobile=False):
        """The size of the window."""
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=ratio, mobile=mobile)

    def scheme(self, name):
        """`light` or `dark`."""
        self.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name}])

    def press(self, key, text=None):
        """A key, pressed and let go."""
        code = {" ": "Space"}.get(key, key if len(key) > 1 else f"Key{key.upper()}")
        text = key if text is None and len(key) == 1 else text
        down = {"type": "keyDown", "key": key, "code": code, **({"text": text} if text else {})}
        self.ask("Input.dispatchKeyEvent", **down)
        self.ask("Input.dispatchKeyEvent", type="keyUp", key=key, code=code)

    def picture(self, file, whole=False):
        """What is seen, or the whole page, as a PNG."""
        answer = self.ask("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        with open(file, "wb") as out:
            out.write(base64.b64decode(answer["data"]))
