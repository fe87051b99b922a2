# SPDX-License-Identifier: GPL-3.0-or-later
# page_drive.py PAGE.html FOLDER -- drives headless Chromium through --remote-debugging-pipe (messages end in a zero byte;
# the browser reads 3, writes 4), with nothing but the standard library: loads, plays, drags, recolours, takes pictures;
# fails on any line on the console, an exception, or pictures that do not differ where they must.
import base64, json, os, subprocess, sys, time, pathlib

class Browser:
    def __init__(self, *extra):
        a, b = os.pipe()
        c, d = os.pipe()
        def child():
            a2, d2 = os.dup(a), os.dup(d)  # 3 and 4 may be among them
            os.dup2(a2, 3), os.dup2(d2, 4)
        self.p = subprocess.Popen(["chromium", "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars", "--no-first-run",
                                   "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=1000,700", "--remote-debugging-pipe", *extra, "about:blank"],
                                  preexec_fn=child, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(a), os.close(d)
        self.out, self.inp, self.n, self.buf, self.events = b, c, 0, b"", []
        t = self.call("Target.getTargets")["targetInfos"]
        self.s = None
        target = [i for i in t if i["type"] == "page"][0]["targetId"]
        self.s = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for m in ("Runtime.enable", "Log.enable", "Page.enable"): self.call(m)
    def receive(self):
        while b"\0" not in self.buf:
            got = os.read(self.inp, 1 << 20)
            if not got: raise EOFError("the browser has gone")
            self.buf += got
        m, self.buf = self.buf.split(b"\0", 1)
        return json.loads(m)
    def call(self, method, **params):
        self.n += 1
        msg = {"id": self.n, "method": method, "params": params}
        if getattr(self, "s", None): msg["sessionId"] = self.s
        os.write(self.out, json.dumps(msg).encode() + b"\0")
        while True:
            m = self.receive()
            if m.get("id") == self.n:
                if "error" in m: raise RuntimeError(m["error"])
                return m["result"]
            self.events.append(m)
    def js(self, text):
        return self.call("Runtime.evaluate", expression=text, returnByValue=True, awaitPromise=True)["result"].get("value")
    def picture(self, path):
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        pathlib.Path(path).write_bytes(data)
        return data
    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)
    def complaints(self):
        bad = []
        for e in self.events:
            if e.get("method") == "Runtime.exceptionThrown": bad.append(e["params"]["exceptionDetails"]["text"])
            if e.get("method") == "Runtime.consoleAPICalled": bad.append(str(e["params"]["args"]))
            if e.get("method") == "Log.entryAdded": bad.append(e["params"]["entry"]["text"])
        return bad

b = Browser()
b.call("Page.navigate", url=pathlib.Path(sys.argv[1]).resolve().as_uri())
for _ in range(600):
    if (b.js("document.title") or "").startswith("ice-view "): break
    time.sleep(0.1)
title = b.js("document.title")
out, bad = sys.argv[2], []
if title != "ice-view ready": bad.append("the page says " + str(title))
p = [b.picture(out + "/start.png")]
b.js("document.getElementById('play').click()")
time.sleep(3)
b.js("document.getElementById('play').click()")
p.append(b.picture(out + "/played.png"))
b.mouse("mousePressed", 400, 300, button="left", buttons=1, clickCount=1)
for i in range(10): b.mouse("mouseMoved", 400 + 12 * i, 300 + 3 * i, button="left", buttons=1)
b.mouse("mouseReleased", 520, 330, button="left", clickCount=1)
time.sleep(1)
p.append(b.picture(out + "/turned.png"))
b.js("(e => { e.value = '3'; e.dispatchEvent(new Event('change')); })(document.getElementById('paint'))")
time.sleep(1)
p.append(b.picture(out + "/ice.png"))
for i, what in enumerate(("playing", "turning", "another colour")):
    if p[i] == p[i + 1]: bad.append(what + " changes nothing")
bad += ["console: " + c for c in b.complaints()]
try: b.s = None; b.call("Browser.close")
except EOFError: pass
b.p.wait()
for line in bad: print("page: " + line)
print("%d passed, %d failed" % (4 - min(len(bad), 4), len(bad)))
sys.exit(1 if bad else 0)
