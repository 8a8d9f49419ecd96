# SPDX-License-Identifier: MIT
"""Opens pages of the quickses program in Chromium, without a window, and looks at what is to be seen. Skipped (77) where
there is no Chromium, where it has no WebGL, and where the program was built without three.js.

usage: page_browser_test.py PROGRAM
"""
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import cli_test
from cli_picture_test import BLUE, FILL, RADIUS, RED, TWO_ATOMS, atom, project
from cli_test import ProgramTest, program_to_test
from png_files import Picture

SIZE = (640, 480)
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
SKIPPED = 77


def browse(browser, page, folder, *arguments):
    """Standard output of the browser, which can reach nothing but the page."""
    return subprocess.run(
        [browser, "--headless", "--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--hide-scrollbars", "--force-device-scale-factor=1", "--no-first-run",
         "--proxy-server=127.0.0.1:1", f"--user-data-dir={folder}/profile", "--window-size=%d,%d" % SIZE,
         "--virtual-time-budget=5000", *arguments, page],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, encoding="utf-8", timeout=cli_test.PATIENCE).stdout


def why_not(browser, program):
    if not browser:
        return "there is no Chromium"
    with tempfile.TemporaryDirectory() as folder:
        structure, page = pathlib.Path(folder) / "a.pdb", pathlib.Path(folder) / "a.html"
        structure.write_text(TWO_ATOMS)
        made = subprocess.run([program, structure, "-o", page], capture_output=True, encoding="utf-8")
        if "three.js" in made.stderr:
            return made.stderr
        page.write_text("<body><script>document.body.textContent = 'WebGL: ' + "
                        "!!document.createElement('canvas').getContext('webgl')</script>")
        if "WebGL: true" not in browse(browser, page.as_uri(), folder, "--dump-dom"):
            return "Chromium has no WebGL here"
    return ""


