# SPDX-License-Identifier: GPL-3.0-or-later
# page_firefox.py PAGE.html FOLDER -- the page in Firefox (on DISPLAY: headless has no WebGL without a card), driven by its Marionette protocol (a socket; messages
# are LENGTH:JSON), with nothing but the standard library: it opens without an error, plays, turns, colours; pictures
# differ where they must.
import base64, json, os, pathlib, shutil, socket, subprocess, sys, tempfile, time

# Errors of the page, kept by the copy of it that is opened.
WATCH = "<script>window.ERRORS = []; addEventListener('error', e => ERRORS.push(String(e.message))); addEventListener('unhandledrejection', " \
        "e => ERRORS.push(String(e.reason))); for (const k of ['error', 'warn']) { const was = console[k]; console[k] = (...a) => " \
        "{ ERRORS.push(a.join(' ')); was.apply(console, a); }; }</script>"

class Firefox:
    def __init__(self, program):
        self.profile = tempfile.mkdtemp(prefix="floe-firefox.")
        with socket.socket() as s:
            s.bind(("127.0.0.1", 0))
            self.port = s.getsockname()[1]
        pathlib.Path(self.profile, "user.js").write_text(
            'user_pref("marionette.port", %d);\nuser_pref("webgl.force-enabled", true);\nuser_pref("browser.shell.checkDefaultBrowser", false);\n'
            'user_pref("datareporting.policy.dataSubmissionEnabled", false);\n' % self.port)
        self.p = subprocess.Popen([program, *([] if os.environ.get("DISPLAY") else ["--headless"]), "--marionette", "--no-remote", "--profile", self.profile, "--width", "1000", "--height", "700",
                                   "about:blank"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(600):
            try:
                self.s = socket.create_connection(("127.0.0.1", self.port), timeout=120)
                break
            except OSError:
                time.sleep(0.1)
        self.buf, self.n = b"", 0
        self.receive()
        self.call("WebDriver:NewSession")
    def receive(self):
        while b":" not in self.buf or len(self.buf) < int(self.buf.split(b":", 1)[0]) + self.buf.index(b":") + 1:
            got = self.s.recv(1 << 20)
            if not got: raise EOFError("the browser has gone")
            self.buf += got
        at = self.buf.index(b":") + 1
        end = at + int(self.buf[:at - 1])
        text, self.buf = self.buf[at:end], self.buf[end:]
        return json.loads(text)
    def call(self, name, **params):
        self.n += 1
        text = json.dumps([0, self.n, name, params]).encode()
        self.s.sendall(b"%d:" % len(text) + text)
        while True:
            m = self.receive()
            if m[1] == self.n:
                if m[2]: raise RuntimeError(m[2])
                return m[3]
    def js(self, text):
        return self.call("WebDriver:ExecuteScript", script=text, args=[], sandbox=None).get("value")
    def picture(self, path):
        data = base64.b64decode(self.call("WebDriver:TakeScreenshot", full=False)["value"])
        pathlib.Path(path).write_bytes(data)
        return data
    def drag(self, x, y, to_x, to_y):
        steps = [{"type": "pointerMove", "duration": 0, "x": x, "y": y}, {"type": "pointerDown", "button": 0}]
        for i in range(1, 11):
            steps.append({"type": "pointerMove", "duration": 50, "x": x + (to_x - x) * i // 10, "y": y + (to_y - y) * i // 10})
        steps.append({"type": "pointerUp", "button": 0})
        self.call("WebDriver:PerformActions", actions=[{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": steps}])
    def close(self):
        try: self.call("Marionette:Quit", flags=["eForceQuit"])
        except (EOFError, OSError): pass
        try: self.p.wait(30)
        except subprocess.TimeoutExpired: self.p.kill()
        shutil.rmtree(self.profile, ignore_errors=True)

page, out, bad = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], []
watched = page.with_name("watched.html")
text = page.read_text()
watched.write_text(text.replace("<head>", "<head>" + WATCH, 1) if "<head>" in text else WATCH + text)
b = Firefox(shutil.which("firefox-esr") or shutil.which("firefox"))
try:
    b.call("WebDriver:Navigate", url=watched.as_uri())
    for _ in range(600):
        if (b.js("return document.title") or "").startswith("ice-view "): break
        time.sleep(0.1)
    title = b.js("return document.title")
    if title != "ice-view ready": bad.append("the page says " + str(title))
    p = [b.picture(out + "/firefox-start.png")]
    b.js("document.getElementById('play').click()")
    time.sleep(3)
    b.js("document.getElementById('play').click()")
    p.append(b.picture(out + "/firefox-played.png"))
    b.drag(400, 300, 520, 330)
    time.sleep(1)
    p.append(b.picture(out + "/firefox-turned.png"))
    b.js("const e = document.getElementById('paint'); e.value = '3'; e.dispatchEvent(new Event('change'));")
    time.sleep(1)
    p.append(b.picture(out + "/firefox-ice.png"))
    for i, what in enumerate(("playing", "turning", "another colour")):
        if p[i] == p[i + 1]: bad.append(what + " changes nothing")
    bad += ["console: " + c for c in b.js("return window.ERRORS") or []]
finally:
    b.close()
for line in bad: print("page in Firefox: " + line)
print("%d passed, %d failed" % (4 - min(len(bad), 4), len(bad)))
sys.exit(1 if bad else 0)