class Browser(ProgramTest):
    def open(self, fragment="", *arguments):
        return browse(BROWSER, (self.folder / "a.html").as_uri() + fragment, self.folder, *arguments)

    def screenshot(self, fragment=""):
        self.open(fragment, f"--screenshot={self.folder}/a.png")
        seen = Picture(self.folder / "a.png")
        self.assertEqual((seen.width, seen.height), SIZE)
        return seen

    def assert_seen(self, seen, atoms, middle, distance, scale, background):
        """Spheres, each {element: (place, channel)}, none in front of another, fill their outlines and no more."""
        for element, (place, channel) in atoms.items():
            x, y = project(place, middle, distance, scale, SIZE)
            radius = RADIUS[element] * scale * distance / (distance - place[2] + middle[2])
            for angle in range(0, 360, 15):
                across, down = math.cos(math.radians(angle)), math.sin(math.radians(angle))
                for part in (0, 0.5, 0.93):
                    pixel = seen.pixel(int(x + part * radius * across), int(y + part * radius * down))
                    self.assertEqual(max(range(3), key=pixel.__getitem__), channel, (element, angle, part, pixel))
                beside = (int(x + 1.08 * radius * across), int(y + 1.08 * radius * down))
                if 0 <= beside[0] < SIZE[0] and 0 <= beside[1] < SIZE[1]:
                    self.assertEqual(seen.pixel(*beside)[:3], background)

    def test_two_atoms(self):
        self.write("in.pdb", TWO_ATOMS)
        self.run_cpu("in.pdb", "-v", "0.2", "-o", "a.html", "--view", "z", "--background", "#102030")
        low, high = -4 - RADIUS["O"], 4 + RADIUS["N"]
        middle = ((low + high) / 2, 0, 0)
        distance = 6 * (high - low) / 2
        half = max(distance * math.tan(math.atan2(abs(x - middle[0]), distance)
                                       + math.asin(RADIUS[e] / math.hypot(x - middle[0], distance)))
                   for e, x in (("O", -4), ("N", 4)))
        self.assert_seen(self.screenshot(), {"O": ((-4, 0, 0), RED), "N": ((4, 0, 0), BLUE)}, middle, distance,
                         FILL / 2 * SIZE[0] / half, (0x10, 0x20, 0x30))

    def test_frames(self):
        models = "".join("MODEL     %4d\n%sENDMDL\n" % (k, atom(1, element, 0, 0, 0))
                         for k, element in ((1, "O"), (2, "O"), (3, "O")))
        self.write("m.pdb", models)
        self.run_cpu("m.pdb", "--trajectory", "m.pdb", "-v", "0.3", "-o", "a.html", "--view", "z")
        for fragment, number in (("", 0), ("#2", 1), ("#3", 2), ("#9", 0), ("#<b>", 0)):
            page = self.open(fragment, "--dump-dom")
            self.assertIn(f">frame {number}<", page)
            self.assertRegex(page, r'id="triangles">[0-9,]{3,}<')
            self.assertRegex(page, r'id="trouble" hidden')
        middle = self.screenshot("#3").pixel(SIZE[0] // 2, SIZE[1] // 2)
        self.assertEqual(max(range(3), key=middle.__getitem__), RED)

    def seen_after(self, script):
        """(where the red pixels are on average, how many, the same of blue) after events of a hand."""
        page = self.folder / "a.html"
        if not hasattr(self, "text"):
            self.text = page.read_text()
        hand = """const view = document.getElementById('view');
            const mouse = (target, kind, x, y, more) => target.dispatchEvent(
                new MouseEvent(kind, {clientX: x, clientY: y, bubbles: true, cancelable: true, ...more}));
            const touch = (kind, ...places) => {
              const touches = places.map(([x, y], k) => new Touch(
                  {identifier: k, target: view, clientX: x, clientY: y, pageX: x, pageY: y}));
              view.dispatchEvent(new TouchEvent(kind, {touches, changedTouches: touches, bubbles: true, cancelable: true}));
            };
            const steps = [];
            const next = () => { if (steps.length) { steps.shift()(); setTimeout(next, 100); } };
            setTimeout(next, 100);\n"""
        page.write_text(self.text.replace("</body>", f"<script>{hand}{script}</script></body>"))
        seen, found = self.screenshot(), {RED: [], BLUE: []}
        for y in range(60, SIZE[1]):
            for x in range(SIZE[0]):
                pixel = seen.pixel(x, y)[:3]
                if max(pixel) - min(pixel) > 60:
                    found[max(range(3), key=pixel.__getitem__)].append(x)
        return [value for channel in (RED, BLUE)
                for value in (sum(found[channel]) / max(1, len(found[channel])), len(found[channel]))]

    def test_a_hand_turns_zooms_and_resets(self):
        self.write("in.pdb", atom(1, "O", 0, 0, 5) + atom(2, "N", 0, 0, -5))
        self.run_cpu("in.pdb", "-v", "0.4", "-o", "a.html", "--view", "z", "--up", "y", "--zoom", "0.3")
        red, red_count, _, blue_count = self.seen_after("")
        self.assertAlmostEqual(red, SIZE[0] / 2, delta=2)
        self.assertEqual(blue_count, 0)  # behind
        drag = """steps.push(() => mouse(view, 'mousedown', 300, 240, {button: 0}),
            () => mouse(document, 'mousemove', 340, 240), () => mouse(document, 'mousemove', 380, 240),
            () => mouse(document, 'mouseup', 380, 240));\n"""
        swipe = """steps.push(() => touch('touchstart', [300, 240]), () => touch('touchmove', [340, 240]),
            () => touch('touchmove', [380, 240]), () => touch('touchend'));\n"""
        for turn in (drag, swipe):
            turned = self.seen_after(turn)
            self.assertGreater(turned[0], red + 20)  # the near one goes with the hand, the far one the other way
            self.assertGreater(turned[3], 0)
            self.assertLess(turned[2], red - 20)
        again = self.seen_after(drag + "steps.push(() => mouse(view, 'dblclick', 300, 240));")
        self.assertAlmostEqual(again[0], red, delta=1)
        self.assertAlmostEqual(again[1], red_count, delta=0.01 * red_count)
        wheel = "steps.push(() => view.dispatchEvent(new WheelEvent('wheel', {deltaY: -100, bubbles: true, cancelable: true})));"
        self.assertGreater(self.seen_after(wheel)[1], 1.05 * red_count)
        pan = """steps.push(() => mouse(view, 'mousedown', 300, 240, {button: 2}),
            () => mouse(document, 'mousemove', 340, 240), () => mouse(document, 'mousemove', 400, 240),
            () => mouse(document, 'mouseup', 400, 240));"""
        self.assertGreater(self.seen_after(pan)[0], red + 5)

    def test_it_plays(self):
        models = "".join("MODEL     %4d\n%sENDMDL\n" % (k, atom(1, "O", 0, 0, 0)) for k in range(1, 6))
        self.write("m.pdb", models)
        self.run_cpu("m.pdb", "--model", "all", "-v", "1", "-o", "a.html")
        page = self.folder / "a.html"
        watch = """<script>
          const seen = new Set(), label = document.getElementById('label');
          new MutationObserver(() => seen.add(label.textContent)).observe(label, {childList: true});
          document.getElementById('play').click();
          setTimeout(() => { document.getElementById('play').click(); document.title = [...seen].join(); }, 1500);
        </script></body>"""
        page.write_text(page.read_text().replace("</body>", watch))
        title = re.search("<title>(.*)</title>", self.open("", "--dump-dom"))
        self.assertEqual(title[1], "model 2,model 3,model 4,model 5,model 1")

    def test_keys_after_a_click(self):
        """The button that was clicked has the focus then."""
        self.write("m.pdb", "".join("MODEL     %4d\n%sENDMDL\n" % (k, atom(1, "O", 0, 0, 0)) for k in range(1, 6)))
        self.run_cpu("m.pdb", "--model", "all", "-v", "1", "-o", "a.html")
        page = self.folder / "a.html"
        press = """<script>
          const play = document.getElementById('play'), label = document.getElementById('label');
          play.click();
          play.click();
          play.focus();
          const press = (key) => {
            document.activeElement.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true}));
            return label.textContent;
          };
          document.title = [press('ArrowRight'), press('ArrowRight'), press('ArrowLeft')].join();
        </script></body>"""
        page.write_text(page.read_text().replace("</body>", press))
        self.assertEqual(re.search("<title>(.*)</title>", self.open("", "--dump-dom"))[1], "model 2,model 3,model 2")

    @unittest.skipIf(os.name == "nt", "no such names there")
    def test_names_do_not_run(self):
        self.write("<img src=x onerror=document.title='ran'>.pdb", TWO_ATOMS)
        self.run_cpu("<img src=x onerror=document.title='ran'>.pdb", "-o", "a.html")
        page = self.open("", "--dump-dom")
        self.assertIsNone(re.search(r"<img", page))
        self.assertRegex(page, r"<title>&lt;img")
        self.assertRegex(page, r'id="triangles">[0-9,]{3,}<')


if __name__ == "__main__":
    cli_test.PROGRAM = program_to_test("", __doc__)
    BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)
    reason = why_not(BROWSER, cli_test.PROGRAM)
    if reason:
        print("skipped:", reason)
        sys.exit(SKIPPED)
    unittest.main()
